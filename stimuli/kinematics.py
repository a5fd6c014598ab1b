"""Forward kinematics in numpy: where links are and which way axes point."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from stimuli.robots.model import Joint, Robot, Vector
from stimuli.trajectory import FloatArray


def link_poses(robot: Robot, positions: Mapping[str, float | FloatArray]) -> dict[str, FloatArray]:
    """Pose of every link in the frame of the robot's root, as homogeneous matrices (…, 4, 4).

    `positions` gives numbers, or arrays of one shape for many poses at once; joints not named are at home.
    """
    poses: dict[str, FloatArray] = {}
    joints = {joint.child: joint for joint in robot.joints if joint.kind != "dimensionless"}

    def pose(link: str) -> FloatArray:
        if link not in joints:
            return np.eye(4)
        if link not in poses:
            joint = joints[link]
            poses[link] = (
                pose(joint.parent)
                @ placed(joint)
                @ moved(joint, positions.get(joint.name, robot.home[joint.name]))
            )
        return poses[link]

    for link in joints:
        pose(link)
    return poses


def axes(robot: Robot, positions: Mapping[str, float]) -> dict[str, FloatArray]:
    """Direction (3,) of each joint's axis in the frame of the robot's root; dimensionless ones have none."""
    poses = link_poses(robot, positions)
    return {
        joint.name: (poses.get(joint.parent, np.eye(4)) @ placed(joint))[:3, :3] @ np.array(joint.axis)
        for joint in robot.joints
        if joint.kind != "dimensionless"
    }


def chain(robot: Robot, link: str) -> list[Joint]:
    """Joints from the root to a link."""
    above = {joint.child: joint for joint in robot.joints}
    joints: list[Joint] = []
    while link in above:
        joints.append(above[link])
        link = above[link].parent
    return joints[::-1]


def placed(joint: Joint) -> FloatArray:
    """Pose (4, 4) of the joint's frame in its parent link's."""
    pose = np.eye(4)
    roll, pitch, yaw = joint.origin_rpy
    pose[:3, :3] = rotation((0, 0, 1), yaw) @ rotation((0, 1, 0), pitch) @ rotation((1, 0, 0), roll)
    pose[:3, 3] = joint.origin_xyz
    return pose


def moved(joint: Joint, position: float | FloatArray) -> FloatArray:
    """Pose (…, 4, 4) of the joint's child link in the joint's frame."""
    position = np.asarray(position, dtype=np.float64)
    pose = np.broadcast_to(np.eye(4), (*position.shape, 4, 4)).copy()
    if joint.kind == "prismatic":
        pose[..., :3, 3] = position[..., None] * np.array(joint.axis)
    else:
        pose[..., :3, :3] = rotation(joint.axis, position)
    return pose


def rotation(axis: Vector, angle: float | FloatArray) -> FloatArray:
    """Rotation matrices (…, 3, 3) about a unit axis (Rodrigues)."""
    x, y, z = axis
    across = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]], dtype=np.float64)
    angle = np.asarray(angle, dtype=np.float64)[..., None, None]
    made: FloatArray = np.eye(3) + np.sin(angle) * across + (1 - np.cos(angle)) * (across @ across)
    return made
