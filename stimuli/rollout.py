"""Carrying a course out in closed form: the whole motion at once, as linear filters.

Positions are offsets from the start, velocities per share of the duration, until they are handed out.
"""

from __future__ import annotations

import math

import numpy as np

from stimuli.attractor import ROUNDING, attractor, groups
from stimuli.course import Course
from stimuli.online import run
from stimuli.spring import respond, step_of
from stimuli.trajectory import FloatArray, Trajectory

REST = 1e-3  # of the largest amplitude; see roll_out
_EXTENSIONS = (1.0, 1.25, 1.5, 2.0, 3.0, 5.0, 10.0)  # of the duration, tried until the motion rests within it


def roll_out(course: Course, dt_s: float) -> Trajectory:
    """The motion along a course, sampled every dt_s: as long as its duration, and on until every joint rests.

    A joint rests once its distance from the goal plus its speed over the spring's rate is below `REST` of the
    largest amplitude in the motion: it can then, by the spring's own solution, never get further away than
    that.
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
    return Trajectory(sampled(last, dt_s), positions[: last + 1], course.joints)


def sampled(n: int, step: float) -> FloatArray:
    """0, step, …, n step."""
    return np.arange(n + 1, dtype=np.float64) * step


def integrate(course: Course, dt_s: float, n: int) -> tuple[FloatArray, FloatArray]:
    """Positions and velocities per second at 0, dt_s, …, n dt_s along a course, (n + 1, d) each."""
    if course.clock is not None:  # no two steps are the same
        return run(course, dt_s, n)
    h = dt_s / course.tau_s
    shares = sampled(n, h)
    anticipating = int(np.count_nonzero(shares[:-1] < course.window - ROUNDING))  # steps
    pull = attractor(course, shares)  # (n + 1, d)
    gated = course.is_coupled or course.carried is not None
    d = len(course.joints)
    motion = np.zeros((2, n + 1, d + len(course.gated) * gated))
    for group in groups(course, gated=gated):
        if group.gates is not None:
            steps, velocities = group.gates.passed(motion, course.start)
            motion[0, 1:, group.columns] = np.cumsum(steps, axis=0).T
            motion[1, :, group.columns] = velocities.T
            continue
        own = pull[:, group.columns]
        if group.depth:
            shift = motion @ course.displaced[group.columns].T
            pushed = shift[0] + motion[1] @ (2 / course.rate * course.dragging[group.columns].T)
        else:
            shift, pushed = np.zeros((2, 1, 1)), np.zeros((1, 1))
        border = anticipating if group.anticipates else 0
        made = np.zeros((2, 1, own.shape[1]))
        if border:
            turned = group.mirror * own + pushed
            step = step_of(course.scheme, course.rate, h, group.gain)
            made = respond(turned[: border + 1], made[:, 0], step)
        step = step_of(course.scheme, course.rate, h)
        rest = respond((own + pushed)[border:], made[:, -1], step)
        motion[:, :, group.columns] = np.concatenate([made[:, :-1], rest], axis=1) - shift
    positions, velocities = motion[0, :, :d], motion[1] / course.tau_s
    if course.carried is not None:
        positions = positions + velocities @ course.carried.T
    return course.start + positions, velocities[:, :d]
