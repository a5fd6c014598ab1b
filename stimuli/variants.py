"""Many variants of one motion in one call.

A motion is linear in its goal and its weights, y = y_0 + (g - y_0) S + R (p w): S is the spring's answer to a
step and R are its answers to the basis functions, the same for all joints and all variants that share phase
and duration. So variants by Arc, Randomization, Exaggeration and Goal are a matrix product; others go singly.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from stimuli.attractor import basis, phase
from stimuli.course import Course
from stimuli.rollout import integrate, sampled
from stimuli.spring import respond, step_of
from stimuli.trajectory import FloatArray


def integrate_all(courses: Sequence[Course], dt_s: float, n: int) -> FloatArray:
    """Positions at 0, dt_s, …, n dt_s along each course, (number of courses, n + 1, d)."""
    positions = np.empty((len(courses), n + 1, len(courses[0].joints)))
    alike: dict[tuple[object, ...], list[int]] = {}
    for at, course in enumerate(courses):
        if is_superposition(course):
            shared = (course.tau_s, course.progress, course.alpha, course.scheme, course.weights.shape)
            alike.setdefault(shared, []).append(at)
        else:
            positions[at] = integrate(course, dt_s, n)[0]
    for members in alike.values():
        _superpose([courses[at] for at in members], members, positions, dt_s)
    return positions


def is_superposition(course: Course) -> bool:
    """Whether a course differs from its plain one in weights, forcing and goals alone."""
    return (
        course.clock is None
        and course.window == 0
        and course.carried is None
        and not course.is_coupled
        and course.goal_lag_s == 0
        and course.until_then is None
        and (course.around == "goal" or course.exaggeration == 1)
    )


def _superpose(courses: list[Course], members: list[int], positions: FloatArray, dt_s: float) -> None:
    """Fill in the positions of courses that share phase and duration."""
    answers = responses(courses[0], dt_s, positions.shape[1] - 1)
    for course, at in zip(courses, members, strict=True):
        causes = np.concatenate([course.exaggeration * course.weights, (course.goal - course.start)[None]])
        np.matmul(answers, causes, out=positions[at])
        positions[at] += course.start


def responses(course: Course, dt_s: float, n: int) -> FloatArray:
    """Answers of the spring to each basis function and, last, to a step: (n + 1, n_weights + 1)."""
    h = dt_s / course.tau_s
    forcing = basis(phase(course, sampled(n, h)), len(course.weights)) / course.rate**2
    attractors = np.column_stack([forcing, np.ones(n + 1)])
    rest = np.zeros((2, attractors.shape[1]))
    answers: FloatArray = respond(attractors, rest, step_of(course.scheme, course.rate, h))[0]
    return answers
