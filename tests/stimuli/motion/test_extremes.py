"""Motions that are asked too much of: by tiny or coarse steps, weak springs, clocks that all but stand."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from stimuli.dmp import Learning, Primitive
from stimuli.errors import InputError
from stimuli.feasibility import in_short, violations
from stimuli.online import Runner, run
from stimuli.principles import Modulation
from stimuli.rollout import integrate
from stimuli.spring import step_of
from stimuli.trajectory import Trajectory

seeds = st.integers(0, 10_000)


def course_of(robot, demonstration, learning=None, **modulation):
    primitive = Primitive.learn(demonstration, learning)
    return primitive.course(Modulation.model_validate(modulation), robot)


@pytest.mark.parametrize("scheme", ["foh", "zoh", "semi"])
@pytest.mark.parametrize("gain", [1.0, 0.0, -0.4])
@pytest.mark.parametrize("h", [0.0, 1e-320, 1e-30, 1e-12])
def test_the_shorter_a_step_the_less_it_moves(scheme, gain, h):
    step = step_of(scheme, 25.0, h, gain)
    assert np.abs(step.across - np.eye(2)).max() <= 1e3 * h
    assert np.abs([step.before, step.after]).max() <= 1e3 * h


@settings(max_examples=50)
@given(
    exponent=st.floats(-12, 0),
    share=st.floats(0.01, 0.99),
    rate=st.floats(0.5, 500),
    gain=st.sampled_from([1.0, 0.5, 0.0, -0.4]),
    u=st.tuples(st.floats(-2, 2), st.floats(-2, 2)),
)
def test_two_short_steps_are_one_long_step(exponent, share, rate, gain, u):
    h = 10**exponent / rate
    state, (u_0, u_1) = np.array([[0.3], [0.7 * rate]]), (np.array([one]) for one in u)
    between = (1 - share) * u_0 + share * u_1
    halfway = step_of("foh", rate, share * h, gain).taken(state, u_0, between)
    twice = step_of("foh", rate, (1 - share) * h, gain).taken(halfway, between, u_1)
    once = step_of("foh", rate, h, gain).taken(state, u_0, u_1)
    moved = np.abs(once - state) * [[1], [1 / rate]]
    assert np.abs((twice - once) / [[1], [rate]]).max() < 1e-10 * moved.max() + 1e-14


@pytest.mark.parametrize("steepness", [20, 60, 100])
def test_a_clock_may_stand_still(steepness, robot, demonstrate):
    """A motion by a bent clock goes the way of the plain one, in however little of the time."""
    shown = demonstrate(1)
    slow = {"intensity": 1, "steepness": steepness, "form": "retime"}
    course = course_of(robot, shown, slow=slow)
    positions = integrate(course, 0.0025, 1200)[0]
    at = course.clock.gone(np.linspace(0, 1, 1201)) * course.tau_s
    plain = Trajectory(
        np.arange(3001) * 0.001, integrate(course_of(robot, shown), 0.001, 3000)[0], shown.joints
    )
    assert np.abs(positions - plain.at(np.minimum(at, 3.0))).max() < 5e-3


@pytest.mark.parametrize("broken", [np.nan, np.inf, -np.inf])
def test_a_motion_that_leaves_the_numbers_is_not_feasible(broken, robot, demonstrate):
    shown = demonstrate(0)
    positions = shown.positions.copy()
    positions[40:, 2] = broken
    found = violations(replace(shown, positions=positions), robot)
    assert [one.joint for one in found if not np.isfinite(one.value)] == ["Shoulder"]
    assert in_short(found).startswith(f"Shoulder at 0.40 s: position {broken:.4g} rad")


@settings(max_examples=40)
@given(seed=seeds, intensity=st.floats(0.05, 1.0), steps=st.floats(1.2, 60))
def test_anticipation_stays_bounded_in_coarse_steps_or_refuses_them(
    seed, intensity, steps, robot, demonstrate
):
    shown = demonstrate(seed)
    plain, turned = course_of(robot, shown), course_of(robot, shown, ant={"intensity": intensity})
    deepest = max(
        np.abs(integrate(turned, 3 / 2000, 2000)[0] - integrate(plain, 3 / 2000, 2000)[0]).max(), 0.2
    )
    dt_s = 3 / steps
    try:
        closed = integrate(turned, dt_s, 60)[0]
    except InputError as err:
        with pytest.raises(InputError, match="needs finer steps"):
            run(turned, dt_s, 60)
        finest = float(str(err).split("at most ")[1].split(" s")[0])
        integrate(turned, 0.99 * finest, 60)
        return
    assert np.abs(closed - run(turned, dt_s, 60)[0]).max() < 1e-11
    assert np.abs(closed - integrate(plain, dt_s, 60)[0]).max() < 4 * deepest


@pytest.mark.parametrize(
    "modulation", [{"exa": 3}, {"goal": {"Hip": 1.5}}, {"goal": {"Hip": 1.5, "lag_s": 60}}], ids=str
)
def test_a_motion_that_never_rests_is_refused(modulation, robot, demonstrate):
    weak = Primitive.learn(demonstrate(2), Learning(alpha=0.5))
    with pytest.raises(InputError, match=r"does not come to rest within 10 durations: .* larger alpha"):
        weak.rollout(Modulation.model_validate(modulation), robot)


def test_a_motion_that_stands_still_rests(robot, demonstrate):
    shown = demonstrate(0)
    still = replace(shown, positions=np.full_like(shown.positions, 0.1 + 0.2))
    rolled_out = Primitive.learn(still).rollout(Modulation(), robot)
    assert rolled_out.duration_s == pytest.approx(shown.duration_s)


def test_a_refused_step_leaves_the_motion_where_it_was(robot, demonstrate):
    runner = Runner(course_of(robot, demonstrate(1), ant={"intensity": 0.5}))
    runner.step(0.05)
    share, positions = runner.share, runner.positions
    with pytest.raises(InputError, match="needs finer steps"):
        runner.step(2.5)
    assert runner.share == share
    assert np.array_equal(runner.positions, positions)
