"""Motions for other programs and for robots: one file per format, `WRITERS` by name."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from stimuli.errors import InputError
from stimuli.export.naoqi import write_angle_interpolation, write_angle_interpolation_bezier
from stimuli.export.qianim import write_qianim
from stimuli.export.ros import write_joint_trajectory
from stimuli.export.table import write_csv
from stimuli.robots.model import Robot
from stimuli.trajectory import Trajectory

WRITERS: dict[str, Callable[[Trajectory, Robot, Path], None]] = {
    "csv": lambda motion, _, path: write_csv(motion, path),
    "qianim": write_qianim,
    "naoqi": lambda motion, _, path: write_angle_interpolation(motion, path),
    "naoqi-bezier": lambda motion, _, path: write_angle_interpolation_bezier(motion, path),
    "ros": lambda motion, _, path: write_joint_trajectory(motion, path),
}
"""By name: `ros` is a ROS 2 JointTrajectory in YAML, `naoqi` the arguments of ALMotion in JSON."""

_PEPPERS = ("qianim", "naoqi", "naoqi-bezier")


def write_motion(motion: Trajectory, robot: Robot, path: Path, form: str) -> None:
    """Write a motion in that format. InputError where the robot or the file does not take it."""
    if form in _PEPPERS and robot.name != "pepper":
        others = ", ".join(other for other in WRITERS if other not in _PEPPERS)
        raise InputError(
            f"{form} is for Pepper; {robot.name} does not understand it. For any robot: {others}"
        )
    try:
        WRITERS[form](motion, robot, path)
    except OSError as err:
        raise InputError(f"{path}: cannot be written: {err.strerror}") from err
