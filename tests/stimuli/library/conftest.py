"""A tiny study: Pepper nods, in clips of 64 pixels."""

from __future__ import annotations

import hashlib
import time
from collections.abc import Callable
from pathlib import Path

import pytest

from stimuli.dmp import Learning
from stimuli.library import Progress, render_missing
from stimuli.manifest import Manifest
from stimuli.principles import Modulation
from stimuli.robots import load_robot
from stimuli.robots.model import Robot
from stimuli.spec import StimulusSpec, Video

GESTURE = """\
gesture: nod
robot: pepper
title: {en: Nod}
unit: deg
duration: 0.6 s
joints:
  HeadPitch: {0.0: home, 0.3: 10, 0.6: home}
"""
SMALL = Video(width=64, height=64, fps=10, camera="head", lead_in_s=0.1, hold_s=0.2)

PATIENCE_S = 300  # on a machine that has much else to do

MakeSpec = Callable[..., StimulusSpec]
Rendered = tuple[Manifest, Path, list[Progress]]


@pytest.fixture(scope="session")
def pepper() -> Robot:
    return load_robot("pepper", Path())


@pytest.fixture(scope="session")
def gesture(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("gestures") / "nod.yaml"
    path.write_text(GESTURE)
    return path


@pytest.fixture(scope="session")
def spec(gesture: Path, pepper: Robot) -> MakeSpec:
    """Make the description of a nod: `spec("slow", time=1.5)`."""

    def make(id_: str, video: Video = SMALL, **principles: float) -> StimulusSpec:
        return StimulusSpec(
            id=id_,
            robot="pepper",
            robot_sha256=pepper.sha256,
            gesture=gesture,
            gesture_sha256=hashlib.sha256(gesture.read_bytes()).hexdigest(),
            modulation=Modulation.model_validate(principles),
            learning=Learning(),
            video=video,
        )

    return make


@pytest.fixture(scope="session")
def study(spec: MakeSpec) -> list[StimulusSpec]:
    """Three stimuli, two of which look the same."""
    return [spec("neutral"), spec("slow", time=1.5), spec("same")]


@pytest.fixture(scope="session")
def rendered(study: list[StimulusSpec], pepper: Robot, tmp_path_factory: pytest.TempPathFactory) -> Rendered:
    """The study's clips, their folder, and what was told while they were made."""
    folder = tmp_path_factory.mktemp("clips")
    told: list[Progress] = []
    return render_missing(study, {"pepper": pepper}, folder, workers=2, progress=told.append), folder, told


@pytest.fixture(scope="session")
def begun() -> Callable[[Path], Path]:
    """Wait until a clip is being written in a folder, and return the file that will not stay."""

    def wait(folder: Path) -> Path:
        deadline = time.monotonic() + PATIENCE_S
        while not (files := list(folder.glob(".*.part.mp4"))) and time.monotonic() < deadline:
            time.sleep(0.01)
        (file,) = files
        return file

    return wait
