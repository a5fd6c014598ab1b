"""Can the robot do it? Ranges, velocities and, where known, accelerations, never silently clamped."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from stimuli.robots.model import Joint, Robot
from stimuli.trajectory import FloatArray, Trajectory

TOLERANCE = 1e-3  # of the joint's range or its limit: what learning may miss a demonstration by


@dataclass(frozen=True)
class Violation:
    """The worst place at which a motion exceeds a limit."""

    joint: str
    quantity: str  # position, velocity, acceleration
    time_s: float
    value: float
    limit: float
    unit: str
    excess: float  # beyond the limit, as a share of all that is allowed

    def __str__(self) -> str:
        value = f"{self.quantity} {self.value:.4g} {self.unit}".rstrip()
        return f"{self.joint} at {self.time_s:.2f} s: {value}, limit {self.limit:.4g}"


def in_short(violations: list[Violation], at_most: int = 4) -> str:
    """The worst of them, and how many there are besides."""
    worst = sorted(violations, key=lambda violation: -violation.excess)
    named = "; ".join(str(violation) for violation in worst[:at_most])
    more = len(worst) - at_most
    return named + (f"; and {more} more limit{'s' if more > 1 else ''} exceeded" if more > 0 else "")


QUANTITIES = ("position", "velocity", "acceleration")


def violations(
    trajectory: Trajectory, robot: Robot, quantities: tuple[str, ...] = QUANTITIES
) -> list[Violation]:
    """Every limit exceeded, worst place each, in the order of the joints."""
    found = [
        violation for name in trajectory.joints for violation in _of_joint(trajectory, robot.joint(name))
    ]
    return [violation for violation in found if violation.quantity in quantities]


def _of_joint(trajectory: Trajectory, joint: Joint) -> list[Violation]:
    nowhere = np.flatnonzero(~np.isfinite(trajectory.joint(joint.name)))
    if nowhere.size:  # neither within limits nor beyond them
        value, time_s = trajectory.joint(joint.name)[nowhere[0]], trajectory.times[nowhere[0]]
        unit = "" if joint.unit == "1" else joint.unit
        return [
            Violation(joint.name, "position", float(time_s), float(value), joint.upper, unit, excess=np.inf)
        ]
    found = []
    for bounded in _bounded(trajectory, joint):
        excess: FloatArray = np.maximum(bounded.values - bounded.upper, bounded.lower - bounded.values)
        if excess.size and excess.max() > bounded.slack:
            worst = int(np.argmax(excess))
            value, time_s = float(bounded.values[worst]), float(trajectory.times[worst])
            limit = bounded.upper if value > bounded.upper else bounded.lower
            share = float(excess[worst]) / (bounded.upper - bounded.lower)
            found.append(Violation(joint.name, bounded.quantity, time_s, value, limit, bounded.unit, share))
    return found


@dataclass(frozen=True)
class _Bounded:
    """A quantity of a joint over time, and its bounds."""

    quantity: str
    unit: str
    values: FloatArray
    lower: float
    upper: float
    slack: float


def _bounded(trajectory: Trajectory, joint: Joint) -> tuple[_Bounded, ...]:
    y = trajectory.joint(joint.name)
    velocity = np.diff(y) / np.diff(trajectory.times)
    acceleration = np.diff(velocity) / np.diff(trajectory.times)[1:]
    unit = joint.unit
    return (
        _Bounded(
            "position", "" if unit == "1" else unit, y, joint.lower, joint.upper, TOLERANCE * joint.range
        ),
        _Bounded("velocity", f"{unit}/s", velocity, *_both_ways(joint.max_velocity)),
        _Bounded("acceleration", f"{unit}/s²", acceleration, *_both_ways(joint.max_acceleration)),
    )


def share_that_fits(good: Trajectory, bad: Trajectory, robot: Robot) -> float:
    """How much of the way from one motion to another, sample by sample, stays within every limit.

    In closed form: the smallest (limit - good) / (bad - good). Both motions need the same times.
    """
    share = 1.0
    for name in good.joints:
        joint = robot.joint(name)
        for here, there in zip(_bounded(good, joint), _bounded(bad, joint), strict=True):
            room = np.where(
                there.values > here.values,
                here.upper + here.slack - here.values,
                here.values - here.lower + here.slack,
            )
            way = np.abs(there.values - here.values)
            share = min(share, float(np.min(room[way > 0] / way[way > 0], initial=share)))
    return max(share, 0.0)


def _both_ways(limit: float | None) -> tuple[float, float, float]:
    bound = np.inf if limit is None else limit
    return -bound, bound, 0.0 if limit is None else TOLERANCE * limit


def margins(trajectory: Trajectory, robot: Robot) -> dict[str, dict[str, float]]:
    """Per joint: peak to peak, and what is left of the range, in its unit; of the velocity, as a share."""
    left = {}
    for name in trajectory.joints:
        joint, y = robot.joint(name), trajectory.joint(name)
        left[name] = {
            "amplitude": float(np.ptp(y)),
            "position": float(min(y.min() - joint.lower, joint.upper - y.max())),
        }
        if joint.max_velocity is not None:
            fastest = float(np.max(np.abs(np.diff(y) / np.diff(trajectory.times)), initial=0.0))
            left[name]["velocity"] = 1 - fastest / joint.max_velocity
    return left
