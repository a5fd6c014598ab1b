"""A small robot and demonstrations for it, smooth and from rest to rest."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from stimuli.robots.model import Joint, Robot
from stimuli.trajectory import Trajectory


def _joint(name: str, parent: str, child: str, axis: tuple[float, float, float], **more) -> Joint:
    facts = {"kind": "revolute", "origin_xyz": (0.0, 0.0, 0.3), "origin_rpy": (0.0, 0.0, 0.0)} | more
    return Joint(name, parent, child, axis=axis, lower=-3.0, upper=3.0, max_velocity=100.0, **facts)


def _no_body():
    raise NotImplementedError("kinematics only")


@pytest.fixture(scope="session")
def robot() -> Robot:
    """Hip, waist, shoulder and elbow in one chain; axes along y, -y, z and y; and a hand."""
    joints = (
        _joint("Hip", "base", "pelvis", (0, 1, 0)),
        _joint("Waist", "pelvis", "torso", (0, -1, 0)),
        _joint("Shoulder", "torso", "arm", (0, 0, 1)),
        _joint("Elbow", "arm", "forearm", (0, 1, 0)),
        _joint("Hand", "forearm", "hand", (0, 0, 0), kind="dimensionless"),
    )
    return Robot("toy", "A toy", joints, {joint.name: 0.1 for joint in joints}, _no_body, hands=("forearm",))


@pytest.fixture(scope="session")
def demonstrate(robot) -> Callable[..., Trajectory]:
    """A demonstration for every seed: each joint reaches somewhere, with a few bumps on the way."""

    def make(seed: int = 0, duration_s: float = 3.0, dt_s: float = 0.01) -> Trajectory:
        rng = np.random.default_rng(seed)
        s = np.linspace(0, 1, round(duration_s / dt_s) + 1)[:, None]
        d = len(robot.joints)
        reach = (10 * s**3 - 15 * s**4 + 6 * s**5) * rng.uniform(-1, 1, d)
        bumps = np.sin(np.pi * s) ** 4 * np.sin(2 * np.pi * s * rng.uniform(0.5, 2, d) + rng.uniform(0, 6, d))
        positions = 0.3 + reach + rng.uniform(0.2, 0.8, d) * bumps
        return Trajectory(s[:, 0] * duration_s, positions, robot.joint_names)

    return make
