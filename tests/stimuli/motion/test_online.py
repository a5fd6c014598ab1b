"""Motions under way: changes come without a jump, and motions follow each other smoothly."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from stimuli.dmp import Primitive
from stimuli.errors import InputError
from stimuli.online import Runner, in_sequence, run
from stimuli.principles import PRINCIPLES, Modulation
from stimuli.principles.slow import Slow
from stimuli.rollout import integrate
from stimuli.trajectory import Trajectory

DT = 1e-4


@pytest.mark.parametrize("kind", sorted(PRINCIPLES))
def test_an_intensity_may_change_under_way_without_a_jump(kind, robot, demonstrate):
    primitive = Primitive.learn(demonstrate(2))
    example = PRINCIPLES[kind].example(robot)
    before = primitive.course(Modulation(), robot)
    after = primitive.course(Modulation().with_(example), robot)
    _assert_smooth(before, after)
    _assert_smooth(after, before)


def test_several_changes_in_a_row_are_smooth_and_the_motion_still_arrives(robot, demonstrate):
    primitive = Primitive.learn(demonstrate(2))
    runner = Runner(primitive.course(Modulation(), robot))
    shown = [runner.positions]
    for kind in ("sec", "time", "follow", "exa"):
        for _ in range(40):
            shown.append(runner.step(0.01))
        runner.change(primitive.course(Modulation().with_(PRINCIPLES[kind].example(robot)), robot))
    for _ in range(600):
        shown.append(runner.step(0.01))
    assert np.abs(shown[-1] - runner.course.goal).max() < 1e-9
    assert np.abs(np.diff(np.stack(shown), axis=0)).max() < 0.1


def test_a_goal_may_move_under_way(robot, demonstrate):
    course = Primitive.learn(demonstrate(2)).course(Modulation(), robot)
    for lag in (0.0, 0.3):
        runner = Runner(replace(course, goal_lag_s=lag))
        for _ in range(100):
            runner.step(0.01)
        here = runner.positions
        runner.step(DT, goal={"Hip": 1.0, "Elbow": -0.5})
        assert np.abs(runner.positions - here).max() < 5 * DT
        for _ in range(600):
            runner.step(0.01, goal={"Hip": 1.0, "Elbow": -0.5})
        assert runner.positions[[0, 3]] == pytest.approx([1.0, -0.5], abs=1e-4)


@pytest.mark.parametrize("lag", [0.0, 0.3])
def test_goals_moving_at_given_moments_are_those_set_by_hand_at_these_moments(lag, robot, demonstrate):
    primitive = Primitive.learn(demonstrate(2))
    written = {"goal": {"lag_s": lag, "Hip": {0.5: 1.0, "1.4 s": "-20 deg"}, "Elbow": {1.4: -0.5}}}
    moving = Modulation.model_validate_json(Modulation.model_validate(written).model_dump_json())
    planned, _ = integrate(primitive.course(moving, robot), 0.01, 400)
    runner = Runner(replace(primitive.course(Modulation(), robot), goal_lag_s=lag))
    goals = {50: {"Hip": 1.0}, 140: {"Hip": np.radians(-20), "Elbow": -0.5}}
    by_hand = [runner.positions, *(runner.step(0.01, goal=goals.get(k)) for k in range(400))]
    # where a goal jumps, the step before it already leans towards it in the planned motion
    np.testing.assert_allclose(planned, by_hand, atol=1e-11 if lag else 0.03)
    assert planned[-1, [0, 3]] == pytest.approx([np.radians(-20), -0.5], abs=1e-2)


@pytest.mark.parametrize("moments", [{}, {-0.1: 0.2}, {"soon": 0.2}])
def test_a_goal_that_moves_needs_moments(moments):
    with pytest.raises(ValueError, match=r"goal\.Hip"):
        Modulation.model_validate({"goal": {"Hip": moments}})


def test_a_gliding_goal_sets_out_more_gently_than_one_that_jumps(robot, demonstrate):
    primitive = Primitive.learn(demonstrate(2))
    speeds = []
    for lag in (0.0, 0.4):
        goal = {"goal": {"Hip": 1.2, "lag_s": lag}}
        plain, moved = (primitive.course(Modulation.model_validate(m), robot) for m in ({}, goal))
        answer = run(moved, 0.01, 300)[0][:, 0] - run(plain, 0.01, 300)[0][:, 0]
        speeds.append(np.diff(answer).max())
    assert speeds[1] < 0.6 * speeds[0]


def test_motions_in_sequence_join_in_position_and_velocity(robot, demonstrate):
    courses = [Primitive.learn(demonstrate(seed)).course(Modulation(), robot) for seed in (1, 2, 3)]
    shown = in_sequence(courses, 0.001, handover=0.8)
    speeds = np.diff(shown, axis=0) / 0.001
    assert (
        np.abs(np.diff(speeds, axis=0)).max() < 0.6
    )  # per second and millisecond; a joint's own peak is 0.4
    assert np.abs(shown[-1] - courses[-1].goal).max() < 1e-2
    assert len(shown) == pytest.approx((0.8 + 0.8 + 1) * 3000, abs=3)


CHANGES = {
    "goal": lambda course: replace(course, goal=course.goal + 0.5),
    "gliding goal": lambda course: replace(
        course, goal=course.goal + 0.5, former_goal=course.goal, goal_lag_s=0.2
    ),
    "start": lambda course: replace(course, start=course.start - 0.3),
    "duration": lambda course: replace(course, tau_s=0.6 * course.tau_s),
    "exaggeration": lambda course: replace(course, exaggeration=1.8),
    "follow": lambda course: replace(course, dragged=course.coupling(2.0)),
    "secondary, stronger": lambda course: replace(course, carried=course.coupling(0.4)),
    "secondary, gone": lambda course: replace(course, carried=None),
    "secondary in the state": lambda course: replace(course, carried=None, induced=course.coupling(3.0)),
    "clock": lambda course: replace(course, clock=Slow(intensity=0.8).curve()),
}


@pytest.mark.parametrize("afresh", [False, True])
@pytest.mark.parametrize("change", CHANGES)
@settings(max_examples=4)
@given(seed=st.integers(0, 10_000), share=st.floats(0.05, 1.1), strength=st.floats(0.05, 0.3))
def test_whatever_changes_under_secondary_action_velocity_is_continuous(
    change, afresh, seed, share, strength, robot, demonstrate
):
    modulation = Modulation.model_validate({"sec": strength, "exa": 1.2})
    before = Primitive.learn(demonstrate(seed)).course(modulation, robot)
    runner = Runner(before)
    for _ in range(30):
        runner.step(share * before.tau_s / 30)
    jump, speed = _jump_at(runner, lambda: runner.change(CHANGES[change](before), afresh=afresh))
    assert jump < 1e-3 * (1 + speed)


@settings(max_examples=8)
@given(seed=st.integers(0, 10_000), seconds=st.floats(0.1, 3.5), far=st.floats(-1, 1))
def test_a_goal_given_in_a_step_makes_no_velocity_jump(seed, seconds, far, robot, demonstrate):
    modulation = Modulation.model_validate({"sec": 0.15, "follow": 1})
    runner = Runner(Primitive.learn(demonstrate(seed)).course(modulation, robot))
    runner.step(seconds)
    jump, speed = _jump_at(runner, lambda: runner.head_for({"Hip": far, "Shoulder": -far}))
    assert jump < 1e-3 * (1 + speed)


def test_a_change_to_the_same_course_changes_nothing(robot, demonstrate):
    modulation = Modulation.model_validate({"sec": 0.15, "slow": {"intensity": 1, "form": "retime"}})
    course = Primitive.learn(demonstrate(2)).course(modulation, robot)
    runner, other = Runner(course), Runner(course)
    for k in range(400):
        if k % 40 == 0:
            other.change(replace(course))
        assert np.abs(runner.step(0.01) - other.step(0.01)).max() < 1e-9


RETIMED = [
    {"time": {"progression": ["slow", "fast"], "form": "retime"}},
    {"time": {"progression": [0.01, 3, 3], "form": "retime"}},
    *({"slow": {"intensity": 1, "steepness": steep, "form": "retime"}} for steep in (10, 20, 50, 100)),
]


@pytest.mark.parametrize("retimed", RETIMED, ids=str)
@pytest.mark.parametrize("handover", [0.3, 0.6, 0.9])
def test_a_clock_that_all_but_stands_still_takes_over_within_bounds(retimed, handover, robot, demonstrate):
    primitive = Primitive.learn(demonstrate(2))
    plain, slow = (primitive.course(Modulation.model_validate(m), robot) for m in ({}, retimed))
    largest = np.abs(in_sequence([plain, plain], 0.01, handover=handover)).max(axis=0)
    assert np.all(np.abs(in_sequence([plain, slow], 0.01, handover=handover)).max(axis=0) < largest + 0.2)
    runner = Runner(plain)
    runner.step(handover * plain.tau_s)
    jump, speed = _jump_at(runner, lambda: runner.change(slow))
    assert jump < 1e-3 * (1 + speed)
    assert np.all([np.abs(runner.step(0.01)) < largest + 0.2 for _ in range(400)])
    assert np.abs(runner.positions - slow.goal).max() < 1e-3


def test_secondary_action_is_handed_over_once(robot, demonstrate):
    course = Primitive.learn(demonstrate(2)).course(Modulation.model_validate({"sec": 0.3}), robot)
    steps = np.abs(np.diff(in_sequence([course] * 3, 0.001, handover=0.8), axis=0)).max(axis=1)
    assert len(steps) == pytest.approx((0.8 + 0.8 + 1) * 3000, abs=3)
    assert np.abs(np.diff(steps)).max() < 0.05 * steps.max()


@pytest.mark.parametrize("kind", sorted(PRINCIPLES))
def test_a_step_of_no_time_changes_nothing(kind, robot, demonstrate):
    course = Primitive.learn(demonstrate(1)).course(
        Modulation().with_(PRINCIPLES[kind].example(robot)), robot
    )
    runner, other = Runner(course), Runner(course)
    for _ in range(60):
        before = other.positions
        assert np.array_equal(other.step(0.0), before)
        assert np.array_equal(runner.step(0.05), other.step(0.05))


@pytest.mark.parametrize(
    ("dt_s", "goal", "message"),
    [
        (-0.01, None, "dt_s: a step takes a time of at least 0 s, not -0.01"),
        (np.nan, None, "dt_s: .* not nan"),
        (np.inf, None, "dt_s: .* not inf"),
        (0.01, {"Hip": np.nan}, r"goal\.Hip: nan is not a position"),
        (0.01, {"Hip": -np.inf}, r"goal\.Hip: -inf is not a position"),
        (0.01, {"Hipp": 0.1}, "goal: toy has no joint 'Hipp'; did you mean Hip?"),
    ],
)
def test_steps_and_goals_that_are_none_are_refused_and_leave_the_motion_alone(
    dt_s, goal, message, robot, demonstrate
):
    course = Primitive.learn(demonstrate(1)).course(Modulation(), robot)
    runner, other = Runner(course), Runner(course)
    with pytest.raises(InputError, match=message):
        runner.step(dt_s, goal=goal)
    assert np.array_equal(runner.step(0.01), other.step(0.01))


def test_a_motion_goes_on_with_the_same_joints_in_steps_that_lead_somewhere(robot, demonstrate):
    shown = demonstrate(1)
    one, other = Trajectory(shown.times, shown.positions[:, :2], shown.joints[:2]), shown
    courses = [Primitive.learn(each).course(Modulation(), robot) for each in (one, other)]
    with pytest.raises(
        InputError, match="A motion of Hip, Waist cannot go on as one of Hip, Waist, Shoulder"
    ):
        in_sequence(courses, 0.01)
    with pytest.raises(InputError, match="steps of more than 0 s"):
        in_sequence(courses[:1], 0.0)


@pytest.mark.parametrize("lag", [0.0, 0.3])
@pytest.mark.parametrize("at", [30, 80, 200])
def test_a_new_goal_for_one_joint_leaves_the_planned_goals_of_others(at, lag, robot, demonstrate):
    primitive = Primitive.learn(demonstrate(2))

    def moving(**goals):
        return primitive.course(Modulation.model_validate({"goal": {"lag_s": lag, **goals}}), robot)

    planned = Runner(moving(Hip={0.5: 1.0, 1.4: -0.5}, Elbow={0.9: 0.6}))
    other = Runner(planned.course)
    for k in range(400):
        goal = {"Shoulder": 0.7, "Elbow": -0.2} if k >= at else None
        one, two = planned.step(0.01), other.step(0.01, goal=goal)
        assert np.abs(one - two)[[0, 1, 4]].max() < 1e-11
    assert two[[2, 3]] == pytest.approx([0.7, -0.2], abs=1e-2)


def _jump_at(runner, change):
    """The largest jump of a joint's shown velocity at a change, or of its position; and the peak speed."""
    shown = [runner.positions, runner.step(DT), runner.step(DT)]
    change()
    shown += [runner.positions, runner.step(DT), runner.step(DT)]
    ends = np.array([-1.5, 2.0, -0.5]) / DT  # the slope at one end of three samples, to second order
    before, after = -ends[::-1] @ np.stack(shown[:3]), ends @ np.stack(shown[3:])
    jump = max(np.abs(after - before).max(), np.abs(shown[3] - shown[2]).max() / DT)
    return jump, np.abs(before).max()


def _assert_smooth(before, after):
    runner = Runner(before)
    for _ in range(90):
        runner.step(0.01)
    shown = [runner.step(DT) for _ in range(3)]
    runner.change(after)
    shown += [runner.positions] + [runner.step(DT) for _ in range(3)]
    positions = np.stack(shown)
    speeds = np.diff(np.delete(positions, 3, axis=0), axis=0) / DT
    assert np.abs(positions[3] - positions[2]).max() < 1e-12
    bent = np.abs(np.diff(speeds, axis=0)).max()
    assert bent < 1e3 * DT  # an acceleration, however large, changes the speed in proportion to the step
