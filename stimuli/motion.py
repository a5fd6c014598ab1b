"""From the description of a stimulus to the robot's motion."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from stimuli.dmp import Learning, Primitive
from stimuli.errors import InputError
from stimuli.feasibility import in_short, margins, violations
from stimuli.gestures import read_gesture
from stimuli.principles import Modulation
from stimuli.principles.ant import growths
from stimuli.remedies import advice, retimed
from stimuli.robots.model import Robot
from stimuli.rollout import roll_out
from stimuli.spec import StimulusSpec
from stimuli.trajectory import Trajectory

DEMONSTRATED = (
    "position",
    "velocity",
)  # limits that a demonstration is held to; its accelerations may be noise


LEAST_STEPS = 10  # of a motion; in fewer its speeds would not show


@dataclass(frozen=True)
class Motion:
    """What the robot does in a stimulus, and what it was shown."""

    demonstration: Trajectory
    trajectory: Trajectory  # from rest to rest: after the duration it goes on until every joint has settled
    modulation: Modulation  # as asked for, but for the duration where that was let go (`fit: scale`)
    margins: dict[str, dict[str, float]]
    """Per joint: amplitude, left of its range (its unit), of its velocity limit (share), and growth of its
    anticipation."""


@dataclass(frozen=True)
class Lesson:
    """What a robot was shown, and what it learned of it."""

    demonstration: Trajectory
    primitive: Primitive


def learn(gesture: Path, robot: Robot, learning: Learning) -> Lesson:
    """Read a gesture and learn it. InputError where it cannot be read, or the robot cannot do it."""
    demonstration = read_gesture(gesture, robot, learning.dt_s)
    beyond = violations(demonstration, robot, DEMONSTRATED)
    if beyond:
        raise InputError(
            f"{gesture}: the demonstration itself exceeds what {robot.name} can do: {in_short(beyond)}"
        )
    return Lesson(demonstration, Primitive.learn(demonstration, learning))


def generate(spec: StimulusSpec, robot: Robot, lesson: Lesson | None = None) -> Motion:
    """The motion of a stimulus. InputError where the robot cannot do it, saying what it could.

    `lesson` is what `learn` made of the gesture, where many stimuli share it.
    """
    lesson = lesson or learn(spec.gesture, robot, spec.learning)
    primitive, modulation = lesson.primitive, spec.modulation
    try:
        course = primitive.course(modulation, robot)
        _refuse_too_short(course.tau_s, spec.learning.dt_s)
        trajectory = roll_out(course, spec.learning.dt_s)
        exceeded = violations(trajectory, robot)
        if exceeded and (longer := retimed(primitive, modulation, robot)):
            modulation, course = longer, primitive.course(longer, robot)
            trajectory, exceeded = roll_out(course, spec.learning.dt_s), []
    except InputError as err:
        raise InputError(f"{spec.id}: {err}") from err
    if exceeded:
        raise InputError(f"{spec.id}: {in_short(exceeded)}. {advice(primitive, modulation, robot)}")
    left = margins(trajectory, robot)
    for joint, growth in growths(course).items():
        left[joint]["anticipation_growth"] = growth
    return Motion(lesson.demonstration, trajectory, modulation, left)


def _refuse_too_short(tau_s: float, dt_s: float) -> None:
    if tau_s < LEAST_STEPS * dt_s:
        least = f"less than {LEAST_STEPS} steps of {dt_s:g} s; take a larger time.intensity"
        raise InputError(f"lasts {tau_s:.2g} s, {least}")
