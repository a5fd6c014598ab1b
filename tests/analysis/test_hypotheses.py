"""Several hypotheses, several tests: each has results, tables, figures and sentences of its own."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from analysis.apa import number
from analysis.dataset import read_responses
from analysis.plan import Levels, carry_out
from analysis.report import analyse
from analysis.words import sentences
from study.protocol import Protocol, load_protocol
from study.protocol.errors import ProtocolError
from tests.analysis.conftest import PAPER, Write, choices, ratings

MORE = """
  H3:   {part: recognition, test: wilcoxon, of: target, against: other items, alternative: greater}
  H4:   {part: recognition, item: joy, test: paired t, compare: [joy, fear], alternative: greater}
  H5:   {part: intensity, test: mcnemar, compare: [high, low], outcome: higher, alternative: greater}
"""


def with_hypotheses(folder: Path, more: str) -> Protocol:
    """The paper's study with more hypotheses."""
    path = folder / "protocol.yaml"
    text = (PAPER / "protocol.yaml").read_text(encoding="utf-8").replace("gestures/", f"{PAPER}/gestures/")
    path.write_text(text.rstrip() + more, encoding="utf-8")
    return load_protocol(path)


def test_hypotheses_on_one_part_keep_their_results_tables_and_figures_apart(
    tmp_path: Path, write: Write
) -> None:
    protocol = with_hypotheses(tmp_path, MORE)
    analyse(write([*ratings(n=12), *choices(n=12)]), protocol, tmp_path / "out")
    names = {"recognition_H1", "recognition_H3", "recognition_H4", "intensity_H2.1", "intensity_H5"}
    tables = {path.name for path in (tmp_path / "out" / "tables").iterdir()}
    figures = {path.name for path in (tmp_path / "out" / "figures").iterdir()}
    written = json.loads((tmp_path / "out" / "results.json").read_text(encoding="utf-8"))
    assert {f"{name}.{form}" for name in names for form in ("tex", "csv")} <= tables
    assert {f"{name}.{form}" for name in names for form in ("svg", "pdf", "png")} <= figures
    assert names <= set(written) and names == set(written["further"]) & names
    assert {one["results"] for one in written["hypotheses"].values()} == names
    assert written["recognition_H1"]["joy"]["chance"]["definition"] == "midpoint"
    assert written["recognition_H3"]["joy"]["chance"]["definition"] == "other items"
    assert "H2.2" in written["intensity_H2.1"]["arc"]["mirrors"]
    assert "mirrors" not in written["intensity_H5"]["arc"]


def test_a_sentence_reports_the_test_that_was_declared(tmp_path: Path, write: Write) -> None:
    protocol = with_hypotheses(tmp_path, MORE)
    outcomes = carry_out(read_responses(write([*ratings(n=12), *choices(n=12)]), protocol), protocol).outcomes
    compared = outcomes["H4"]
    assert isinstance(compared, Levels)
    t = compared.results["joy"].paired.t
    assert f", t(11) = {number(t)}, " in sentences(compared)["joy"]
    assert "wilcoxon p" in sentences(outcomes["H3"])["joy"]
    assert "; McNemar's exact p" in sentences(outcomes["H5"])["ant"]


def test_a_hypothesis_bears_a_name_that_a_file_can_bear(tmp_path: Path) -> None:
    with pytest.raises(ProtocolError, match="a/b"):
        with_hypotheses(tmp_path, MORE.replace("H3", "a/b"))
