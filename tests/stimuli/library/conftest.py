"""A tiny study: Pepper nods, in clips of 64 pixels."""

from __future__ import annotations

import hashlib
from collections.abc import Callable
from pathlib import Path

import pytest

from stimuli.dmp import Learning
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

MakeSpec = Callable[..., StimulusSpec]


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
