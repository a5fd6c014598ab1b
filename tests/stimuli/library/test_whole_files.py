"""Files that appear all at once or not at all."""

from __future__ import annotations

from pathlib import Path

import pytest

from stimuli.whole_files import all_or_none


def written(folder: Path) -> dict[str, str]:
    return {str(path.relative_to(folder)): path.read_text() for path in folder.rglob("*") if path.is_file()}


def write(folder: Path, text: str) -> None:
    (folder / "figures").mkdir()
    (folder / "figures" / "one.svg").write_text(text)
    (folder / "results.json").write_text(text)


def test_a_folder_has_all_files_of_a_run_or_those_of_the_one_before(tmp_path: Path) -> None:
    folder = tmp_path / "a" / "report"
    with all_or_none(folder) as first:
        write(first, "first")
        assert written(first) and not (folder / "results.json").exists()
    with pytest.raises(KeyboardInterrupt), all_or_none(folder) as second:
        write(second, "second")
        raise KeyboardInterrupt
    assert written(folder) == {"figures/one.svg": "first", "results.json": "first"}
    killed = folder / ".files.999999999.part"
    (killed / "figures").mkdir(parents=True)
    with all_or_none(folder) as third:
        write(third, "third")
    assert written(folder) == {"figures/one.svg": "third", "results.json": "third"}
    assert not killed.exists()
