"""Carrying a course out step by step, with a goal, a duration and intensities that may change on the way."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from stimuli.attractor import ROUNDING, attractor_at, clock, filtered_goal, pace
from stimuli.course import Course
from stimuli.groups import groups
from stimuli.spring import decay, step_of
from stimuli.trajectory import FloatArray


class Runner:
    """A motion under way. Its steps are those of `stimuli.rollout.integrate`.

    `change` swaps the course without a jump in position or velocity: the state and the share of time gone by
    are kept, and the strength of Secondary Action, which shows without acting on the state, follows as
    springs do.
    """

    def __init__(
        self, course: Course, positions: FloatArray | None = None, velocities: FloatArray | None = None
    ) -> None:
        """At the course's start and at rest, unless it comes from elsewhere, as in a sequence of motions."""
        d, c = len(course.joints), len(course.joints) + len(course.gated)
        self.share = 0.0  # of the duration gone by
        # Offsets from the start of all joints and what passed the gates; velocities per share of the clock.
        self._motion = np.zeros((2, c))
        # Change of Secondary Action's strength still to come, and its rate.
        self._pending = np.zeros((2, d, c))
        self._carries = False
        self._pull = np.zeros(d)  # attractors now
        if positions is not None:
            self._motion[0, :d] = positions - course.start
        if velocities is not None:
            self._motion[1, :d] = velocities * course.tau_s / max(pace(course, 0.0), ROUNDING)
        self._set_out(course)

    @property
    def positions(self) -> FloatArray:
        """Positions shown now, (d,)."""
        shown: FloatArray = self.course.start + self._motion[0, : len(self.course.joints)]
        if self._carries:
            shown += (self.course.carrying + self._pending[0]) @ self._velocities
        return shown

    @property
    def velocities(self) -> FloatArray:
        """Velocities of the state now, per second, (d,): without Secondary Action."""
        return self._velocities[: len(self.course.joints)]

    @property
    def _velocities(self) -> FloatArray:
        now: FloatArray = self._motion[1] * (pace(self.course, self.share) / self.course.tau_s)
        return now

    def step(self, dt_s: float, goal: Mapping[str, float] | None = None) -> FloatArray:
        """Go on for dt_s, first setting new goals for the joints named; returns the positions shown, (d,)."""
        if goal:
            self.head_for(goal)
        course, before = self.course, self.share
        h = dt_s / course.tau_s
        if self._carries:
            self._pending = np.tensordot(decay(course.rate, h), self._pending, axes=1)
        self.share += h
        pull, self._pull = self._pull, attractor_at(course, self.share)
        now = before
        if course.clock is not None:
            now, then = clock(course, np.array([before, self.share])).tolist()
            h = then - now
        self._move(pull, h, now < course.window - ROUNDING)
        return self.positions

    def change(self, course: Course) -> None:
        """Go on along another course of the same joints."""
        former, share = self.course, self.share
        slower = course.tau_s / former.tau_s
        self._pending[0] += former.carrying - course.carrying
        self._pending[1] *= slower
        self._motion[0, : len(course.joints)] += former.start - course.start
        self._motion[1] *= slower * pace(former, share) / max(pace(course, share), ROUNDING)
        self._set_out(course)

    def head_for(self, goal: Mapping[str, float]) -> None:
        """Go on to other goals of the joints named, gliding there if the course's goals do."""
        wanted = self.course.goal.copy()
        for joint, position in goal.items():
            wanted[self.course.joints.index(joint)] = position
        if not np.array_equal(wanted, self.course.goal):
            here = filtered_goal(self.course, np.array([self.share]))[0]
            self.change(replace(self.course, goal=wanted, former_goal=here, goal_since=self.share))

    def _set_out(self, course: Course) -> None:
        self.course = course
        self._pull = attractor_at(course, self.share)
        self._carries = course.carried is not None or bool(self._pending.any())
        alone = course.is_plain and not self._carries
        self._groups = [] if alone else groups(course, gated=self._carries or course.is_coupled)
        for group in self._groups:
            if group.gates is not None:
                velocities = group.gates.passed(self._motion[:, None], course.start)[1]
                self._motion[1, group.columns] = velocities[0]

    def _move(self, pull: FloatArray, h: float, anticipating: bool) -> None:
        """Take a step of h shares; the attractors are `pull` before and `self._pull` after it, (d,) each."""
        course, old = self.course, self._motion
        if not self._groups:
            alone = old[:, : len(pull)]
            alone[:] = step_of(course.scheme, course.rate, h).taken(alone, pull, self._pull)
            return
        new = self._motion = old.copy()
        for group in self._groups:
            if group.gates is not None:
                both = np.stack([old, new], axis=1)
                steps, velocities = group.gates.passed(both, course.start)
                new[:, group.columns] = old[0, group.columns] + steps[0], velocities[1]
                continue
            gain, mirror = (group.gain, group.mirror) if anticipating else (1.0, 1.0)
            (shift, push), (shift_after, push_after) = group.from_sources(old), group.from_sources(new)
            new[:, group.columns] = -shift_after + step_of(course.scheme, course.rate, h, gain).taken(
                old[:, group.columns] + shift,
                mirror * pull[group.columns] + push,
                mirror * self._pull[group.columns] + push_after,
            )


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
