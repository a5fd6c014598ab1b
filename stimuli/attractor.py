"""Where the springs of a course are drawn to: goal, forcing term and phase.

Positions are offsets from the start; time is counted in shares of the duration.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from functools import lru_cache

import numpy as np

from stimuli.course import Course
from stimuli.trajectory import FloatArray

ROUNDING = 1e-9  # share of the duration by which rounding may miss a moment at which something changes
_REACH = 6  # centres; Gaussians further away are worth less than exp(-36), which is rounding
_COUNT = np.arange(1000.0)
_RECOVERY = 0.05  # of the duration, in which a bent clock finds back to an even pace after the end


def attractor(course: Course, shares: FloatArray) -> FloatArray:
    """Where the springs are drawn to at these shares of time, (n, d), as offsets from the start."""
    x = phase(course, shares)
    forcing = basis(x, len(course.weights)) @ course.causes[:-1]
    if course.around == "straight":
        forcing += (1 - course.exaggeration) * _straight(course, 1 - x)
    pull: FloatArray = filtered_goal(course, shares) - course.start + forcing / course.rate**2
    return pull


def attractor_at(course: Course, share: float) -> FloatArray:
    """The same at one moment, (d,), from the Gaussians that are near enough to matter."""
    if not course.is_linear:
        pull: FloatArray = attractor(course, np.array([share]))[0]
        return pull
    x, causes = phase_at(course, share), course.causes
    at = (1.0 - x) * (len(causes) - 2)  # counted in centres
    near = slice(max(0, math.ceil(at) - _REACH), min(len(causes) - 1, math.floor(at) + _REACH + 1))
    bumps = np.exp(-np.square(_COUNT[near] - at))
    pull = np.dot(bumps, causes[near]) * (x / sum(bumps.tolist()) / course.rate**2)
    pull += causes[-1]
    return pull


def filtered_goal(course: Course, shares: FloatArray) -> FloatArray:
    """The goals at these shares of time, (n or 1, d), gliding from the former ones where there is a lag."""
    if course.goal_lag_s == 0 or course.former_goal is None:
        goals = course.goal[None]
    else:
        gone = np.maximum(shares - course.goal_since, 0.0) * course.tau_s / course.goal_lag_s
        left = np.exp(-gone)[:, None]  # of the way
        goals = course.goal + left * (course.former_goal - course.goal)
    if course.until_then is None:
        return goals
    earlier = (shares < course.goal_since - ROUNDING)[:, None]
    return np.where(earlier, filtered_goal(course.until_then, shares), goals)


def heading_for(course: Course, positions: Mapping[int, float], share: float) -> Course:
    """The course with other goals in these columns from that share of time on; the other goals are kept."""
    goal = course.goal.copy()
    goal[list(positions)] = list(positions.values())
    if course.until_then is None or share >= course.goal_since - ROUNDING:
        here = filtered_goal(course, np.array([share]))[0]
        return replace(course, goal=goal, former_goal=here, goal_since=share, until_then=None)
    until_then = heading_for(course.until_then, positions, share)
    there = filtered_goal(until_then, np.array([course.goal_since]))[0]
    return replace(course, goal=goal, former_goal=there, until_then=until_then)


def phase(course: Course, shares: FloatArray) -> FloatArray:
    """The phase x at these shares of time: from 1 down to 0, then 0."""
    gone = np.minimum(clock(course, shares), 1.0)
    if course.progress is not None:
        gone = np.minimum(np.maximum(course.progress.gone(gone), 0.0), 1.0)
    return 1.0 - gone


def phase_at(course: Course, share: float) -> float:
    """The phase at one moment."""
    if course.clock is None and course.progress is None:
        return 1.0 - min(share, 1.0)
    return float(phase(course, np.array([share]))[0])


def clock(course: Course, shares: FloatArray) -> FloatArray:
    """What the course's clock shows at these shares of time; after the end it soon goes on evenly."""
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
    return _kept(x.tobytes(), n_weights) if len(x) > 1 else _basis(x, n_weights)


@lru_cache(maxsize=32)
def _kept(x_bytes: bytes, n_weights: int) -> FloatArray:
    """The basis of a whole motion, kept: most rollouts of a study share their phases."""
    made = _basis(np.frombuffer(x_bytes), n_weights)
    made.flags.writeable = False
    return made


def _basis(x: FloatArray, n_weights: int) -> FloatArray:
    bumps = np.exp(-((x[:, None] * (n_weights - 1) - np.arange(n_weights - 1.0, -1.0, -1.0)) ** 2))
    made: FloatArray = bumps * (x / bumps.sum(axis=1))[:, None]
    return made
