"""Animations of Pepper's makers (`.qianim`): XML, one Bezier curve of keys per joint.

Times count frames at the curve's own rate; a `Tangent` is the offset of a handle from its key. Attributes of
the editor, in whichever namespace, are not needed. Time begins at frame 0; a joint whose first key comes
later sets out from home, at rest.
"""

from __future__ import annotations

import math
import xml.etree.ElementTree as ET
from pathlib import Path

from stimuli.errors import InputError
from stimuli.gestures.bezier import Handle, Key, from_home, sample
from stimuli.gestures.reading import (
    each_once,
    in_joint_unit,
    known_joint,
    read_text,
    sampled_times,
    whole_body,
)
from stimuli.robots.model import Joint, Robot
from stimuli.trajectory import Trajectory

SUFFIXES = (".qianim",)

_UNITS = {"degree": "deg", "radian": "rad", "dimensionless": "1"}


def read(path: Path, robot: Robot, dt_s: float) -> Trajectory:
    """The gesture in an animation file."""
    text = read_text(path)
    if "<!DOCTYPE" in text or "<!ENTITY" in text:
        raise InputError(f"{path}: an animation has no document type or entities of its own; remove them")
    try:
        root = ET.fromstring(text)
    except ET.ParseError as err:
        raise InputError(f"{path}:{err.position[0]}: not readable as XML: {err}") from err
    curves: dict[str, list[Key]] = {}
    for curve in root.iter("ActuatorCurve"):
        if curve.get("mute", "0").lower() not in ("0", "false"):
            continue
        name = curve.get("actuator", "")
        keys = _keys(
            curve, known_joint(name, robot, f"{path}: ActuatorCurve"), f"{path}: ActuatorCurve {name}"
        )
        if keys:
            each_once([*curves, name], str(path))
            curves[name] = from_home(keys, robot.home[name])
    if not curves:
        raise InputError(f"{path}: no ActuatorCurve with keys; an animation has one per joint that moves")
    end = max(key.time_s for keys in curves.values() for key in keys)
    times = sampled_times(end, dt_s, str(path))
    return whole_body(times, {name: sample(keys, times) for name, keys in curves.items()}, robot)


def _keys(curve: ET.Element, joint: Joint, place: str) -> list[Key]:
    fps = _number(curve, "fps", place)
    unit = _UNITS.get(curve.get("unit", "degree"))
    if unit is None or fps <= 0:
        raise InputError(
            f"{place}: unit {curve.get('unit')!r} at fps {fps:g}; units are {', '.join(_UNITS)}, fps > 0"
        )

    def handle(key: ET.Element, side: str) -> Handle | None:
        for tangent in key.iter("Tangent"):
            if tangent.get("side") == side:
                reach = _number(tangent, "abscissaParam", place) / fps
                return reach, in_joint_unit(_number(tangent, "ordinateParam", place), unit, joint)
        return None

    return [
        Key(
            _number(key, "frame", place) / fps,
            in_joint_unit(_number(key, "value", place), unit, joint),
            handle(key, "left"),
            handle(key, "right"),
        )
        for key in curve.iter("Key")
    ]


def _number(element: ET.Element, attribute: str, place: str) -> float:
    written = element.get(attribute)
    try:
        number = float(written or "")
    except ValueError:
        number = math.nan
    if not math.isfinite(number):
        raise InputError(f"{place}: {element.tag} has {attribute}={written!r}; a number is needed")
    return number
