"""What the README shows is run."""

import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
README = (ROOT / "README.md").read_text(encoding="utf-8")
SMALL = "video: {size: 64x36, fps: 4, camera: full_body}\n"


def blocks(language: str) -> list[str]:
    return re.findall(rf"^```{language}\n(.*?)^```", README, re.MULTILINE | re.DOTALL)


def commands(block: str) -> list[list[str]]:
    lines = (line.partition("#")[0].split() for line in block.splitlines())
    return [words for words in lines if words]


def study(arguments: list[str], folder: Path) -> None:
    command = [sys.executable, "-m", "study.cli", *arguments]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    assert done.returncode == 0, f"study {' '.join(arguments)}\n{done.stdout}\n{done.stderr}"


def test_make_has_the_two_commands_and_ci_runs_the_second() -> None:
    targets = set(re.findall(r"^(\w+):", (ROOT / "Makefile").read_text(), re.MULTILINE))
    shown = {words[1] for block in blocks("sh") for words in commands(block) if words[0] == "make"}
    assert shown == {"run", "test"} <= targets
    assert "make test" in (ROOT / ".ci" / "run").read_text()


def test_a_study_of_ones_own_goes_from_the_template_to_the_report(tmp_path: Path) -> None:
    walk = next(block for block in blocks("sh") if "study new" in block)
    for words in commands(walk):
        match words:
            case ["study", "run", *_] | ["study", "export", *_] | [".", *_]:
                continue  # serving is tested in a browser; without a participant there is nothing to export
            case ["study", "analyse", _, *rest]:
                study(["analyse", "rehearsal/responses.csv", *rest], tmp_path)
            case ["study", *arguments]:
                study(arguments, tmp_path)
        if words[1] == "new":
            file = tmp_path / words[2] / "protocol.yaml"
            file.write_text(file.read_text(encoding="utf-8") + SMALL, encoding="utf-8")
    assert (tmp_path / "report" / "results.json").exists()


def test_the_whole_protocol_shown_is_good(tmp_path: Path) -> None:
    (shown,) = blocks("yaml")
    (tmp_path / "protocol.yaml").write_text(shown, encoding="utf-8")
    gestures = tmp_path / "gestures"
    gestures.mkdir()
    (gestures / "nod.yaml").write_bytes((ROOT / "protocols/demonstrations/gestures/nod.yaml").read_bytes())
    study(["check", "."], tmp_path)


@pytest.mark.parametrize("row", re.findall(r"^\| `study (.*?)` \|", README, re.MULTILINE))
def test_each_command_of_the_table_runs(row: str, tmp_path: Path) -> None:
    table = tmp_path / "TABLE.csv"
    table.write_text("principle,level,higher,lower\ntime,high,1.00,0.00\ntime,low,0.29,0.71\n")
    places = {"P": str(ROOT / "protocols/hielscher2025"), "TABLE.csv": str(table)}
    study([places.get(word, word) for word in row.split()], tmp_path)
