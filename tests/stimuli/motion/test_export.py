"""Motions for other programs read back, or arrive, as they are."""

from __future__ import annotations

import json

import numpy as np
import pytest
import yaml

from stimuli.export.naoqi import APPROACH_S, send, write_angle_interpolation
from stimuli.export.ros import write_joint_trajectory
from stimuli.export.table import write_csv
from stimuli.gestures import read_gesture


def test_csv_reads_back_the_same(tmp_path, robot, demonstrate):
    shown = demonstrate(1)
    write_csv(shown, tmp_path / "a.csv")
    again = read_gesture(tmp_path / "a.csv", robot)
    assert again.joints == shown.joints
    assert np.abs(again.positions - shown.positions).max() < 1e-12


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
