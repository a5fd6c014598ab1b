"""Many variants of one motion in one call.

Variants that share phase, duration and weights are sums of the same two motions, p F + S (g - y_0): F is the
way of the forcing term and S is the way to the goal (`stimuli.superposition`). All others go singly.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from stimuli.course import Course
from stimuli.rollout import integrate, sampled
from stimuli.superposition import answers
from stimuli.trajectory import FloatArray


def integrate_all(courses: Sequence[Course], dt_s: float, n: int) -> FloatArray:
    """Positions at 0, dt_s, …, n dt_s along each course, (number of courses, n + 1, d)."""
    positions = np.empty((len(courses), n + 1, len(courses[0].joints)))
    alike: dict[tuple[object, ...], list[int]] = {}
    for at, course in enumerate(courses):
        if course.is_plain and course.is_linear:
            shared = (course.tau_s, course.progress, course.alpha, course.scheme, id(course.weights))
            alike.setdefault(shared, []).append(at)
        else:
            positions[at] = integrate(course, dt_s, n)[0]
    for members in alike.values():
        _superpose([courses[at] for at in members], members, positions, dt_s)
    return positions


def _superpose(courses: list[Course], members: list[int], positions: FloatArray, dt_s: float) -> None:
    """Fill in the positions of courses that share phase, duration and weights."""
    first = courses[0]
    to_causes = answers(first, sampled(positions.shape[1] - 1, dt_s / first.tau_s))[0]
    forced, to_goal = to_causes[:, :-1] @ first.weights, to_causes[:, -1:]
    for course, at in zip(courses, members, strict=True):
        np.multiply(forced, course.exaggeration, out=positions[at])
        positions[at] += to_goal * (course.goal - course.start) + course.start
