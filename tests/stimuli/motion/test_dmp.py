"""The primitive against what is known of it exactly."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_ivp
from scipy.signal import lfilter

from stimuli.attractor import attractor
from stimuli.course import Course
from stimuli.dmp import Learning, Primitive
from stimuli.ends import eased, rests_at_ends
from stimuli.errors import InputError
from stimuli.gates import Gates
from stimuli.principles import Modulation
from stimuli.rollout import integrate
from stimuli.spring import decay, step_of
from stimuli.trajectory import Trajectory


def course_of(robot, demonstration, modulation=None, **learning) -> Course:
    primitive = Primitive.learn(demonstration, Learning(**learning))
    return primitive.course(Modulation.model_validate(modulation or {}), robot)


@settings(max_examples=10)
@given(seed=st.integers(0, 10_000), scheme=st.sampled_from(["foh", "zoh", "semi"]))
def test_a_primitive_reproduces_its_demonstration(seed, scheme, robot, demonstrate):
    shown = demonstrate(seed)
    again = integrate(course_of(robot, shown, scheme=scheme), 0.01, 300)[0]
    assert np.sqrt(np.mean((again - shown.positions) ** 2)) < 2e-4 * np.ptp(shown.positions, axis=0).max()


@pytest.mark.parametrize("scheme", ["foh", "semi"])
def test_locally_weighted_regression_reproduces_it_too_but_far_less_closely(scheme, robot, demonstrate):
    shown = demonstrate(2)
    errors = [
        np.sqrt(
            np.mean(
                (integrate(course_of(robot, shown, scheme=scheme, method=m), 0.01, 300)[0] - shown.positions)
                ** 2
            )
        )
        for m in ("ridge", "lwr")
    ]
    assert 20 * errors[0] < errors[1] < 0.03 * np.ptp(shown.positions, axis=0).max()


def test_noise_is_smoothed_not_learned(robot, demonstrate):
    shown = demonstrate(4)
    noise = np.random.default_rng(0).normal(0, 0.01, shown.positions.shape)
    noise[[0, 1, -2, -1]] = 0
    noisy = replace(shown, positions=shown.positions + noise)
    again = integrate(course_of(robot, noisy, regularisation=1e-6), 0.01, 300)[0]
    assert np.sqrt(np.mean((again - shown.positions) ** 2)) < 0.5 * 0.01


def test_joints_that_stand_still_stay_still_exactly(robot, demonstrate):
    shown = demonstrate(4)
    positions = shown.positions.copy()
    positions[:, 2] = 0.123
    again = integrate(course_of(robot, replace(shown, positions=positions)), 0.01, 400)[0]
    assert np.all(again[:, 2] == 0.123)


def test_one_sample_is_no_demonstration(robot):
    with pytest.raises(InputError, match="at least two samples"):
        Primitive.learn(Trajectory(np.zeros(1), np.zeros((1, 5)), robot.joint_names))


@pytest.mark.parametrize("scheme", ["foh", "zoh"])
@pytest.mark.parametrize("alpha", [10.0, 25.0, 50.0, 100.0])
def test_without_forcing_term_it_is_the_analytic_spring(alpha, scheme, robot, demonstrate):
    course = course_of(robot, demonstrate(), {"exa": 0}, alpha=alpha, scheme=scheme)
    s = np.arange(301)[:, None] / 300
    rate = alpha / 2
    analytic = course.goal + (course.start - course.goal) * (1 + rate * s) * np.exp(-rate * s)
    assert np.abs(integrate(course, 0.01, 300)[0] - analytic).max() < 1e-12


@pytest.mark.parametrize("alpha", [25.0, 50.0, 100.0])
def test_a_forcing_term_that_ends_as_c_x_leaves_16_c_over_alpha_cubed(alpha, robot, demonstrate):
    course = course_of(robot, demonstrate(), alpha=alpha)
    c = 3.0
    even = replace(course, goal=course.start, weights=np.full_like(course.weights, c))
    end = integrate(even, 0.003, 1000)[0][-1] - course.start
    assert end == pytest.approx(16 * c / alpha**3, rel=0.01)


@settings(max_examples=20)
@given(gain=st.floats(-2, 3), h=st.floats(1e-4, 0.5), rate=st.floats(1, 50))
def test_a_spring_decays_as_the_exponential_of_its_matrix(gain, h, rate):
    from scipy.linalg import expm

    exact = expm(h * np.array([[0, 1], [-gain * rate**2, -2 * gain * rate]]))
    assert decay(rate, h, gain) == pytest.approx(exact, rel=1e-8, abs=1e-8 * np.abs(exact).max())


@pytest.mark.parametrize("gain", [1.0, -0.4, 0.0, 0.5])
def test_a_first_order_hold_step_is_exact_for_a_ramp(gain):
    rate, h = 25.0, 0.02
    step = step_of("foh", rate, h, gain)
    state, before, after = np.array([0.3, -1.0]), 0.2, 0.7

    def spring(t, x):
        u = before + (after - before) * t / h
        return [x[1], gain * (rate**2 * (u - x[0]) - 2 * rate * x[1])]

    exact = solve_ivp(spring, (0, h), state, rtol=1e-12, atol=1e-13).y[:, -1]
    assert step.across @ state + step.before * before + step.after * after == pytest.approx(exact, abs=1e-10)


def test_semi_implicit_euler_is_refused_where_it_is_unstable_and_the_exact_step_is_not(robot, demonstrate):
    with pytest.raises(InputError, match=r"scheme semi: unstable .* at least 3. steps"):
        course_of(robot, demonstrate(duration_s=0.25), scheme="semi")
    coarse = integrate(course_of(robot, demonstrate(duration_s=0.25)), 0.05, 60)[0]
    assert np.all(np.isfinite(coarse))
    assert np.abs(coarse[-1] - demonstrate(duration_s=0.25).positions[-1]).max() < 1e-6


@pytest.mark.parametrize(
    "modulation",
    [
        {"follow": 3},
        {"sec": {"intensity": 0.05, "form": "state"}},
        {"follow": 2, "sec": {"intensity": 0.03, "form": "state"}},
        {"follow": 3, "ant": {"intensity": 0.3, "count": 5}},
    ],
    ids=str,
)
def test_coupled_springs_obey_their_differential_equations(modulation, robot, demonstrate):
    """Against an adaptive Runge–Kutta solution of the coupled equations as the paper prints them."""
    course = course_of(robot, demonstrate(6), modulation)
    d = len(course.joints)
    gates = Gates.of(list(course.gated), course.joints)
    induced = course.coupling(0) if course.induced is None else course.induced

    def flow(s, x):
        y, momentum = x[:d], x[d:]
        # What comes through is q' = through y'. Then y' = v + induced q' and (v + dragged q')' = pull.
        opening = gates.opening(course.start + y)
        through = np.concatenate([np.eye(d), opening[:, None] * np.eye(d)[gates.sources]])
        velocity = np.linalg.solve(np.eye(d) + (course.dragging - induced) @ through, momentum)
        v = velocity - induced @ through @ velocity
        gain = course.gain if course.gain is not None and s < course.window else np.ones(d)
        pull = gain * (course.rate**2 * (attractor(course, np.array([s]))[0] - y) - 2 * course.rate * v)
        return np.concatenate([velocity, pull])

    border = course.window or 0.5
    x, ends = np.zeros(2 * d), []
    for begin, end in ((0, border), (border, 1.0)):
        part = solve_ivp(flow, (begin, end), x, rtol=1e-9, atol=1e-11, max_step=0.005)
        x = part.y[:, -1]
        ends.append(x[:d] + course.start)
    n = 4000
    fine = integrate(course, course.tau_s / n, n)[0]
    assert np.abs(fine[-1] - ends[1]).max() < 2e-5
    assert np.abs(fine[round(border * n)] - ends[0]).max() < 2e-5


def test_follow_through_is_a_filtered_second_difference_of_the_source(robot, demonstrate):
    """Semi-implicit Euler: -delta p (1 - z^-1)^2 / A(z) of the source, A the spring's own polynomial."""
    shown = demonstrate(8)
    plain, changed = (course_of(robot, shown, m, scheme="semi") for m in ({}, {"follow": 3}))
    one, other = (integrate(course, 0.01, 300)[0] for course in (plain, changed))
    p = 2 * plain.rate * 0.01 / plain.tau_s
    relation = changed.relations[0]  # its source has no source itself
    source, target = (plain.joints.index(name) for name in (relation.source, relation.target))
    moved = one[:, source] - one[0, source]
    expected = -relation.sign * 3 * lfilter([1, -2, 1], [1, -(2 - p - p * p / 4), 1 - p], moved)
    assert np.abs(other[:, target] - one[:, target] - expected).max() < 1e-12


def test_the_answer_to_a_moved_goal_is_the_same_monotone_step_whatever_was_learned(robot, demonstrate):
    answers = []
    for seed in (1, 2):
        plain = course_of(robot, demonstrate(seed))
        moved = replace(plain, goal=plain.goal + 0.5)
        answers.append((integrate(moved, 0.01, 300)[0] - integrate(plain, 0.01, 300)[0]) / 0.5)
    assert np.abs(answers[0] - answers[1]).max() < 1e-11
    assert np.all(np.diff(answers[0], axis=0) >= -1e-12)
    assert answers[0].max() <= 1 + 1e-12


def test_the_exact_step_hardly_depends_on_the_step_size(robot, demonstrate):
    primitive = Primitive.learn(demonstrate(3))
    course = primitive.course(Modulation(), robot)
    coarse, fine = integrate(course, 1 / 60, 180)[0], integrate(course, 1 / 600, 1800)[0][::10]
    assert np.abs(coarse - fine).max() < 5e-3 * np.ptp(fine, axis=0).max()


def test_a_demonstration_cut_out_of_a_motion_is_eased_along_the_same_path_or_refused(robot, demonstrate):
    whole = demonstrate(1)
    cut = Trajectory(whole.times[:150], whole.positions[60:210], whole.joints)
    with pytest.raises(InputError, match="moves at its start or end"):
        Primitive.learn(cut, Learning(moving_ends="refuse"))
    primitive = Primitive.learn(cut)
    assert primitive.tau_s == pytest.approx(cut.duration_s + 0.4, abs=0.01)
    shown = eased(cut)
    assert all(rests_at_ends(shown))
    assert np.abs(shown.positions[[0, -1]] - cut.positions[[0, -1]]).max() < 1e-12
    gaps = np.abs(shown.positions[:, None] - cut.resampled(0.001).positions[None]).max(axis=2).min(axis=1)
    assert gaps.max() < 5e-3  # nowhere off the path
    again = integrate(primitive.course(Modulation(), robot), 0.01, len(shown.times) - 1)[0]
    assert np.abs(again - shown.positions).max() < 1e-2
    assert eased(whole) is whole


@pytest.mark.parametrize("seed", range(8))
def test_noise_does_not_make_a_demonstration_move_at_its_ends(seed, robot, demonstrate):
    whole = demonstrate(seed)
    noise = np.random.default_rng(seed).standard_normal(whole.positions.shape)
    noisy = whole.positions + 0.01 * np.ptp(whole.positions, axis=0) * noise
    assert rests_at_ends(replace(whole, positions=noisy)) == (True, True)
    cut = Trajectory(whole.times[:151], noisy[75:226], whole.joints)
    assert not all(rests_at_ends(cut))
