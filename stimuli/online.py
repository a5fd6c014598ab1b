"""Carrying a course out step by step, with a goal, a duration and intensities that may change on the way."""

from __future__ import annotations

import math
from collections.abc import Mapping
from copy import copy

import numpy as np

from stimuli.attractor import ROUNDING, attractor_at, clock, heading_for, pace
from stimuli.course import Course
from stimuli.errors import InputError
from stimuli.groups import groups
from stimuli.spring import step_of
from stimuli.trajectory import FloatArray

_MOMENT = 1e-7  # of the duration, over which accelerations are looked at


class Runner:
    """A motion under way. Its steps are those of `stimuli.rollout.integrate`.

    Changes come without a jump in position or velocity. The state is kept, as far as the new course can carry
    it; where this shows elsewhere or at another speed than the former course did, the difference is added to
    what is shown and fades as the springs do.
    """

    def __init__(self, course: Course) -> None:
        """At the course's start and at rest."""
        d = len(course.joints)
        self.share = 0.0  # of the duration gone by
        # Offsets from the start of all joints and what passed the gates; velocities per share of the clock.
        self._motion = np.zeros((2, d + len(course.gated)))
        self._fading = np.zeros((2, d))  # what is shown besides, and its velocity per share of the duration
        self._fades = False
        self._pull = np.zeros(d)  # attractors now
        self._set_out(course)

    @property
    def positions(self) -> FloatArray:
        """Positions shown now, (d,)."""
        shown: FloatArray = self.course.start + self._motion[0, : len(self.course.joints)]
        if self.course.carried is not None:
            shown += self.course.carried @ self._velocities
        if self._fades:
            shown += self._fading[0]
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
        if not (math.isfinite(dt_s) and dt_s >= 0):
            raise InputError(f"dt_s: a step takes a time of at least 0 s, not {dt_s:g}")
        if goal:
            self.head_for(goal)
        self._go_on(dt_s / self.course.tau_s)
        return self.positions

    def change(self, course: Course, *, afresh: bool = False) -> None:
        """Go on along another course of the same joints, at the same share of its time or, afresh, at 0."""
        former, before = self.course, self._shown()
        if course.joints != former.joints:
            raise InputError(
                f"A motion of {', '.join(former.joints)} cannot go on as one of {', '.join(course.joints)}"
            )
        slower, paced = course.tau_s / former.tau_s, pace(former, self.share)
        self.share = 0.0 if afresh else self.share
        self._motion[0, : len(course.joints)] += former.start - course.start
        self._motion[1] *= slower * _kept(paced, pace(course, self.share))
        self._fading[1] *= slower
        self._set_out(course)
        missing = before - self._shown()
        self._fading += missing * [[1.0], [course.tau_s]]
        self._fades = bool(self._fading.any())

    def head_for(self, goal: Mapping[str, float]) -> None:
        """Go on to other goals of the joints named, gliding there if the course's goals do."""
        course = self.course
        wanted = {course.column(joint, "goal"): float(position) for joint, position in goal.items()}
        for joint, position in goal.items():
            if not math.isfinite(position):
                raise InputError(f"goal.{joint}: {position:g} is not a position")
        there = all(course.goal[column] == position for column, position in wanted.items())
        if not there or course.until_then is not None:
            self.change(heading_for(course, wanted, self.share))

    def _set_out(self, course: Course) -> None:
        self.course = course
        self._pull = attractor_at(course, self.share)
        gated = course.carried is not None or course.is_coupled
        self._groups = [] if course.is_plain else groups(course, gated=gated)
        for group in self._groups:
            if group.gates is not None:
                velocities = group.gates.passed(self._motion[:, None], course.start)[1]
                self._motion[1, group.columns] = velocities[0]

    def _shown(self) -> FloatArray:
        """Positions shown now and their velocities per second, (2, d)."""
        velocities = self.velocities + self._fading[1] / self.course.tau_s
        if self.course.carried is not None:
            soon = copy(self)
            soon._go_on(_MOMENT)
            faster = soon._velocities - self._velocities
            velocities += self.course.carried @ faster / (_MOMENT * self.course.tau_s)
        return np.stack([self.positions, velocities])

    def _go_on(self, h: float) -> None:
        """Take a step of h shares of the duration; a step that is refused changes nothing."""
        course, now, share, gone = self.course, self.share, self.share + h, h
        if course.clock is not None:
            now, then = clock(course, np.array([now, share])).tolist()
            gone = then - now
        if now < course.window - ROUNDING:
            for group in self._groups:
                group.refuse_overrun(course, now + gone)
        if self._fades:
            self._fading = step_of("zoh", course.rate, h).across @ self._fading
        pull, self._pull, self.share = self._pull, attractor_at(course, share), share
        self._move(pull, now, gone)

    def _move(self, pull: FloatArray, now: float, h: float) -> None:
        """Go from `now` on for h shares of the clock, the attractors going from `pull` to `self._pull`."""
        course, old = self.course, self._motion
        if not self._groups:
            alone = old[:, : len(pull)]
            alone[:] = step_of(course.scheme, course.rate, h).taken(alone, pull, self._pull)
            return
        new, anticipating = old.copy(), now < course.window - ROUNDING
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
        self._motion = new


def _kept(before: float, after: float) -> float:
    """The factor on velocities per share of a clock that keeps those in time when its pace changes.

    Bounded, as a clock may all but stand still: it raises no velocity above what it was, in either measure.
    """
    most = max(1.0, before)
    return most if before >= most * after else before / after


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
    if not dt_s > 0:
        raise InputError(f"dt_s: a sequence needs steps of more than 0 s, not {dt_s:g}")
    runner = Runner(courses[0])
    positions = [runner.positions]
    for following in [*courses[1:], None]:
        until = 1.0 if following is None else handover
        while runner.share < until - ROUNDING:
            positions.append(runner.step(dt_s))
        if following is not None:
            runner.change(following, afresh=True)
    return np.stack(positions)
