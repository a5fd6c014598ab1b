"""Carrying a course out step by step, with a goal, a duration and intensities that may change on the way."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from stimuli.course import Course
from stimuli.rollout import ROUNDING, attractor, levels
from stimuli.spring import step_of
from stimuli.trajectory import FloatArray


class Runner:
    """A motion under way. Steps give the same motion as `stimuli.rollout.integrate`.

    `change` swaps the course. State, phase and what is shown go on without a jump in position or velocity:
    the share of time gone by is kept when the duration changes, and what Secondary Action shows differently under
    the new course decays with the spring.
    """

    def __init__(self, course: Course) -> None:
        self.course = course
        self.share = 0.0  # of the duration gone by
        self._motion = np.zeros(
            (2, len(course.joints))
        )  # offsets from the start, velocities per share of the clock

    @property
    def positions(self) -> FloatArray:
        """Positions shown now, (d,)."""
        shown = self.course.start + self._motion[0]
        if self.course.carried is not None:
            shown = shown + self.course.carried @ self.velocities
        return shown

    @property
    def velocities(self) -> FloatArray:
        """Velocities of the state now, per second, (d,)."""
        return self._motion[1] / self.course.tau_s

    def step(self, dt_s: float) -> FloatArray:
        """Go on for dt_s; returns the positions shown."""
        course, rate = self.course, self.course.rate
        shares = np.array([self.share, self.share + dt_s / course.tau_s])
        pull = attractor(course, shares)  # (2, d)
        clock = (
            shares
            if course.clock is None
            else np.where(shares < 1, course.clock(np.minimum(shares, 1)), shares)
        )
        anticipating = clock[0] < course.window - ROUNDING
        gains = course.gain if anticipating else None
        if anticipating and course.mirror is not None:
            pull = pull * course.mirror
        old, new = self._motion, np.zeros_like(self._motion)
        for level in levels(course):
            chased = pull[:, level]
            shift = np.zeros((2, 2, len(level)))  # before and after the step; position and velocity
            if course.is_coupled:
                shift = np.stack([old, new]) @ course.displaced[level].T
                chased = (
                    chased + shift[:, 0] + np.stack([old[1], new[1]]) @ (2 / rate * course.dragging[level].T)
                )
            state = old[:, level] + shift[0]
            values = np.ones(len(level)) if gains is None else gains[level]
            for value in np.unique(values):
                same = np.flatnonzero(values == value)
                step = step_of(course.scheme, rate, float(clock[1] - clock[0]), float(value))
                made = step.across @ state[:, same]
                made += np.outer(step.before, chased[0, same]) + np.outer(step.after, chased[1, same])
                new[:, level[same]] = made - shift[1][:, same]
        self._motion, self.share = new, float(shares[1])
        return self.positions

    def change(self, course: Course) -> None:
        """Go on along another course."""
        self._motion[0] += self.course.start - course.start
        self._motion[1] *= course.tau_s / self.course.tau_s
        self.course = course

    def head_for(self, goal: FloatArray) -> None:
        """Go on to another goal, (d,)."""
        self.change(replace(self.course, goal=goal))


def run(course: Course, dt_s: float, n: int) -> tuple[FloatArray, FloatArray]:
    """Positions and velocities per second at 0, dt_s, …, n dt_s along a course, (n + 1, d) each, step by step."""
    runner = Runner(course)
    positions, velocities = [runner.positions], [runner.velocities]
    for _ in range(n):
        positions.append(runner.step(dt_s))
        velocities.append(runner.velocities)
    return np.stack(positions), np.stack(velocities)
