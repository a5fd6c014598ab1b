"""Where the springs of a course are drawn to: goal, forcing term and phase.

Positions are offsets from the start; time is counted in shares of the duration.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from stimuli.course import Course
from stimuli.trajectory import FloatArray, IndexArray

_RECOVERY = 0.05  # of the duration, in which a bent clock finds back to an even pace after the end


def levels(course: Course) -> list[IndexArray]:
    """Columns of joints that can be carried out at once: those without sources, then those they drive, …"""
    depth = np.zeros(len(course.joints), dtype=np.int64)
    if course.is_coupled:
        depends = (course.displaced != 0) | (course.dragging != 0)
        for _ in course.joints:
            depth = np.max(np.where(depends, depth + 1, 0), axis=1, initial=0)
    return [np.flatnonzero(depth == at) for at in range(int(depth.max()) + 1)]


def attractor(course: Course, shares: FloatArray) -> FloatArray:
    """Where the springs are drawn to at these shares of time, (n, d), as offsets from the start."""
    x = phase(course, shares)
    forcing = course.exaggeration * (basis(x, len(course.weights)) @ course.weights)
    if course.around == "straight":
        forcing += (1 - course.exaggeration) * _straight(course, 1 - x)
    pull: FloatArray = filtered_goal(course, shares) - course.start + forcing / course.rate**2
    return pull


def filtered_goal(course: Course, shares: FloatArray) -> FloatArray:
    """The goals at these shares of time, (n or 1, d), gliding from the former ones where there is a lag."""
    if course.goal_lag_s == 0 or course.former_goal is None:
        return course.goal[None]
    left = np.exp((course.goal_since - shares) * course.tau_s / course.goal_lag_s)[:, None]  # of the way
    return course.goal + left * (course.former_goal - course.goal)


def phase(course: Course, shares: FloatArray) -> FloatArray:
    """The phase x at these shares of time: from 1 down to 0, then 0."""
    gone = np.clip(clock(course, shares), 0.0, 1.0)
    if course.progress is not None:
        gone = np.clip(course.progress.gone(gone), 0.0, 1.0)
    return 1.0 - gone


def clock(course: Course, shares: FloatArray) -> FloatArray:
    """What the course's clock shows at these shares of time; after the end it goes on, soon at an even pace."""
    if course.clock is None:
        return shares
    over = np.maximum(shares - 1.0, 0.0)
    lost = (1.0 - _last_pace(course)) * _RECOVERY * -np.expm1(-over / _RECOVERY)
    return np.where(shares <= 1.0, course.clock.gone(np.minimum(shares, 1.0)), 1.0 + over - lost)


def pace(course: Course, share: float) -> float:
    """How fast the clock goes then, 1 being even."""
    if course.clock is None:
        return 1.0
    if share <= 1.0:
        return float(course.clock.slope(np.array([share]))[0])
    return 1.0 - (1.0 - _last_pace(course)) * float(np.exp((1.0 - share) / _RECOVERY))


def _last_pace(course: Course) -> float:
    return pace(course, 1.0)


def _straight(course: Course, gone: FloatArray) -> FloatArray:
    """Forcing term (n, d) of a minimum-jerk reach, which goes 10 s^3 - 15 s^4 + 6 s^5 of the way by s."""
    s = gone[:, None]
    way, rate = s**3 * (10 - 15 * s + 6 * s**2), course.rate
    speed, acceleration = 30 * s**2 * (1 - s) ** 2, 60 * s * (1 - s) * (1 - 2 * s)
    return (course.goal - course.start) * (acceleration + 2 * rate * speed - rate**2 * (1 - way))


def basis(x: FloatArray, n_weights: int) -> FloatArray:
    """Normalised Gaussians times the phase, (n, n_weights): forcing terms are this @ weights.

    Centres lie at equal distances in phase, hence in time, from 1 down to 0; each Gaussian is worth exp(-1)
    at the centres of its neighbours.
    """
    return _basis(x.tobytes(), n_weights)


@lru_cache(maxsize=32)
def _basis(x_bytes: bytes, n_weights: int) -> FloatArray:
    """`basis`, kept: most rollouts of a study share their phases."""
    x = np.frombuffer(x_bytes)[:, None]
    bumps = np.exp(-(((x - np.linspace(1.0, 0.0, n_weights)) * (n_weights - 1)) ** 2))
    made: FloatArray = bumps * (x / bumps.sum(axis=1, keepdims=True))
    made.flags.writeable = False
    return made
