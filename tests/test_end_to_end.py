"""One small study, all the way from its protocol over videos, orders and sessions to the report."""

import csv
import json
import shutil
import subprocess
import sys
from pathlib import Path

import av
import pytest
from typer.testing import CliRunner

from study.cli import app

GESTURES = Path(__file__).parent.parent / "protocols" / "hielscher2025" / "gestures"
PROTOCOL = """
study: small
title: A small study
contact: lab@example.org
robot: pepper
seed: 3
video: {size: 64x64, fps: 4, camera: full_body, lead_in: 0 s, hold: 0 s}
gestures: {wave: gestures/wave.yaml}
modulations: {joy: {time: 0.8, exa: 1.2}, sadness: {time: 1.3, exa: 0.5}}
levels: {time: [1.3, 1.0, 0.8]}
parts:
  recognition:
    title: What does the robot express?
    stimuli: {gesture: wave, modulations: [joy, sadness]}
    order: williams
    ask: [{rate: {text: It expresses, items: {joy: Joy, sadness: Sadness}, points: 5, ends: [no, yes]}}]
  intensity:
    title: How intense is it?
    stimuli: {gesture: wave, levels: [time]}
    reference: medium
    order: {principles: williams, levels: balanced}
    ask: [{choose: {item: intensity, text: It is, options: {lower: lower, higher: higher}, sides: balanced}}]
  happier:
    title: Which looks happier?
    stimuli: {gesture: wave, modulations: [joy, sadness], prefix: beside_}
    pairs: all
    ask: [{prefer: {item: happier, text: Which of the two looks happier?}}]
participants: {planned: 8}
analysis:
  H1: {part: recognition, test: one-sample t, of: target, against: midpoint, alternative: greater}
  H2: {part: intensity, test: independent t, compare: [high, low], outcome: higher, alternative: greater}
  H3: {part: happier, test: binomial, compare: [joy, sadness], alternative: greater}
"""


@pytest.fixture(scope="module")
def small(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("small")
    (folder / "protocol.yaml").write_text(PROTOCOL, encoding="utf-8")
    (folder / "gestures").mkdir()
    shutil.copy(GESTURES / "wave.yaml", folder / "gestures")
    return folder


def run(*arguments: str | Path) -> str:
    result = CliRunner().invoke(app, [str(argument) for argument in arguments], catch_exceptions=False)
    assert result.exit_code == 0, result.output
    return result.output


def test_a_protocol_becomes_a_report(small: Path) -> None:
    run("render", small)
    manifest = json.loads((small / "stimuli" / "manifest.json").read_text())
    again = {"beside_joy", "beside_sadness"}  # of the same motions, so the same files
    assert set(manifest["stimuli"]) == {"joy", "sadness", "time_low", "time_medium", "time_high"} | again
    assert manifest["stimuli"]["beside_joy"]["file"] == manifest["stimuli"]["joy"]["file"]
    for clip in manifest["stimuli"].values():
        with av.open(str(small / "stimuli" / clip["file"])) as file:
            assert sum(1 for _ in file.decode(video=0)) == clip["frames"]
    drawn = {path: path.stat().st_mtime_ns for path in (small / "stimuli").glob("*.mp4")}
    run("render", small)
    assert drawn == {path: path.stat().st_mtime_ns for path in (small / "stimuli").glob("*.mp4")}

    out = small / "report"
    run("rehearse", small, "-n", "8", "--out", out)
    with (out / "responses.csv").open(encoding="utf-8", newline="") as file:
        rows = [row for row in csv.DictReader(file) if row["part"] in {"recognition", "intensity", "happier"}]
    assert {row["session"] for row in rows} == {"simulated"}
    assert len(rows) == 8 * (2 * 2 + 2 + 1)
    assert len({(row["participant"], row["stimulus"], row["item"]) for row in rows}) == len(rows)
    files = {clip["file_sha256"] for clip in manifest["stimuli"].values()}
    assert {sha256 for row in rows for sha256 in row["stimulus_sha256"].split()} <= files

    results = json.loads((out / "results.json").read_text())
    assert results["recognition"]["joy"]["n"] == 8
    counts = results["intensity"]["time"]["counts"]
    assert sum(counts["high"].values()) == sum(counts["low"].values()) == 8
    preferred = [row["response"] for row in rows if row["part"] == "happier"]
    assert preferred.count("beside_joy") + preferred.count("beside_sadness") == 8
    (compared,) = results["happier"].values()
    assert compared["test"]["k"] == preferred.count("beside_joy")
    assert "simulated" in (out / "report.html").read_text().lower()


def test_a_fault_of_the_user_is_one_message_without_a_traceback(tmp_path: Path) -> None:
    (tmp_path / "protocol.yaml").write_text(PROTOCOL.replace("robot: pepper", "robot: peper"))
    command = [sys.executable, "-m", "study.cli", "render", tmp_path]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 1
    assert "peper" in done.stderr and "pepper" in done.stderr
    assert "Traceback" not in done.stderr
