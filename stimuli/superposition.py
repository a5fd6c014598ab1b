"""A motion as a sum of answers: what the spring makes of each weight, and of a step to the goal.

A primitive is linear in its weights and its goal, y = y_0 + R (p w) + S (g - y_0): R are the answers to the
basis functions and S is the one to a step, the same for all joints and all variants that share phase and
duration. So motions under Arc, Randomization, Exaggeration, Goal, Slow and Timing by phase are one matrix
product; they are also what learning inverts.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from stimuli.attractor import basis, phase
from stimuli.course import Course, Scheme
from stimuli.spring import respond, step_of
from stimuli.trajectory import FloatArray


def superposed(course: Course, shares: FloatArray) -> FloatArray:
    """Motion (2, n + 1, d), offsets from the start and velocities, of joints that nothing else acts on.

    Of a course that is linear and, at these shares of time, in even time.
    """
    to_causes = answers(course, shares)
    motion: FloatArray = to_causes.reshape(-1, to_causes.shape[-1]) @ course.causes
    return motion.reshape(2, len(shares), -1)


def answers(course: Course, shares: FloatArray) -> FloatArray:
    """Answers of the spring to each weight and, last, to a step: (2, n + 1, n_weights + 1)."""
    return answers_in(phase(course, shares), len(course.weights), course.scheme, course.rate, shares[1])


def answers_in(x: FloatArray, n_weights: int, scheme: Scheme, rate: float, h: float) -> FloatArray:
    """The same in phases x, h shares of time apart."""
    return _answers(x.tobytes(), n_weights, scheme, rate, h)


@lru_cache(maxsize=16)
def _answers(x_bytes: bytes, n_weights: int, scheme: Scheme, rate: float, h: float) -> FloatArray:
    """Kept, as most rollouts of a study share their phases."""
    x = np.frombuffer(x_bytes)
    attractors = np.column_stack([basis(x, n_weights) / rate**2, np.ones(len(x))])
    made = respond(attractors, np.zeros((2, n_weights + 1)), step_of(scheme, rate, h))
    made.flags.writeable = False
    return made
