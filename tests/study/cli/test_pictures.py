"""The commands that make pictures, as they are typed."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from distributed import LocalCluster

from stimuli.manifest import Manifest

pytestmark = pytest.mark.xdist_group("cluster")

PROTOCOL = """
study: small
title: A small study
contact: lab@example.org
robot: pepper
seed: 3
video: {size: 64x64, fps: 4, camera: auto, lead_in: 0 s, hold: 0 s}
gestures: {nod: nod.yaml, turn: {file: turn.yaml, robot: iiwa14}}
modulations: {quick: {time: 0.8}, large: {exa: 1.2}, same: {exa: 1.2}}
parts:
  nods:
    title: How lively is it?
    stimuli: {gesture: nod, modulations: [quick, large, same], prefix: nod_}
    ask: [{rate: {text: It is, items: [lively], points: 5, ends: [no, yes]}}]
  turns:
    title: How lively is it?
    stimuli: {gesture: turn, modulations: [quick], prefix: turn_}
    ask: [{rate: {text: It is, items: [lively], points: 5, ends: [no, yes]}}]
participants: {planned: 8}
"""
GESTURE = """
gesture: {name}
robot: {robot}
title: {{en: {name}}}
unit: deg
duration: 1 s
joints: {{{joint}: {{0.0: home, 0.5: 10, 1.0: home}}}}
"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("small")
    (folder / "protocol.yaml").write_text(PROTOCOL, encoding="utf-8")
    (folder / "nod.yaml").write_text(GESTURE.format(name="nod", robot="pepper", joint="HeadPitch"))
    (folder / "turn.yaml").write_text(GESTURE.format(name="turn", robot="iiwa14", joint="joint2"))
    return folder


@pytest.fixture(scope="module")
def address() -> Iterator[str]:
    with LocalCluster(n_workers=2, threads_per_worker=1, processes=True, dashboard_address=":0") as running:
        yield running.scheduler_address


def study(*arguments: str | Path) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "study.cli", *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, check=False)


@pytest.fixture(scope="module")
def rendered(folder: Path, address: str) -> subprocess.CompletedProcess[str]:
    return study("render", folder, "--scheduler", address)


def test_a_cluster_renders_and_clips_that_look_the_same_are_counted_once(
    rendered: subprocess.CompletedProcess[str], folder: Path
) -> None:
    assert (rendered.returncode, rendered.stderr) == (0, "")
    said = "3 clips of 4 stimuli; those that look the same share one.\n"
    assert rendered.stdout == f"{folder / 'stimuli'}: {said}"
    assert len(list(folder.glob("stimuli/*.mp4"))) == 3


def test_every_robot_is_framed_for_its_own_motions(
    rendered: subprocess.CompletedProcess[str], folder: Path
) -> None:
    manifest = Manifest.load(folder / "stimuli")
    framed = {(clip.spec["robot"], clip.spec["video"]["camera"]) for clip in manifest.clips.values()}
    assert framed == {("pepper", "head"), ("iiwa14", "upper_body")}


def test_a_preview_names_what_it_drew(rendered: subprocess.CompletedProcess[str], folder: Path) -> None:
    done = study("preview", folder, "nod_quick", "nod_large")
    assert (done.returncode, done.stderr) == (0, "")
    drawn = [Path(line) for line in done.stdout.splitlines() if line.endswith((".png", ".csv", ".mp4"))]
    assert len(drawn) == 7
    assert all(path.stat().st_size > 0 for path in drawn)
    wrong = study("preview", folder, "nod_quik")
    assert wrong.returncode == 1
    assert "did you mean nod_quick?" in wrong.stderr
