"""Can the robot do it? Ranges, velocities and, where known, accelerations, never silently clamped."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

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
    joints = [robot.joint(name) for name in trajectory.joints]
    nowhere = np.flatnonzero(~np.isfinite(trajectory.positions).all(axis=0))  # neither within nor beyond
    bounds = [(bounded, bounded.exceeded()) for bounded in _bounded(trajectory, joints)]
    found = []
    for column, joint in enumerate(joints):
        if column in nowhere:
            found.append(_nowhere(trajectory, column, joint))
        else:
            found += [bounded.worst(column, joint, trajectory) for bounded, over in bounds if over[column]]
    return [violation for violation in found if violation.quantity in quantities]


def _nowhere(trajectory: Trajectory, column: int, joint: Joint) -> Violation:
    y = trajectory.positions[:, column]
    first = int(np.flatnonzero(~np.isfinite(y))[0])
    time_s, value = float(trajectory.times[first]), float(y[first])
    return Violation(joint.name, "position", time_s, value, joint.upper, _unit(joint, 0), excess=np.inf)


@dataclass(frozen=True)
class _Bounded:
    """A quantity of all joints over time, and its bounds."""

    order: int  # of the derivative
    values: FloatArray  # (n, d)
    lower: FloatArray  # (d,)
    upper: FloatArray  # (d,)

    @property
    def quantity(self) -> str:
        """Its name."""
        return QUANTITIES[self.order]

    @property
    def slack(self) -> FloatArray:
        """What bounds may be exceeded by, (d,)."""
        return TOLERANCE * (self.upper - self.lower if self.order == 0 else self.upper)

    def excess(self) -> FloatArray:
        """How far beyond its bounds, (n, d); below zero within them."""
        with np.errstate(invalid="ignore"):  # joints that are nowhere are told apart
            excess: FloatArray = np.maximum(self.values - self.upper, self.lower - self.values)
        return excess

    def exceeded(self) -> NDArray[np.bool_]:
        """Which joints exceed it, (d,)."""
        exceeded: NDArray[np.bool_] = self.excess().max(axis=0, initial=-np.inf) > self.slack
        return exceeded

    def worst(self, column: int, joint: Joint, trajectory: Trajectory) -> Violation:
        """Where a joint exceeds it most."""
        lower, upper = float(self.lower[column]), float(self.upper[column])
        excess = self.excess()[:, column]
        worst = int(np.argmax(excess))
        value, time_s = float(self.values[worst, column]), float(trajectory.times[worst])
        limit, share = (upper if value > upper else lower), float(excess[worst]) / (upper - lower)
        return Violation(joint.name, self.quantity, time_s, value, limit, _unit(joint, self.order), share)


def _unit(joint: Joint, order: int) -> str:
    return (("" if joint.unit == "1" else joint.unit), f"{joint.unit}/s", f"{joint.unit}/s²")[order]


def _bounded(trajectory: Trajectory, joints: Sequence[Joint]) -> tuple[_Bounded, ...]:
    y, steps = trajectory.positions, np.diff(trajectory.times)[:, None]
    with np.errstate(invalid="ignore", over="ignore"):
        velocity = np.diff(y, axis=0) / steps
        acceleration = np.diff(velocity, axis=0) / steps[1:]
    fastest = _limits(joint.max_velocity for joint in joints)
    hardest = _limits(joint.max_acceleration for joint in joints)
    return (
        _Bounded(0, y, _limits(j.lower for j in joints), _limits(j.upper for j in joints)),
        _Bounded(1, velocity, -fastest, fastest),
        _Bounded(2, acceleration, -hardest, hardest),
    )


def _limits(written: Iterable[float | None]) -> FloatArray:
    """Limits of all joints, (d,); infinite where there is none."""
    return np.array([np.inf if limit is None else limit for limit in written])


def share_that_fits(good: Trajectory, bad: Trajectory, robot: Robot) -> float:
    """How much of the way from one motion to another, sample by sample, stays within every limit.

    In closed form: the smallest (limit - good) / (bad - good). Both motions need the same times.
    """
    share, joints = 1.0, [robot.joint(name) for name in good.joints]
    for here, there in zip(_bounded(good, joints), _bounded(bad, joints), strict=True):
        room = np.where(
            there.values > here.values,
            here.upper + here.slack - here.values,
            here.values - here.lower + here.slack,
        )
        way = np.abs(there.values - here.values)
        share = min(share, float(np.min(room[way > 0] / way[way > 0], initial=share)))
    return max(share, 0.0)


def margins(trajectory: Trajectory, robot: Robot) -> dict[str, dict[str, float]]:
    """Per joint: peak to peak, and what is left of the range, in its unit; of the velocity, as a share."""
    joints = [robot.joint(name) for name in trajectory.joints]
    position, velocity, _ = _bounded(trajectory, joints)
    amplitudes = np.ptp(position.values, axis=0)
    left = np.min(np.minimum(position.values - position.lower, position.upper - position.values), axis=0)
    fastest = np.max(np.abs(velocity.values), axis=0, initial=0.0)
    return {
        joint.name: {"amplitude": float(amplitudes[k]), "position": float(left[k])}
        | ({} if joint.max_velocity is None else {"velocity": float(1 - fastest[k] / joint.max_velocity)})
        for k, joint in enumerate(joints)
    }
