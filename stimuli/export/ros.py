"""Motions for ROS 2: a `trajectory_msgs/msg/JointTrajectory` as YAML, as `ros2 topic pub` takes it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import yaml

from stimuli.trajectory import Trajectory


def joint_trajectory(trajectory: Trajectory) -> dict[str, object]:
    """The message: positions and velocities (central differences, at rest at both ends) at every sample."""
    velocities = np.gradient(trajectory.positions, trajectory.times, axis=0)
    velocities[[0, -1]] = 0.0
    points = [
        {
            "positions": positions,
            "velocities": speeds,
            "time_from_start": {
                "sec": int(time),
                "nanosec": min(round((time - int(time)) * 1e9), 999_999_999),
            },
        }
        for time, positions, speeds in zip(
            trajectory.times.tolist(), trajectory.positions.tolist(), velocities.tolist(), strict=True
        )
    ]
    return {"header": {"frame_id": ""}, "joint_names": list(trajectory.joints), "points": points}


def write_joint_trajectory(trajectory: Trajectory, path: Path) -> None:
    """Write the message."""
    path.write_text(yaml.safe_dump(joint_trajectory(trajectory), sort_keys=False), encoding="utf-8")
