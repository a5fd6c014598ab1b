"""What describes a motion agrees with the closed forms of known ones."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from stimuli.descriptors import describe, sparc
from stimuli.dmp import Primitive
from stimuli.principles import Modulation
from stimuli.trajectory import Trajectory


def test_descriptors_of_a_minimum_jerk_reach_are_the_known_ones(robot):
    """Speed peaks at 1.875 of the mean; log dimensionless jerk is -ln(720 / 1.875^2) (Hogan 2009)."""
    s = np.linspace(0, 1, 2001)
    positions = np.zeros((len(s), len(robot.joints)))
    positions[:, 0] = 3 * (10 * s**3 - 15 * s**4 + 6 * s**5)
    described = describe(Trajectory(s * 1.0, positions, robot.joint_names), robot)
    assert described["duration_s"] == 1
    assert described["joints_moving"] == 1
    assert described["amplitude"] == pytest.approx(0.5)
    assert described["path_length"] == pytest.approx(0.5, rel=1e-3)
    assert described["speed_peak"] == pytest.approx(1.875 * described["speed_mean"], rel=1e-3)
    assert described["log_dimensionless_jerk"] == pytest.approx(-np.log(720 / 1.875**2), abs=2e-2)
    assert -1.6 < described["sparc"] < -1.35
    peaks = {"acceleration": 10 / np.sqrt(3), "jerk": 60}  # of an amplitude and a duration of 1
    means = {"acceleration": 3.75, "jerk": 40 / np.sqrt(3)}
    for rate, peak in peaks.items():
        assert described[f"{rate}_peak"] == pytest.approx(0.5 * peak, rel=1e-2)
        assert described[f"{rate}_mean"] == pytest.approx(0.5 * means[rate], rel=1e-2)


@pytest.mark.parametrize("n", [2, 3, 101])
def test_an_even_motion_has_no_jerk_to_take_the_logarithm_of(n, robot):
    even = Trajectory(np.linspace(0, 1, n), np.linspace(0, 0.3, n)[:, None] * np.ones(5), robot.joint_names)
    described = describe(even, robot)
    assert described["jerk_peak"] < 1e-6
    assert "log_dimensionless_jerk" not in described


def test_smoothness_does_not_depend_on_size_or_duration_and_falls_with_jerks(robot, demonstrate):
    shown = demonstrate(1)
    slower = Trajectory(2 * shown.times, shown.positions, shown.joints)
    smaller = replace(shown, positions=0.5 * shown.positions)
    rough = replace(shown, positions=shown.positions + 0.01 * np.sin(60 * shown.times)[:, None])
    smooth = [describe(t, robot) for t in (shown, slower, smaller, rough)]
    for other in smooth[1:3]:
        assert other["log_dimensionless_jerk"] == pytest.approx(smooth[0]["log_dimensionless_jerk"], abs=1e-6)
    assert smooth[3]["log_dimensionless_jerk"] < smooth[0]["log_dimensionless_jerk"] - 1
    speed = np.exp(-((np.linspace(-4, 4, 400)) ** 2))
    assert sparc(speed, 0.01) > sparc(speed + 0.3 * np.roll(speed, 120), 0.01)


def test_still_motions_have_descriptors_too(robot):
    still = Trajectory(np.linspace(0, 1, 101), np.full((101, 5), 0.1), robot.joint_names)
    assert describe(still, robot)["speed_peak"] == 0
    assert Primitive.learn(still).rollout(Modulation(), robot).duration_s == pytest.approx(1.0)
