"""Motions under way: changes come without a jump, and motions follow each other smoothly."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from stimuli.dmp import Primitive
from stimuli.online import Runner, in_sequence, run
from stimuli.principles import PRINCIPLES, Modulation
from stimuli.rollout import integrate

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
