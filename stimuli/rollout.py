"""Carrying a course out in closed form: the whole motion at once, as linear filters.

Positions are offsets from the start, velocities per share of the duration, until they are handed out.
"""

from __future__ import annotations

import math

import numpy as np

from stimuli.attractor import ROUNDING, attractor
from stimuli.course import Course
from stimuli.errors import InputError
from stimuli.groups import groups
from stimuli.online import run
from stimuli.spring import respond, step_of
from stimuli.superposition import superposed
from stimuli.trajectory import FloatArray, Trajectory

REST = 1e-3  # of the largest amplitude; see roll_out
_STILL = 1e-12  # rad: motion below that is rounding
_EXTENSIONS = (1.0, 1.25, 1.5, 2.0, 3.0, 5.0, 10.0)  # of the duration, tried until the motion rests within it


def roll_out(course: Course, dt_s: float) -> Trajectory:
    """The motion along a course, sampled every dt_s: as long as its duration, and on until every joint rests.

    A joint rests once its distance from the goal plus its speed over the spring's rate is below `REST` of the
    largest amplitude in the motion: it can then, by the spring's own solution, never get further away than
    that. InputError where this takes more than ten durations.
    """
    whole = math.ceil(course.tau_s / dt_s - ROUNDING)
    for extension in _EXTENSIONS:
        n = math.ceil(extension * course.tau_s / dt_s - ROUNDING)
        positions, velocities = integrate(course, dt_s, n)
        unrest = np.abs(positions - course.goal) + np.abs(velocities) * course.tau_s / course.rate
        allowed = max(REST * np.ptp(positions, axis=0).max(), _STILL)
        restless = np.flatnonzero((unrest[whole:] > allowed).any(axis=1))
        last = whole + (int(restless[-1]) + 1 if len(restless) else 0)
        if last <= n:
            return Trajectory(sampled(last, dt_s), positions[: last + 1], course.joints)
    worst = int(np.argmax(unrest[-1]))
    away = abs(positions[-1, worst] - course.goal[worst])
    raise InputError(
        f"The motion does not come to rest within {_EXTENSIONS[-1]:g} durations: "
        f"{course.joints[worst]} is then {away:.3g} from its goal. "
        "Take a larger alpha, a shorter lag_s, or goals that move earlier"
    )


def sampled(n: int, step: float) -> FloatArray:
    """0, step, …, n step."""
    return np.arange(n + 1, dtype=np.float64) * step


def integrate(course: Course, dt_s: float, n: int) -> tuple[FloatArray, FloatArray]:
    """Positions and velocities per second at 0, dt_s, …, n dt_s along a course, (n + 1, d) each."""
    if course.clock is not None:  # no two steps are the same
        return run(course, dt_s, n)
    d, shares = len(course.joints), sampled(n, dt_s / course.tau_s)
    motion = _alone(course, shares)
    if not course.is_plain:
        motion = _together(course, motion, shares)
    positions, velocities = motion[0, :, :d], motion[1] / course.tau_s
    if course.carried is not None:
        positions = positions + velocities @ course.carried.T
    return course.start + positions, velocities[:, :d]


def _alone(course: Course, shares: FloatArray) -> FloatArray:
    """Motion (2, n + 1, d) as if no joint acted on another and none anticipated."""
    if course.is_linear:
        return superposed(course, shares)
    step = step_of(course.scheme, course.rate, shares[1])
    return respond(attractor(course, shares), np.zeros((2, len(course.joints))), step)


def _together(course: Course, alone: FloatArray, shares: FloatArray) -> FloatArray:
    """Motion (2, n + 1, c) of the joints and of what passes their gates, from what each would do alone."""
    gated = course.is_coupled or course.carried is not None
    motion = np.zeros((2, len(shares), len(course.joints) + len(course.gated) * gated))
    for group in groups(course, gated=gated):
        if group.gates is not None:
            steps, velocities = group.gates.passed(motion, course.start)
            motion[0, 1:, group.columns] = np.cumsum(steps, axis=0).T
            motion[1, :, group.columns] = velocities.T
            continue
        made, rest = alone[:, :, group.columns], np.zeros((2, len(group.columns)))
        step = step_of(course.scheme, course.rate, shares[1])
        shift, pushed = group.from_sources(motion)
        if group.anticipates:
            turned = step_of(course.scheme, course.rate, shares[1], group.gain)
            border = int(np.count_nonzero(shares[:-1] < course.window - ROUNDING))  # steps in the window
            group.refuse_overrun(course, shares[border])
            pull = attractor(course, shares)[:, group.columns]
            begun = respond((group.mirror * pull + pushed)[: border + 1], rest, turned)
            ended = respond((pull + pushed)[border:], begun[:, -1], step)
            made = np.concatenate([begun[:, :-1], ended], axis=1)
        elif group.depth:
            made = made + respond(pushed, rest, step)
        motion[:, :, group.columns] = made - shift
    return motion
