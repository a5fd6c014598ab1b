"""Forward kinematics in numpy: where links are and which way axes point."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from stimuli.robots.model import Joint, Vector
from stimuli.trajectory import FloatArray


def link_poses(
    joints: tuple[Joint, ...], positions: Mapping[str, float | FloatArray]
) -> dict[str, FloatArray]:
    """Pose of every link in the frame of the root, as homogeneous matrices (…, 4, 4).

    `positions` gives every joint's as a number, or as an array of one shape for many poses at once.
    """
    poses: dict[str, FloatArray] = {}
    above = {joint.child: joint for joint in joints if joint.kind != "dimensionless"}

    def pose(link: str) -> FloatArray:
        if link not in above:
            return np.eye(4)
        if link not in poses:
            joint = above[link]
            poses[link] = pose(joint.parent) @ placed(joint) @ moved(joint, positions[joint.name])
        return poses[link]

    for link in above:
        pose(link)
    return poses


def axes(joints: tuple[Joint, ...], positions: Mapping[str, float]) -> dict[str, FloatArray]:
    """Direction (3,) of each joint's axis in the root's frame; dimensionless ones have none."""
    poses = link_poses(joints, positions)
    return {
        joint.name: (poses.get(joint.parent, np.eye(4)) @ placed(joint))[:3, :3] @ np.array(joint.axis)
        for joint in joints
        if joint.kind != "dimensionless"
    }


def chain(joints: tuple[Joint, ...], link: str) -> list[Joint]:
    """Joints from the root to a link."""
    above = {joint.child: joint for joint in joints}
    path: list[Joint] = []
    while link in above:
        path.append(above[link])
        link = above[link].parent
    return path[::-1]


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
