"""Gestures authored as keyframes, in YAML.

    gesture: wave
    robot: pepper
    title: {en: Greeting wave}
    unit: deg                  # of angles; hands are 0–1 always
    duration: 4.0 s
    joints:                    # joints not named stay at home; "home" is the home value
      RShoulderPitch: {0.0: home, 0.7: -40, 2.6: -38, 3.6: home}     # time in s: value

Between keys a joint moves by a quintic with the velocities of a shape-preserving cubic (PCHIP) and no
acceleration at the keys: twice continuously differentiable, at rest at both ends, and standing still between
equal keys. Before its first key and after its last a joint holds still. `robot` may be left out; a gesture
that names one is refused for others.
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import Annotated, Literal

import numpy as np
import yaml
from pydantic import BaseModel, BeforeValidator, ConfigDict, Field, ValidationError
from pydantic_core import ErrorDetails
from scipy.interpolate import BPoly, PchipInterpolator

from stimuli.errors import InputError, nearest
from stimuli.gestures.reading import (
    in_joint_unit,
    known_joint,
    read_text,
    sampled_times,
    whole_body,
)
from stimuli.lines import line_of, refuse_doubles
from stimuli.robots.model import Joint, Robot
from stimuli.trajectory import FloatArray, Trajectory
from stimuli.units import TIME, in_base_unit

SUFFIXES = (".yaml", ".yml")

Seconds = Annotated[float, BeforeValidator(lambda value: in_base_unit(value, TIME))]


def _position(value: object) -> object:
    """A number or `home`; also a number with a unit is refused, as one unit stands for the file."""
    if value == "home":
        return value
    if isinstance(value, (int, float)) and not isinstance(value, bool) and math.isfinite(value):
        return float(value)
    raise ValueError("must be a number without a unit, which `unit` names for all angles, or home")


Position = Annotated[float | Literal["home"], BeforeValidator(_position)]
Keys = Annotated[dict[Seconds, Position], Field(min_length=1)]


class Keyframes(BaseModel):
    """The file as written."""

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)

    gesture: str
    robot: str | None = None
    title: str | dict[str, str] = ""
    unit: Literal["deg", "rad"] = "rad"
    duration: Annotated[Seconds, Field(gt=0)]
    joints: Annotated[dict[str, Keys], Field(min_length=1)]


def read(path: Path, robot: Robot, dt_s: float) -> Trajectory:
    """The gesture in a keyframe file."""
    text = read_text(path)
    try:
        tree = yaml.compose(text, Loader=yaml.CSafeLoader)
        refuse_doubles(tree, path)
        frames = Keyframes.model_validate(yaml.load(text, Loader=yaml.CSafeLoader))
    except (yaml.YAMLError, RecursionError) as err:
        raise InputError(f"{path}: not readable as YAML: {err}") from err
    except ValidationError as err:
        raise InputError("\n".join(_refusal(detail, tree, path) for detail in err.errors())) from None
    if frames.robot not in (None, robot.name):
        place = f"{path}:{line_of(tree, ('robot',))}: robot"
        raise InputError(
            f"{place}: the gesture is for {frames.robot}, not {robot.name}; "
            "leave the line out where it suits both"
        )
    times = sampled_times(frames.duration, dt_s, f"{path}:{line_of(tree, ('duration',))}: duration")
    moving = {}
    for name, keys in frames.joints.items():
        place = f"{path}:{line_of(tree, ('joints', name))}"
        joint, home = known_joint(name, robot, place), robot.home[name]
        if len(keys) < len(_names(tree, "joints", name)):
            raise InputError(f"{place}: joints.{name}: two keys lie at one time; keep one of them")
        moments = np.array(sorted(keys))
        values = np.array(
            [
                home if (key := keys[float(at)]) == "home" else in_joint_unit(key, frames.unit, joint)
                for at in moments
            ]
        )
        _check(moments, values, frames, joint, f"{place}: joints.{name}")
        moving[name] = between_keys(moments, values, times)
    return whole_body(times, moving, robot)


def between_keys(moments: FloatArray, values: FloatArray, times: FloatArray) -> FloatArray:
    """Positions at these times, (n,), of a motion through keys as the module describes it."""
    if len(moments) == 1:
        return np.full(len(times), values[0])
    velocities = np.zeros(len(moments))
    velocities[1:-1] = PchipInterpolator(moments, values).derivative()(moments[1:-1])
    quintics = BPoly.from_derivatives(moments, np.stack([values, velocities, np.zeros(len(moments))], axis=1))
    return np.asarray(quintics(np.clip(times, moments[0], moments[-1])), dtype=np.float64)


_WORDS = {
    "missing": "is missing",
    "dict_type": "must be a mapping (name: value)",
    "model_type": "must be a mapping (name: value), such as docs/formats.md shows",
    "string_type": "must be text",
    "literal_error": "must be deg or rad",
    "too_short": "must not be empty",
}  # by pydantic's types of errors


def _refusal(detail: ErrorDetails, tree: yaml.Node | None, path: Path) -> str:
    """One error at its line, in words about the file."""
    location = tuple(part for part in detail["loc"] if part != "[key]")
    name, value = ".".join(map(str, location)), detail["input"]
    message = _WORDS.get(detail["type"], detail["msg"].removeprefix("Value error, "))
    message = message.replace("Input should be", "must be")
    if detail["type"] == "extra_forbidden":
        message = f"is no field here; {nearest(location[-1], Keyframes.model_fields)}"
    elif isinstance(value, (str, int, float)) and not message.startswith(shown := repr(value)[:60]):
        message = f"{shown} {message}"
    return ": ".join(filter(None, (f"{path}:{line_of(tree, location)}", name, message)))


def _check(moments: FloatArray, values: FloatArray, frames: Keyframes, joint: Joint, place: str) -> None:
    """InputError where a key lies outside the gesture or the joint's range."""
    for moment in moments[(moments < 0) | (moments > frames.duration)]:
        raise InputError(
            f"{place}: a key at {moment:g} s; keys lie from 0 to the duration, {frames.duration:g} s"
        )
    in_degrees = joint.kind == "revolute" and frames.unit == "deg"
    scale, unit = (np.degrees(1.0), "deg") if in_degrees else (1.0, joint.unit)
    for moment, value in zip(moments, values, strict=True):
        if not joint.lower <= value <= joint.upper:
            raise InputError(
                f"{place}: {value * scale:.4g} at {moment:g} s is outside the joint's range, "
                f"{joint.lower * scale:.4g} to {joint.upper * scale:.4g} {unit}"
            )


def _names(node: yaml.Node | None, *location: str) -> list[str]:
    """Keys of the mapping at a location in the file, as often as they stand there."""
    for part in location:
        assert isinstance(node, yaml.MappingNode)  # as the file was found to be
        node = next(value for key, value in node.value if key.value == part)
    assert isinstance(node, yaml.MappingNode)
    return [key.value for key, _ in node.value]
