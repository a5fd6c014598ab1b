"""Motions for NAOqi robots: the arguments of `ALMotion.angleInterpolation`, and sending them.

NAOqi wants, for each joint, a list of angles and a list of times, the first of them later than now. Samples
are thinned to `dt_s`, which the robot's own 50 Hz interpolation fills.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Protocol

import numpy as np

from stimuli.export.bezier import bezier_keys
from stimuli.trajectory import FloatArray, Trajectory, even_times

APPROACH_S = 1.0  # granted to go from wherever the robot stands to the first pose


class MotionService(Protocol):
    """What is used of ALMotion."""

    def angleInterpolation(  # noqa: N802
        self, names: list[str], angles: list[list[float]], times: list[list[float]], absolute: bool, /
    ) -> object:
        """Move joints along angles at times; returns once done."""


def angle_interpolation(trajectory: Trajectory, dt_s: float = 0.04) -> dict[str, object]:
    """Arguments for ALMotion: names, angles, times (a list per joint each), and that angles are absolute."""
    times: FloatArray = even_times(trajectory.duration_s, dt_s)
    angles = trajectory.at(times).T.tolist()
    moments = (times + APPROACH_S).tolist()
    return {
        "names": list(trajectory.joints),
        "angleLists": angles,
        "timeLists": [moments] * len(trajectory.joints),
        "isAbsolute": True,
    }


def angle_interpolation_bezier(trajectory: Trajectory, dt_s: float = 0.2) -> dict[str, object]:
    """Arguments for ALMotion.angleInterpolationBezier: names; times and control points, a list per joint.

    A control point is the angle and the handles before and after it, each [3, time, angle]: 3 says Bezier.
    """
    times, angles, slopes = bezier_keys(trajectory, dt_s)
    before, after = np.full(len(times), -dt_s / 3), np.full(len(times), dt_s / 3)
    before[0] = -APPROACH_S / 3
    points = [
        [
            [angle, [3, early, early * slope], [3, late, late * slope]]
            for angle, slope, early, late in zip(
                along.tolist(), slope_along.tolist(), before.tolist(), after.tolist(), strict=True
            )
        ]
        for along, slope_along in zip(angles.T, slopes.T, strict=True)
    ]
    moments = (times + APPROACH_S).tolist()
    return {
        "jointNames": list(trajectory.joints),
        "times": [moments] * len(trajectory.joints),
        "controlPoints": points,
    }


def write_angle_interpolation_bezier(trajectory: Trajectory, path: Path) -> None:
    """Write the arguments of angleInterpolationBezier as JSON."""
    path.write_text(json.dumps(angle_interpolation_bezier(trajectory)), encoding="utf-8")


def write_angle_interpolation(trajectory: Trajectory, path: Path) -> None:
    """Write the arguments as JSON."""
    path.write_text(json.dumps(angle_interpolation(trajectory)), encoding="utf-8")


def send(trajectory: Trajectory, motion: MotionService) -> None:
    """Let a robot do it; `motion` is `qi.Session(...).service("ALMotion")`."""
    arguments = angle_interpolation(trajectory)
    motion.angleInterpolation(*arguments.values())  # type: ignore[arg-type]
