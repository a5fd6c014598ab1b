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

    def __str__(self) -> str:
        excess = f"{self.quantity} {self.value:.4g} {self.unit}, limit {self.limit:.4g}"
        return f"{self.joint} at {self.time_s:.2f} s: {excess}"


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
    y = trajectory.joint(joint.name)
    velocity = np.diff(y) / np.diff(trajectory.times)
    acceleration = np.diff(velocity) / np.diff(trajectory.times)[1:]
    found = []
    for quantity, unit, values, lower, upper, slack in (
        ("position", joint.unit, y, joint.lower, joint.upper, TOLERANCE * joint.range),
        ("velocity", f"{joint.unit}/s", velocity, *_both_ways(joint.max_velocity)),
        ("acceleration", f"{joint.unit}/s²", acceleration, *_both_ways(joint.max_acceleration)),
    ):
        excess: FloatArray = np.maximum(values - upper, lower - values)
        if excess.size and excess.max() > slack:
            worst = int(np.argmax(excess))
            limit = upper if values[worst] > upper else lower
            found.append(
                Violation(
                    joint.name, quantity, float(trajectory.times[worst]), float(values[worst]), limit, unit
                )
            )
    return found


def _both_ways(limit: float | None) -> tuple[float, float, float]:
    bound = np.inf if limit is None else limit
    return -bound, bound, 0.0 if limit is None else TOLERANCE * limit


def margins(trajectory: Trajectory, robot: Robot) -> dict[str, dict[str, float]]:
    """What is left, per joint: of the range in the joint's unit, of the velocity as a share of its limit."""
    left = {}
    for name in trajectory.joints:
        joint, y = robot.joint(name), trajectory.joint(name)
        left[name] = {"position": float(min(y.min() - joint.lower, joint.upper - y.max()))}
        if joint.max_velocity is not None:
            fastest = float(np.max(np.abs(np.diff(y) / np.diff(trajectory.times)), initial=0.0))
            left[name]["velocity"] = 1 - fastest / joint.max_velocity
    return left
