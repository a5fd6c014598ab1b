"""Answers gathered with another version of a protocol are analysed only where that was declared."""

from __future__ import annotations

from pathlib import Path

import pytest

from analysis.fields import ResponsesError
from analysis.threats import threats
from analysis.versions import of_one_study
from study.protocol import load_protocol
from tests.analysis.conftest import PAPER

EARLIER = "0123456789abcdef" * 4
AMENDED = "\namendments:\n  - {date: 2026-11-22, reason: A misspelt word, replaces: 0123456789ab}\n"


@pytest.fixture
def rows(tmp_path: Path) -> Path:
    """A file with a row of an earlier version; the protocol is beside it."""
    text = (PAPER / "protocol.yaml").read_text(encoding="utf-8")
    (tmp_path / "protocol.yaml").write_text(text, encoding="utf-8")
    path = tmp_path / "responses.csv"
    path.write_text(f"participant,protocol_sha256\na,{load_protocol(tmp_path).sha256}\nb,{EARLIER}\n")
    return path


def test_rows_of_an_undeclared_version_are_refused_and_told_what_to_do(rows: Path) -> None:
    with (
        pytest.raises(ResponsesError, match="gathered with protocol") as refused,
        of_one_study(rows, load_protocol(rows.parent)),
    ):
        pass
    assert f"--protocol DATA/versions/{EARLIER}" in str(refused.value)
    assert "replaces: 0123456789ab" in str(refused.value)


def test_rows_of_a_declared_version_count_and_are_named_where_they_do_not_fit(rows: Path) -> None:
    protocol = rows.parent / "protocol.yaml"
    rows.write_text(f"participant,protocol_sha256\nb,{EARLIER}\n")
    protocol.write_text(protocol.read_text(encoding="utf-8") + AMENDED, encoding="utf-8")
    with of_one_study(rows, load_protocol(protocol)):
        pass
    with (
        pytest.raises(ResponsesError, match=r"gone(.|\n)*DATA/versions/0123"),
        of_one_study(rows, load_protocol(protocol)),
    ):
        raise ResponsesError("a stimulus is gone")


def test_the_report_says_that_versions_are_taken_together(rows: Path) -> None:
    protocol = rows.parent / "protocol.yaml"
    protocol.write_text(protocol.read_text(encoding="utf-8") + AMENDED, encoding="utf-8")
    (said,) = (one for one in threats(load_protocol(protocol)) if "amended" in one)
    assert said.startswith("The protocol was amended on 2026-11-22 (A misspelt word); who took part before")


def test_a_table_that_does_not_say_its_version_is_taken_as_it_is(tmp_path: Path) -> None:
    path = tmp_path / "responses.csv"
    path.write_text("participant\na\n")
    with of_one_study(path, load_protocol(PAPER)):
        pass
