"""Carrying a course out in closed form: the whole motion at once, as linear filters.

Positions are offsets from the start, velocities per share of the duration, until they are handed out.
"""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np

from stimuli.course import Course
from stimuli.spring import respond, step_of
from stimuli.trajectory import FloatArray, IndexArray, Trajectory

REST = 1e-3  # of the largest amplitude; see roll_out
_EXTENSIONS = (1.0, 1.25, 1.5, 2.0, 3.0, 5.0, 10.0)  # of the duration, tried until the motion rests within it
ROUNDING = 1e-9  # share of the duration by which rounding may miss a border


def roll_out(course: Course, dt_s: float) -> Trajectory:
    """The motion along a course, sampled every dt_s: as long as its duration, and on until every joint rests.

    A joint rests once its distance from the goal plus its speed over the spring's rate is below `REST` of the
    largest amplitude in the motion: it can then, by the spring's own solution, never get further away than that.
    """
    whole = math.ceil(course.tau_s / dt_s - ROUNDING)
    for extension in _EXTENSIONS:
        n = math.ceil(extension * course.tau_s / dt_s - ROUNDING)
        positions, velocities = integrate(course, dt_s, n)
        unrest = np.abs(positions - course.goal) + np.abs(velocities) * course.tau_s / course.rate
        allowed = REST * np.ptp(positions, axis=0).max()
        restless = np.flatnonzero((unrest[whole:] > allowed).any(axis=1))
        last = whole + (int(restless[-1]) + 1 if len(restless) else 0)
        if last <= n:
            break
    last = min(last, n)
    return Trajectory(np.arange(last + 1) * dt_s, positions[: last + 1], course.joints)


def integrate(course: Course, dt_s: float, n: int) -> tuple[FloatArray, FloatArray]:
    """Positions and velocities per second at 0, dt_s, …, n dt_s along a course, (n + 1, d) each."""
    if course.clock is not None:
        from stimuli.online import run

        return run(course, dt_s, n)
    h = dt_s / course.tau_s
    shares = np.arange(n + 1) * h
    pull = attractor(course, shares)  # (n + 1, d)
    motion = np.zeros((2, *pull.shape))
    border = int(np.count_nonzero(shares[:-1] < course.window - ROUNDING))
    for span, gain, mirror in (
        (slice(0, border + 1), course.gain, course.mirror),
        (slice(border, n + 1), None, None),
    ):
        if span.stop - span.start < 2:
            continue
        _fill(motion[:, span], pull[span] if mirror is None else pull[span] * mirror, gain, course, h)
    positions, velocities = motion[0], motion[1] / course.tau_s
    if course.carried is not None:
        positions = positions + velocities @ course.carried.T
    return course.start + positions, velocities


def _fill(motion: FloatArray, pull: FloatArray, gain: FloatArray | None, course: Course, h: float) -> None:
    """Fill in `motion` (2, n + 1, d), from its first state on, that of springs with attractors `pull` (n + 1, d)."""
    gains = np.ones(len(course.joints)) if gain is None else gain
    for level in levels(course):
        chased, shift = pull[:, level], None
        if course.is_coupled:
            shift = motion @ course.displaced[level].T  # (2, n + 1, joints of this level)
            chased = chased + shift[0] + motion[1] @ (2 / course.rate * course.dragging[level].T)
        for value in np.unique(gains[level]):
            same = np.flatnonzero(gains[level] == value)
            columns = level[same]
            state = motion[:, 0, columns] + (0 if shift is None else shift[:, 0, same])
            made = respond(chased[:, same], state, step_of(course.scheme, course.rate, h, float(value)))
            motion[:, :, columns] = made - (0 if shift is None else shift[:, :, same])


def levels(course: Course) -> list[IndexArray]:
    """Columns of the joints that can be carried out at once: first those without sources, then those they drive."""
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
    pull: FloatArray = course.goal - course.start + forcing / course.rate**2
    if course.goal_lag_s > 0 and course.former_goal is not None:
        glide = np.exp(-shares * course.tau_s / course.goal_lag_s)[:, None]
        pull += glide * (course.former_goal - course.goal)
    return pull


def phase(course: Course, shares: FloatArray) -> FloatArray:
    """The phase x at these shares of time: from 1 down to 0, then 0."""
    gone = np.clip(shares, 0.0, 1.0)
    for curve in (course.clock, course.progress):
        gone = gone if curve is None else np.clip(curve(gone), 0.0, 1.0)
    return 1.0 - gone


def _straight(course: Course, gone: FloatArray) -> FloatArray:
    """Forcing term (n, d) of a minimum-jerk reach, which goes 10 s^3 - 15 s^4 + 6 s^5 of the way by s."""
    s = gone[:, None]
    way, rate = s**3 * (10 - 15 * s + 6 * s**2), course.rate
    speed, acceleration = 30 * s**2 * (1 - s) ** 2, 60 * s * (1 - s) * (1 - 2 * s)
    return (course.goal - course.start) * (acceleration + 2 * rate * speed - rate**2 * (1 - way))


def basis(x: FloatArray, n_weights: int) -> FloatArray:
    """Normalised Gaussians times the phase, (n, n_weights): forcing terms are this @ weights.

    Centres lie at equal distances in phase, hence in time, from 1 down to 0; each Gaussian is worth exp(-1) at
    the centres of its neighbours.
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
