"""From the description of a stimulus to the robot's motion."""

from __future__ import annotations

from dataclasses import dataclass

from stimuli.dmp import Primitive
from stimuli.errors import InputError
from stimuli.feasibility import margins, violations
from stimuli.gestures import read_gesture
from stimuli.principles import Modulation
from stimuli.robots.model import Robot
from stimuli.spec import StimulusSpec
from stimuli.trajectory import Trajectory

DEMONSTRATED = (
    "position",
    "velocity",
)  # limits that a demonstration is held to; its accelerations may be noise
_BISECTIONS = 12


@dataclass(frozen=True)
class Motion:
    """What the robot does in a stimulus, and what it was shown."""

    demonstration: Trajectory
    trajectory: Trajectory  # from rest to rest: after the duration it goes on until every joint has settled
    margins: dict[
        str, dict[str, float]
    ]  # per joint, left of its range (its unit) and of its velocity limit (share)


def generate(spec: StimulusSpec, robot: Robot) -> Motion:
    """The motion of a stimulus. InputError where the robot cannot do it, saying what it could."""
    demonstration = read_gesture(spec.gesture, robot, spec.learning.dt_s)
    beyond = violations(demonstration, robot, DEMONSTRATED)
    if beyond:
        places = "; ".join(map(str, beyond))
        raise InputError(
            f"{spec.gesture}: the demonstration itself exceeds what {robot.name} can do: {places}"
        )
    primitive = Primitive.learn(demonstration, spec.learning)
    try:
        trajectory = primitive.rollout(spec.modulation, robot)
    except InputError as err:
        raise InputError(f"{spec.id}: {err}") from err
    exceeded = violations(trajectory, robot)
    if exceeded:
        remedies = largest_that_fit(primitive, spec.modulation, robot)
        advice = (
            f"It would fit with {' or '.join(remedies)}" if remedies else "No single intensity makes it fit"
        )
        raise InputError(f"{spec.id}: {'; '.join(map(str, exceeded))}. {advice}.")
    return Motion(demonstration, trajectory, margins(trajectory, robot))


def largest_that_fit(primitive: Primitive, modulation: Modulation, robot: Robot) -> list[str]:
    """For each principle alone, the intensity nearest to the wanted one that the robot can do, by bisection.

    Principles that cannot make the motion fit, even when neutral, are left out.
    """

    def fits(tried: Modulation) -> bool:
        return not violations(primitive.rollout(tried, robot), robot)

    remedies = []
    for principle in modulation.principles:

        def at(intensity: float, principle=principle) -> Modulation:  # type: ignore[no-untyped-def]
            return modulation.with_(principle.model_copy(update={"intensity": intensity}))

        good, bad = principle.neutral, principle.intensity
        if principle.is_neutral or not fits(at(good)):
            continue
        for _ in range(_BISECTIONS):
            middle = (good + bad) / 2
            good, bad = (middle, bad) if fits(at(middle)) else (good, middle)
        remedies.append(f"{principle.kind}.intensity {good:.3g}")
    return remedies
