"""Looking at a point: goals of the two joints nearest to the head that turn its gaze.

Points are in m from the floor below the robot: x ahead, y to its left, z up. A head looks along the direction
that is ahead while all joints are at zero.
"""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

from stimuli.errors import InputError
from stimuli.kinematics import axes, chain, link_poses
from stimuli.robots.model import Joint, Robot, Vector
from stimuli.trajectory import FloatArray

AHEAD = np.array([1.0, 0.0, 0.0])
_MISSED_RAD = math.radians(0.5)  # by which a gaze may miss its point


def looking_at(point: Vector, robot: Robot, pose: Mapping[str, float]) -> dict[str, float]:
    """Positions of the head's joints at which it looks at a point, the other joints being in that pose.

    InputError where the robot has no head, or cannot turn it there.
    """
    from scipy.optimize import least_squares

    head, turning = robot.head, _turning(robot)
    if head is None or not turning:
        raise InputError(f"{robot.name} has no head that it could turn; give goals of joints instead")
    upright = dict.fromkeys(robot.joint_names, 0.0)
    own_ahead = link_poses(robot.joints, upright)[head][:3, :3].T @ AHEAD
    wanted = np.array(point) - np.array(robot.base_xyz)

    def missed(positions: FloatArray) -> FloatArray:
        """Difference of two directions: where the head looks and where the point is."""
        at = dict(pose) | dict(zip((joint.name for joint in turning), positions.tolist(), strict=True))
        seen_from = link_poses(robot.joints, at)[head]
        way = wanted - seen_from[:3, 3]
        made: FloatArray = seen_from[:3, :3] @ own_ahead - way / np.linalg.norm(way)
        return made

    lower, upper = ([getattr(joint, end) for joint in turning] for end in ("lower", "upper"))
    begin = np.clip([pose[joint.name] for joint in turning], np.add(lower, 1e-6), np.subtract(upper, 1e-6))
    best = least_squares(missed, begin, bounds=(lower, upper), xtol=1e-12, ftol=1e-12, gtol=1e-12)
    missed_rad = 2 * math.asin(min(1.0, float(np.linalg.norm(best.fun)) / 2))
    if missed_rad > _MISSED_RAD:
        limits = ", ".join(
            f"{joint.name} {math.degrees(joint.lower):.0f}…{math.degrees(joint.upper):.0f} deg"
            for joint in turning
        )
        raise InputError(
            f"{list(point)} cannot be looked at by {robot.name}: its gaze stays "
            f"{math.degrees(missed_rad):.0f} deg off, within {limits}"
        )
    return {joint.name: float(position) for joint, position in zip(turning, best.x, strict=True)}


def _turning(robot: Robot) -> list[Joint]:
    """The two joints nearest to the head whose axes are not along its gaze."""
    directions = axes(robot.joints, dict.fromkeys(robot.joint_names, 0.0))
    path = chain(robot.joints, robot.head or "")
    across = [
        joint for joint in path if joint.kind == "revolute" and abs(directions[joint.name] @ AHEAD) < 0.7
    ]
    return across[-2:]
