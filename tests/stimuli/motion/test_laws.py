"""Laws that every principle in the folder obeys, alone and with every other."""

from __future__ import annotations

from dataclasses import replace
from itertools import combinations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from stimuli.dmp import Learning, Primitive
from stimuli.online import run
from stimuli.principles import PRINCIPLES, Modulation
from stimuli.relations import found
from stimuli.rollout import integrate
from stimuli.trajectory import Trajectory

SCHEMES = ("foh", "zoh", "semi")
KINDS = sorted(PRINCIPLES)
PAIRS = list(combinations(KINDS, 2))

seeds = st.integers(0, 10_000)


def together(robot, *kinds: str) -> Modulation:
    return Modulation.model_validate({kind: PRINCIPLES[kind].example(robot).model_dump() for kind in kinds})


def forms() -> list[tuple[str, str, str]]:
    """Each choice that a principle leaves: kind, field, value."""
    chosen = []
    for kind, made in PRINCIPLES.items():
        for name, field in made.model_fields.items():
            values = getattr(field.annotation, "__args__", ())
            chosen += [(kind, name, value) for value in values if isinstance(value, str)]
    return chosen


@settings(max_examples=5)
@given(seed=seeds)
def test_all_neutral_principles_together_change_nothing_bit_for_bit(seed, robot, demonstrate):
    primitive = Primitive.learn(demonstrate(seed))
    neutral = Modulation.model_validate({kind: PRINCIPLES[kind].neutral for kind in KINDS})
    plain, same = (integrate(primitive.course(m, robot), 0.01, 400)[0] for m in (Modulation(), neutral))
    assert np.array_equal(plain, same)


@pytest.mark.parametrize("kind", KINDS)
def test_each_principle_does_something(kind, robot, demonstrate):
    primitive = Primitive.learn(demonstrate())
    plain, changed = (
        integrate(primitive.course(m, robot), 0.01, 400)[0] for m in (Modulation(), together(robot, kind))
    )
    assert np.abs(plain - changed).max() > 0.01


@pytest.mark.parametrize("scheme", SCHEMES)
@pytest.mark.parametrize("kind", KINDS)
@settings(max_examples=5)
@given(seed=seeds, share=st.floats(0.1, 1.0))
def test_steps_give_the_closed_form(kind, scheme, robot, demonstrate, seed, share):
    primitive = Primitive.learn(demonstrate(seed), Learning(scheme=scheme))
    example = PRINCIPLES[kind].example(robot)
    intensity = example.neutral + share * (example.intensity - example.neutral)
    modulation = Modulation().with_(example.model_copy(update={"intensity": intensity}))
    course = primitive.course(modulation, robot)
    for closed, stepped in zip(integrate(course, 0.025, 150), run(course, 0.025, 150), strict=True):
        assert np.abs(closed - stepped).max() < 1e-11


@pytest.mark.parametrize(("kind", "field", "value"), forms())
def test_every_form_of_a_principle_runs_and_comes_to_rest(kind, field, value, robot, demonstrate):
    primitive = Primitive.learn(demonstrate())
    example = PRINCIPLES[kind].example(robot).model_copy(update={field: value})
    if value == "duration":  # sigma as a share of the duration
        example = example.model_copy(update={"intensity": 0.1})
    course = primitive.course(Modulation().with_(example), robot)
    closed, stepped = integrate(course, 0.03, 400)[0], run(course, 0.03, 100)[0]
    assert np.abs(closed[:101] - stepped).max() < 1e-11
    assert np.abs(closed[-1] - course.goal).max() < 1e-9


@pytest.mark.parametrize(("one", "other"), PAIRS)
@settings(max_examples=2)
@given(seed=seeds)
def test_any_two_principles_work_together(one, other, seed, robot, demonstrate):
    primitive = Primitive.learn(demonstrate(seed))
    course = primitive.course(together(robot, one, other), robot)
    closed, stepped = integrate(course, 0.03, 400)[0], run(course, 0.03, 100)[0]
    assert np.abs(closed[:101] - stepped).max() < 1e-11
    assert np.abs(closed[-1] - course.goal).max() < 1e-9


def test_all_nine_together_come_to_rest_at_the_goal_by_steps_too(robot, demonstrate):
    primitive = Primitive.learn(demonstrate(3))
    modulation = together(robot, *KINDS)
    trajectory = primitive.rollout(modulation, robot)
    course = primitive.course(modulation, robot)
    goal, size = course.goal, np.ptp(trajectory.positions, axis=0).max()
    assert np.abs(trajectory.positions[-1] - goal).max() < 2e-3 * size
    assert np.abs(integrate(course, 0.02, 150)[0] - run(course, 0.02, 150)[0]).max() < 1e-11
    assert trajectory.duration_s >= 0.75 * primitive.tau_s - 1e-9


@pytest.mark.parametrize("kind", KINDS)
@settings(max_examples=5)
@given(seed=seeds)
def test_a_motion_ends_at_rest_at_its_goal(kind, robot, demonstrate, seed):
    primitive = Primitive.learn(demonstrate(seed))
    modulation = together(robot, kind)
    trajectory = primitive.rollout(modulation, robot)
    size = np.ptp(trajectory.positions, axis=0).max()
    goal = primitive.course(modulation, robot).goal
    speed = np.abs(np.diff(trajectory.positions, axis=0)[-1]).max() / 0.01
    assert np.abs(trajectory.positions[-1] - goal).max() < 2e-3 * size
    assert speed * primitive.tau_s < 0.05 * size


@pytest.mark.parametrize("kind", KINDS)
def test_the_order_of_joints_does_not_matter(kind, robot, demonstrate):
    demonstration = demonstrate(5)
    order = [3, 0, 4, 2, 1]
    shuffled = Trajectory(
        demonstration.times, demonstration.positions[:, order], tuple(demonstration.joints[i] for i in order)
    )
    one, other = (
        Primitive.learn(shown).rollout(together(robot, kind), robot) for shown in (demonstration, shuffled)
    )
    assert np.abs(one.positions[:, order] - other.positions).max() < 1e-11


@pytest.mark.parametrize("kind", sorted({"arc", "exa", "follow", "sec", "ant", "slow", "time"} & set(KINDS)))
@settings(max_examples=5)
@given(seed=seeds, scale=st.floats(0.2, 2.0), shift=st.floats(-1, 1))
def test_a_shifted_and_scaled_demonstration_gives_a_shifted_and_scaled_motion(
    kind, robot, demonstrate, seed, scale, shift
):
    shown = demonstrate(seed)
    other = Trajectory(shown.times, -scale * shown.positions + shift, shown.joints)
    always = replace(robot, relations=tuple(replace(relation, while_=()) for relation in found(robot)[:1]))
    plain, changed = (
        integrate(Primitive.learn(given).course(together(always, kind), always), 0.01, 350)[0]
        for given in (shown, other)
    )
    assert np.abs(-scale * plain + shift - changed).max() < 1e-9


@settings(max_examples=10)
@given(p=st.floats(0.3, 3), seed=seeds)
def test_a_scaled_duration_with_a_scaled_step_gives_the_same_samples(p, seed, robot, demonstrate):
    primitive = Primitive.learn(demonstrate(seed))
    others = {
        kind: PRINCIPLES[kind].example(robot).model_dump() for kind in KINDS if kind not in ("time", "sec")
    }
    plain = primitive.course(Modulation.model_validate(others), robot)
    scaled = primitive.course(Modulation.model_validate({**others, "time": p}), robot)
    one, other = integrate(plain, 0.01, 350)[0], integrate(scaled, p * 0.01, 350)[0]
    assert np.abs(one - other).max() < 1e-11


@pytest.mark.parametrize("kind", ["exa", "sec", "rand", "goal"])
@settings(max_examples=5)
@given(seed=seeds, share=st.floats(-2, 4))
def test_motion_is_affine_in_the_intensity(kind, seed, share, robot, demonstrate):
    primitive = Primitive.learn(demonstrate(seed))
    strong = PRINCIPLES[kind].example(robot)
    low, high = strong.neutral, strong.intensity
    at = [
        integrate(
            primitive.course(Modulation().with_(strong.model_copy(update={"intensity": p})), robot), 0.01, 350
        )[0]
        for p in (low, high, low + share * (high - low))
    ]
    assert np.abs(at[0] + share * (at[1] - at[0]) - at[2]).max() < 1e-11


@pytest.mark.parametrize("kind", KINDS)
def test_a_modulation_reads_back_from_json(kind, robot):
    modulation = together(robot, kind)
    assert Modulation.model_validate_json(modulation.model_dump_json()) == modulation
    assert Modulation.model_validate(modulation.model_dump(mode="json")) == modulation


def test_principles_act_in_the_order_of_their_stages_whatever_the_order_they_are_written_in(robot):
    forwards, backwards = together(robot, *KINDS), together(robot, *reversed(KINDS))
    assert forwards == backwards
    assert [principle.kind for principle in forwards.principles] == list(PRINCIPLES)
    assert list(PRINCIPLES).index("arc") < list(PRINCIPLES).index("rand")


@pytest.mark.parametrize("kind", ["ant", "follow", "sec"])
@settings(max_examples=5)
@given(seed=seeds)
def test_joints_that_a_principle_does_not_concern_stay_bit_equal(kind, seed, robot, demonstrate):
    primitive = Primitive.learn(demonstrate(seed))
    course = primitive.course(together(robot, kind), robot)
    plain = primitive.course(Modulation(), robot)
    if kind == "ant":
        concerned = {int(np.argmin(course.gain))}
    else:
        concerned = {course.joints.index(relation.target) for relation in course.relations}
    assert 0 < len(concerned) < len(course.joints)
    others = [column for column in range(len(course.joints)) if column not in concerned]
    one, other = integrate(plain, 0.01, 300)[0], integrate(course, 0.01, 300)[0]
    assert np.array_equal(one[:, others], other[:, others])
    assert not np.array_equal(one, other)


def test_a_gain_of_one_in_the_window_is_no_anticipation(robot, demonstrate):
    plain = Primitive.learn(demonstrate()).course(Modulation(), robot)
    idle = replace(plain, window=0.2, gain=np.ones(len(plain.joints)))
    assert np.abs(integrate(plain, 0.01, 300)[0] - integrate(idle, 0.01, 300)[0]).max() < 1e-13
