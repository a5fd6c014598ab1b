"""Many variants at once are the same motions as one by one."""

from __future__ import annotations

import numpy as np
import pytest

from stimuli.dmp import Learning, Primitive
from stimuli.online import run
from stimuli.principles import PRINCIPLES, Modulation
from stimuli.rollout import integrate, sampled
from stimuli.superposition import answers
from stimuli.variants import integrate_all


@pytest.mark.parametrize("scheme", ["foh", "zoh", "semi"])
def test_variants_together_are_the_motions_one_by_one_and_step_by_step(scheme, robot, demonstrate):
    primitive = Primitive.learn(demonstrate(1), Learning(scheme=scheme))
    modulations = [Modulation()] + [Modulation().with_(kind.example(robot)) for kind in PRINCIPLES.values()]
    courses = [primitive.course(modulation, robot) for modulation in modulations]
    together = integrate_all(courses, 0.02, 200)
    for course, positions in zip(courses, together, strict=True):
        for single in (integrate(course, 0.02, 200)[0], run(course, 0.02, 200)[0]):
            assert np.abs(single - positions).max() < 1e-11
    assert [course.is_plain and course.is_linear for course in courses].count(True) >= 5


def test_the_spread_of_randomization_is_the_one_its_formula_says(robot, demonstrate):
    """Standard deviation over seeds: (1 + mean |w|) p |R|, R the spring's answers to the weights."""
    primitive = Primitive.learn(demonstrate(1))
    seeds = [Modulation.model_validate({"rand": {"intensity": 0.2, "seed": seed}}) for seed in range(2000)]
    drawn = integrate_all([primitive.course(m, robot) for m in seeds], 0.1, 30)
    scale = 1 + np.abs(primitive.weights).mean(axis=0)
    plain = primitive.course(Modulation(), robot)
    to_weights = answers(plain, sampled(30, 0.1 / plain.tau_s))[0, :, :-1]
    expected = 0.2 * scale * np.linalg.norm(to_weights, axis=1)[:, None]
    assert drawn.std(axis=0)[5:] == pytest.approx(expected[5:], rel=0.06)
    assert drawn.mean(axis=0)[5:] == pytest.approx(
        integrate(plain, 0.1, 30)[0][5:],
        abs=4 * expected.max() / np.sqrt(2000),
    )
