"""Motions for other programs read back, or arrive, as they are."""

from __future__ import annotations

import json

import numpy as np
import pytest
import yaml

from stimuli.errors import InputError
from stimuli.export import WRITERS, write_motion
from stimuli.export.naoqi import (
    APPROACH_S,
    send,
    write_angle_interpolation,
    write_angle_interpolation_bezier,
)
from stimuli.export.qianim import write_qianim
from stimuli.export.ros import write_joint_trajectory
from stimuli.export.table import write_csv
from stimuli.gestures import read_gesture


def test_csv_reads_back_the_same(tmp_path, robot, demonstrate):
    shown = demonstrate(1)
    write_csv(shown, tmp_path / "a.csv")
    again = read_gesture(tmp_path / "a.csv", robot)
    assert again.joints == shown.joints
    assert np.abs(again.positions - shown.positions).max() < 1e-12


def test_an_animation_reads_back_the_same(tmp_path, robot, demonstrate):
    shown = demonstrate(1)
    write_qianim(shown, robot, tmp_path / "a.qianim")
    again = read_gesture(tmp_path / "a.qianim", robot)
    assert np.abs(again.at(shown.times) - shown.positions).max() < 1e-3
    write_qianim(again, robot, tmp_path / "b.qianim")
    twice = read_gesture(tmp_path / "b.qianim", robot)
    assert np.abs(twice.at(again.times) - again.positions).max() < 1e-3


def test_bezier_control_points_follow_the_motion(tmp_path, demonstrate):
    """Each piece, by the Bezier formula at its middle, is where the motion is."""
    shown = demonstrate(1)
    write_angle_interpolation_bezier(shown, tmp_path / "a.json")
    names, times, points = json.loads((tmp_path / "a.json").read_text()).values()
    assert names == list(shown.joints)
    for column in range(len(names)):
        moments = np.array(times[column]) - APPROACH_S
        for at in range(len(moments) - 1):
            (angle, _, after), (following, before, _) = points[column][at : at + 2]
            assert after[0] == before[0] == 3
            assert after[1] == pytest.approx(-before[1] if at else after[1])
            middle = (angle + 3 * (angle + after[2]) + 3 * (following + before[2]) + following) / 8
            moment = (moments[at] + moments[at + 1]) / 2
            expected = np.interp(moment, shown.times, shown.positions[:, column])
            assert middle == pytest.approx(expected, abs=6e-3)


def test_ros_gets_every_sample_with_its_time(tmp_path, demonstrate):
    shown = demonstrate(1)
    write_joint_trajectory(shown, tmp_path / "a.yaml")
    message = yaml.safe_load((tmp_path / "a.yaml").read_text())
    assert message["joint_names"] == list(shown.joints)
    times = [p["time_from_start"]["sec"] + 1e-9 * p["time_from_start"]["nanosec"] for p in message["points"]]
    assert times == pytest.approx(shown.times, abs=1e-9)
    assert np.array([p["positions"] for p in message["points"]]) == pytest.approx(shown.positions)
    assert message["points"][0]["velocities"] == [0.0] * 5


def test_a_naoqi_robot_is_sent_what_is_written(tmp_path, demonstrate):
    shown = demonstrate(1)
    sent = []

    class Robot:
        def angleInterpolation(self, *arguments):  # noqa: N802
            sent.append(arguments)

    send(shown, Robot())
    write_angle_interpolation(shown, tmp_path / "a.json")
    assert list(sent[0]) == list(json.loads((tmp_path / "a.json").read_text()).values())
    names, angles, times, absolute = sent[0]
    assert names == list(shown.joints)
    assert absolute is True
    assert pytest.approx(shown.at(np.array(times[0]) - APPROACH_S)) == np.array(angles).T
    assert times[0][0] > 0


@pytest.mark.parametrize("form", WRITERS)
def test_what_only_pepper_plays_is_refused_for_other_robots(form, robot, demonstrate, tmp_path):
    if form in ("csv", "ros"):
        write_motion(demonstrate(1), robot, tmp_path / "out", form)
        assert (tmp_path / "out").stat().st_size > 0
        with pytest.raises(InputError, match=r"nowhere/out: cannot be written: No such file"):
            write_motion(demonstrate(1), robot, tmp_path / "nowhere" / "out", form)
    else:
        with pytest.raises(InputError, match=rf"{form} is for Pepper; toy .* For any robot: csv, ros"):
            write_motion(demonstrate(1), robot, tmp_path / "out", form)
