"""What is wrong outside the protocol is one message and exit code 1 too: disks, folders, databases."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import pytest

from stimuli.errors import InputError
from study.cli import main
from study.storage import open_store


def said(
    arguments: Sequence[str], monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> str:
    """What the command line says on its way out with exit code 1."""
    monkeypatch.setattr("sys.argv", ["study", *arguments])
    with pytest.raises(SystemExit) as stopped:
        main()
    assert stopped.value.code == 1
    return capsys.readouterr().err


def test_a_file_where_a_folder_should_be(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "file"
    file.touch()
    assert (
        said(["new", str(file / "study")], monkeypatch, capsys)
        == f"study: {file / 'study'}: Not a directory\n"
    )


def test_what_is_no_database_cannot_be_opened(tmp_path: Path) -> None:
    file = tmp_path / "study.db"
    file.write_text("no database at all")
    with pytest.raises(InputError, match=r"study.db: cannot be opened: file is not a database"):
        open_store(f"sqlite:///{file}")


def test_a_postgresql_that_is_away_is_said_without_its_password() -> None:
    with pytest.raises(InputError, match=r"cannot be opened: .*refused") as fault:
        open_store("postgresql://study:secret@127.0.0.1:1/study")
    assert "secret" not in str(fault.value)
