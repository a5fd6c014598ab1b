"""What readers of gestures share: time grids, names of joints, units, and joints that stay at home."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from pathlib import Path

import numpy as np

from stimuli.errors import InputError, nearest
from stimuli.robots.model import Joint, Robot
from stimuli.trajectory import FloatArray, Trajectory, even_times
from stimuli.units import ANGLE, LENGTH

LONGEST_S = 600.0  # a gesture beyond it was written in another unit of time
LARGEST = 1_000_000  # bytes of a file of keys; what is longer would only keep one waiting

_UNITS = {"revolute": ANGLE, "prismatic": LENGTH, "dimensionless": {"1": 1.0}}  # by kind of joint
_SPELLINGS = {"°": "deg", "degree": "deg", "degrees": "deg", "radian": "rad", "radians": "rad"}


def whole_body(times: FloatArray, moving: Mapping[str, FloatArray], robot: Robot) -> Trajectory:
    """Motion of all joints: those that move, and the others at home."""
    columns = [moving.get(name, np.full(len(times), robot.home[name])) for name in robot.joint_names]
    return Trajectory(times, np.stack(columns, axis=1), robot.joint_names)


def known_joint(name: str, robot: Robot, place: str) -> Joint:
    """The robot's joint of that name. InputError at `place` where there is none."""
    try:
        return robot.joint(name)
    except KeyError:
        hint = nearest(name, robot.joint_names)
        raise InputError(f"{place}: {robot.name} has no joint {name!r}; {hint}") from None


def each_once(names: Iterable[str], place: str) -> None:
    """InputError at `place` where a joint stands twice: which of the two was meant is not for us to say."""
    seen: set[str] = set()
    for name in names:
        if name in seen:
            raise InputError(f"{place}: {name} stands there twice; keep one of them")
        seen.add(name)


def sampled_times(duration_s: float, dt_s: float, place: str) -> FloatArray:
    """Even times over a gesture. InputError where it has no duration or an impossible one."""
    if not 0 < duration_s <= LONGEST_S:
        raise InputError(
            f"{place}: the gesture lasts {duration_s:g} s; it needs some duration, at most {LONGEST_S:g} s. "
            "Are its times in s?"
        )
    return even_times(duration_s, dt_s)


def unit_factor(unit: str, joint: Joint, place: str) -> float:
    """What a value written in this unit is multiplied by to be in the joint's own."""
    known = _UNITS[joint.kind]
    written = unit.strip().lower()
    written = _SPELLINGS.get(written, written)
    if written not in known:
        raise InputError(f"{place}: {joint.name} has no unit {unit.strip()!r}. Known: {', '.join(known)}")
    return known[written]


def in_joint_unit(value: float, unit: str, joint: Joint) -> float:
    """A value written in `unit` (deg or rad) in the joint's own unit; only hinges have angles."""
    return math.radians(value) if joint.kind == "revolute" and unit == "deg" else value


def read_text(path: Path, largest: int = LARGEST) -> str:
    """The file's text, UTF-8. InputError where it is something else, nothing, or beyond `largest` bytes."""
    try:
        with path.open("rb") as file:
            content = file.read(largest + 1)
        text = content[:largest].decode("utf-8-sig") if len(content) <= largest else None
    except (OSError, UnicodeDecodeError) as err:
        raise InputError(f"{path}: cannot be read as UTF-8 text: {err}") from err
    if text is None:
        raise InputError(
            f"{path}: is larger than {largest / 1e6:g} MB, which no gesture in this format needs"
        )
    if not text.strip():
        raise InputError(f"{path}: is empty; docs/formats.md shows what stands in a gesture's file")
    return text
