"""What readers of gestures share: time grids, names of joints, units, and joints that stay at home."""

from __future__ import annotations

import difflib
import math
from collections.abc import Mapping
from pathlib import Path

import numpy as np

from stimuli.errors import InputError
from stimuli.robots.model import Joint, Robot
from stimuli.trajectory import FloatArray, Trajectory


def whole_body(times: FloatArray, moving: Mapping[str, FloatArray], robot: Robot) -> Trajectory:
    """Motion of all joints: those that move, and the others at home."""
    columns = [moving.get(name, np.full(len(times), robot.home[name])) for name in robot.joint_names]
    return Trajectory(times, np.stack(columns, axis=1), robot.joint_names)


def known_joint(name: str, robot: Robot, place: str) -> Joint:
    """The robot's joint of that name. InputError at `place` where there is none."""
    try:
        return robot.joint(name)
    except KeyError:
        near = difflib.get_close_matches(name, robot.joint_names, 1)
        hint = f"; did you mean {near[0]}?" if near else f". Known: {', '.join(robot.joint_names)}"
        raise InputError(f"{place}: {robot.name} has no joint {name!r}{hint}") from None


def in_joint_unit(value: float, unit: str, joint: Joint) -> float:
    """A value written in `unit` (deg or rad) in the joint's own unit; only hinges have angles."""
    return math.radians(value) if joint.kind == "revolute" and unit == "deg" else value


def read_text(path: Path) -> str:
    """The file's text, UTF-8. InputError where it is something else."""
    try:
        return path.read_text(encoding="utf-8-sig")
    except (OSError, UnicodeDecodeError) as err:
        raise InputError(f"{path}: cannot be read as UTF-8 text: {err}") from err
