"""What each principle's formula says of motions, exactly."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from stimuli.dmp import Primitive
from stimuli.principles import Modulation
from stimuli.relations import found
from stimuli.rollout import integrate

seeds = st.integers(0, 10_000)


def moved(robot, demonstration, n=350, **modulation):
    """Positions and velocities under a modulation, every 10 ms."""
    course = Primitive.learn(demonstration).course(Modulation.model_validate(modulation), robot)
    return integrate(course, 0.01, n)


@pytest.fixture(scope="module")
def chain(robot):
    """The robot with the hip acting on the waist, whatever the other joints do."""
    return replace(robot, relations=found(robot)[:1])


@settings(max_examples=10)
@given(seed=seeds, p=st.floats(0, 2))
def test_secondary_action_adds_the_velocity_of_its_source(seed, p, chain, demonstrate):
    plain, velocities = moved(chain, demonstrate(seed))
    changed, _ = moved(chain, demonstrate(seed), sec=p)
    (relation,) = chain.relations
    source, target = (chain.joint_names.index(name) for name in (relation.source, relation.target))
    expected = plain.copy()
    expected[:, target] += relation.sign * p * velocities[:, source]
    assert np.abs(changed - expected).max() < 1e-12


@settings(max_examples=10)
@given(seed=seeds, p=st.floats(-3, 6))
def test_follow_through_is_linear_in_its_strength(seed, p, chain, demonstrate):
    primitive = Primitive.learn(demonstrate(seed))
    plain = primitive.course(Modulation(), chain)
    none, one, many = (
        integrate(replace(plain, dragged=plain.coupling(strength)), 0.01, 350)[0] for strength in (0, 1, p)
    )
    assert np.abs(none + p * (one - none) - many).max() < 1e-11


@settings(max_examples=20)
@given(seed=seeds, p=st.floats(0.1, 10))
def test_arc_smooths_as_it_sharpens_and_keeps_sums_constants_and_directions(seed, p, robot, demonstrate):
    plain = Primitive.learn(demonstrate(seed)).course(Modulation(), robot)

    def arced(weights, intensity):
        return Modulation.model_validate({"arc": intensity}).apply(replace(plain, weights=weights)).weights

    smooth, sharp = arced(plain.weights, p), arced(plain.weights, -p)
    scale = np.abs(plain.weights).max()
    assert np.abs(smooth + sharp - 2 * plain.weights).max() < 1e-13 * scale
    assert np.abs(smooth.sum(axis=0) - plain.weights.sum(axis=0)).max() < 1e-11 * scale
    assert np.abs(arced(plain.weights[::-1], p)[::-1] - smooth).max() < 1e-12 * scale
    assert np.abs(arced(np.full_like(plain.weights, 3.0), p) - 3).max() < 1e-12


@settings(max_examples=5)
@given(seed=seeds, p=st.floats(0.1, 3))
def test_randomization_is_the_same_for_the_same_seed_and_grows_in_proportion(seed, p, robot, demonstrate):
    plain, once, again, strong = (
        moved(robot, demonstrate(1), rand={"intensity": intensity, "seed": seed})[0]
        for intensity in (0, 1, 1, p)
    )
    other = moved(robot, demonstrate(1), rand={"intensity": 1, "seed": seed + 1})[0]
    assert np.array_equal(once, again)
    assert np.abs(other - once).max() > 1e-3
    assert np.abs(plain + p * (once - plain) - strong).max() < 1e-11


def test_randomization_moves_the_joints_named_alone_and_as_with_the_others(robot, demonstrate):
    shown = demonstrate(1)
    noise = {"intensity": 1, "seed": 3}
    parameters = ({}, {"rand": noise}, {"rand": {**noise, "joints": [shown.joints[1]]}})
    still, every, named = (moved(robot, shown, **modulation)[0] for modulation in parameters)
    assert np.array_equal(named[:, 1], every[:, 1])
    assert np.array_equal(named[:, 0], still[:, 0])
    assert not np.array_equal(every[:, 0], still[:, 0])


@pytest.mark.parametrize(
    "modulation", [{"exa": 4}, {"follow": 5}, {"ant": 0.4}, {"rand": 2}, {"arc": -8}, {"sec": 1}], ids=str
)
@settings(max_examples=3)
@given(seed=seeds)
def test_however_strong_it_ends_at_the_goal(modulation, seed, robot, demonstrate):
    course = Primitive.learn(demonstrate(seed)).course(Modulation.model_validate(modulation), robot)
    assert np.abs(integrate(course, 0.01, 900)[0][-1] - course.goal).max() < 1e-9


@settings(max_examples=10)
@given(seed=seeds, p=st.floats(0.05, 2), window=st.floats(0.02, 0.3))
def test_mirrored_anticipation_is_the_start_reflected(seed, p, window, robot, demonstrate):
    """In the window y0 - p (y - y0), y being what the joint would have done."""
    ant = {"form": "mirror", "intensity": p, "window": window, "joints": ["Hip"]}
    plain, mirrored = (moved(robot, demonstrate(seed), **m)[0][:, 0] for m in ({}, {"ant": ant}))
    steps = round(np.floor(window * 300))
    assert np.abs(mirrored[:steps] - (plain[0] - p * (plain[:steps] - plain[0]))).max() < 1e-11
