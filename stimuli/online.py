"""Carrying a course out step by step, with a goal, a duration and intensities that may change on the way."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from stimuli.attractor import attractor, clock, filtered_goal, levels, pace
from stimuli.course import Course
from stimuli.spring import decay, step_of
from stimuli.trajectory import FloatArray

ROUNDING = 1e-9  # share of the duration by which rounding may miss the border of a window


class Runner:
    """A motion under way. Its steps are those of `stimuli.rollout.integrate`.

    `change` swaps the course without a jump in position or velocity: the state and the share of time gone by
    are kept, and the strength of Secondary Action, which shows without acting on the state, follows as a
    spring would.
    """

    def __init__(
        self, course: Course, positions: FloatArray | None = None, velocities: FloatArray | None = None
    ) -> None:
        """At the course's start and at rest, unless it comes from elsewhere, as in a sequence of motions."""
        d = len(course.joints)
        self.course = course
        self.share = 0.0  # of the duration gone by
        self._motion = np.zeros((2, d))  # offsets from the start; velocities per share of the clock
        self._carried_off = np.zeros(
            (2, d, d)
        )  # how far the strength of Secondary Action still is from the course's
        if positions is not None:
            self._motion[0] = positions - course.start
        if velocities is not None:
            self._motion[1] = velocities * course.tau_s / max(pace(course, 0.0), ROUNDING)

    @property
    def positions(self) -> FloatArray:
        """Positions shown now, (d,)."""
        shown: FloatArray = self.course.start + self._motion[0] + self._carried @ self.velocities
        return shown

    @property
    def velocities(self) -> FloatArray:
        """Velocities of the state now, per second, (d,): without Secondary Action."""
        now: FloatArray = self._motion[1] * (pace(self.course, self.share) / self.course.tau_s)
        return now

    def step(self, dt_s: float, goal: Mapping[str, float] | None = None) -> FloatArray:
        """Go on for dt_s, first setting new goals for the joints named; returns the positions shown, (d,)."""
        if goal:
            self.head_for(goal)
        course = self.course
        shares = np.array([self.share, self.share + dt_s / course.tau_s])
        pull = attractor(course, shares)  # (2, d)
        ticks = clock(course, shares)
        gains = np.ones(len(course.joints))
        if ticks[0] < course.window - ROUNDING:
            gains = gains if course.gain is None else course.gain
            pull = pull if course.mirror is None else pull * course.mirror
        self._motion = self._moved(pull, gains, float(ticks[1] - ticks[0]))
        self._carried_off = np.tensordot(
            decay(course.rate, float(shares[1] - shares[0])), self._carried_off, axes=1
        )
        self.share = float(shares[1])
        return self.positions

    def change(self, course: Course) -> None:
        """Go on along another course of the same joints."""
        self._carried_off[0] = self._carried - course.carrying
        self._carried_off[1] *= course.tau_s / self.course.tau_s
        self._motion[0] += self.course.start - course.start
        quicker = pace(self.course, self.share) / max(pace(course, self.share), ROUNDING)
        self._motion[1] *= course.tau_s / self.course.tau_s * quicker
        self.course = course

    def head_for(self, goal: Mapping[str, float]) -> None:
        """Go on to other goals of the joints named, gliding there if the course's goals do."""
        wanted = self.course.goal.copy()
        for joint, position in goal.items():
            wanted[self.course.joints.index(joint)] = position
        if not np.array_equal(wanted, self.course.goal):
            here = filtered_goal(self.course, np.array([self.share]))[0]
            self.change(replace(self.course, goal=wanted, former_goal=here, goal_since=self.share))

    @property
    def _carried(self) -> FloatArray:
        """Strength of Secondary Action now, (d, d) s."""
        strength: FloatArray = self.course.carrying + self._carried_off[0]
        return strength

    def _moved(self, pull: FloatArray, gains: FloatArray, h: float) -> FloatArray:
        """The state (2, d) after a step of h shares; `pull` (2, d) are the attractors before and after it."""
        course = self.course
        states = np.stack([self._motion, np.zeros_like(self._motion)])  # (before and after, y and y', d)
        for level in levels(course):
            shift = states @ course.displaced[level].T
            chased = (
                pull[:, level] + shift[:, 0] + states[:, 1] @ (2 / course.rate * course.dragging[level].T)
            )
            state = states[0][:, level] + shift[0]
            for value in np.unique(gains[level]):
                same = np.flatnonzero(gains[level] == value)
                step = step_of(course.scheme, course.rate, h, float(value))
                made = step.across @ state[:, same]
                made += np.outer(step.before, chased[0, same]) + np.outer(step.after, chased[1, same])
                states[1][:, level[same]] = made - shift[1][:, same]
        after: FloatArray = states[1]
        return after


def run(course: Course, dt_s: float, n: int) -> tuple[FloatArray, FloatArray]:
    """Positions and velocities per second at 0, dt_s, …, n dt_s along a course, (n + 1, d) each; by steps."""
    runner = Runner(course)
    positions, velocities = [runner.positions], [runner.velocities]
    for _ in range(n):
        positions.append(runner.step(dt_s))
        velocities.append(runner.velocities)
    return np.stack(positions), np.stack(velocities)


def in_sequence(courses: list[Course], dt_s: float, handover: float = 1.0) -> FloatArray:
    """Positions (n, d) of motions one after the other, each setting out from the state the last one left.

    A motion hands over at that share of its duration; the last one runs to its end. Position and velocity are
    continuous: the next motion starts from the state it is given, not from its own demonstration's.
    """
    positions: list[FloatArray] = []
    runner = Runner(courses[0])
    for course, until in zip(courses, [handover] * (len(courses) - 1) + [1.0], strict=True):
        if positions:
            runner = Runner(course, positions=positions.pop(), velocities=runner.velocities)
        positions.append(runner.positions)
        while runner.share < until - ROUNDING:
            positions.append(runner.step(dt_s))
    return np.stack(positions)
