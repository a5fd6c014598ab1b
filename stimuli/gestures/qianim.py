"""Animations of Pepper's makers (`.qianim`): XML, one Bezier curve of keys per joint.

Times count frames at the curve's own rate; a `Tangent` is the offset of a handle from its key. Attributes of
the editor, in whichever namespace, are not needed. Time begins at frame 0. As on the robot, which goes from
wherever it stands to the first key, a joint whose first key comes later sets out from home at rest.
"""

from __future__ import annotations

import xml.etree.ElementTree as ET
from dataclasses import replace
from pathlib import Path

from stimuli.errors import InputError
from stimuli.gestures.bezier import Handle, Key, sample
from stimuli.gestures.reading import in_joint_unit, known_joint, read_text, whole_body
from stimuli.robots.model import Joint, Robot
from stimuli.trajectory import Trajectory, even_times

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
            curves[name] = _from_home(keys, robot.home[name])
    if not curves:
        raise InputError(f"{path}: no ActuatorCurve with keys; an animation has one per joint that moves")
    end = max(key.time_s for keys in curves.values() for key in keys)
    if end <= 0:
        raise InputError(f"{path}: all keys lie in frame 0; a gesture needs some duration")
    times = even_times(end, dt_s)
    return whole_body(times, {name: sample(keys, times) for name, keys in curves.items()}, robot)


def _from_home(keys: list[Key], home: float) -> list[Key]:
    """The keys with one at home before them, where the first comes late."""
    first = min(keys, key=lambda key: key.time_s)
    if first.time_s <= 0:
        return keys
    third = first.time_s / 3  # level handles of a third make the way there ease in and out
    reached = replace(first, left=first.left or (-third, 0.0))
    return [Key(0.0, home, None, (third, 0.0)), *(reached if key is first else key for key in keys)]


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
    try:
        return float(element.attrib[attribute])
    except (KeyError, ValueError) as err:
        written = element.get(attribute)
        raise InputError(f"{place}: {element.tag} has {attribute}={written!r}; a number is needed") from err
