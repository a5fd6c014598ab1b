"""Laws every packaged robot keeps, whatever it looks like."""

from __future__ import annotations

import math
from pathlib import Path

import mujoco
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from stimuli.errors import InputError
from stimuli.robots import ROBOTS, load_robot
from stimuli.robots.facts import LOOK, read_facts, sources_sha256
from stimuli.robots.model import Robot
from stimuli.scene import pose

HERE = Path()


@pytest.fixture(params=ROBOTS, scope="module")
def robot(request: pytest.FixtureRequest) -> Robot:
    return load_robot(request.param, HERE)


@pytest.fixture(scope="module")
def model(robot: Robot) -> mujoco.MjModel:
    return robot.build().compile()


def forward_kinematics(robot: Robot, positions: dict[str, float]) -> dict[str, np.ndarray]:
    """Positions of all links from the facts alone: products of homogeneous matrices, as in a URDF."""
    base = read_facts(robot.name).base
    poses = {base.link: np.eye(4)}
    poses[base.link][:3, 3] = base.xyz
    for joint in robot.joints:
        if joint.kind == "dimensionless":
            continue
        step = np.eye(4)
        step[:3, :3] = Rotation.from_euler("xyz", joint.origin_rpy).as_matrix()
        step[:3, 3] = joint.origin_xyz
        move = np.eye(4)
        if joint.kind == "revolute":
            move[:3, :3] = Rotation.from_rotvec(positions[joint.name] * np.array(joint.axis)).as_matrix()
        else:
            move[:3, 3] = positions[joint.name] * np.array(joint.axis)
        poses[joint.child] = poses[joint.parent] @ step @ move
    return {link: pose[:3, 3] for link, pose in poses.items()}


def test_forward_kinematics_are_those_of_the_facts_within_a_tenth_of_a_millimetre(
    robot: Robot, model: mujoco.MjModel
) -> None:
    rng = np.random.default_rng(1)
    data = mujoco.MjData(model)
    for _ in range(20):
        positions = {joint.name: rng.uniform(joint.lower, joint.upper) for joint in robot.joints}
        pose(model, data, robot, positions)
        for link, expected in forward_kinematics(robot, positions).items():
            np.testing.assert_allclose(data.body(link).xpos, expected, atol=1e-4)


def test_at_home_every_joint_is_within_its_limits(robot: Robot) -> None:
    assert set(robot.home) == set(robot.joint_names)
    for joint in robot.joints:
        assert joint.lower <= robot.home[joint.name] <= joint.upper


def test_every_joint_says_how_fast_it_may_move(robot: Robot) -> None:
    assert all(joint.max_velocity and joint.max_velocity > 0 for joint in robot.joints)


def test_links_whose_reach_or_look_is_measured_exist(robot: Robot) -> None:
    links = {joint.child for joint in robot.joints}
    assert set(robot.hands) <= links
    assert robot.head is None or robot.head in links


def test_the_body_has_at_most_20000_triangles(model: mujoco.MjModel) -> None:
    assert 1_000 < model.nmeshface <= 20_000


def test_limits_of_the_body_are_those_of_the_facts(robot: Robot, model: mujoco.MjModel) -> None:
    for joint in robot.joints:
        if joint.kind != "dimensionless":
            np.testing.assert_allclose(model.joint(joint.name).range, [joint.lower, joint.upper], atol=1e-6)


def test_two_robots_do_not_share_a_hash() -> None:
    hashes = [load_robot(name, HERE).sha256 for name in ROBOTS]
    assert len(set(hashes)) == len(hashes)
    assert all(len(value) == 64 for value in hashes)


def test_a_hash_is_of_all_files_of_a_robot() -> None:
    own = ("robots/pepper.py", "robots/pepper.yaml", "robots/pepper_arms.py")
    assert load_robot("pepper", HERE).sha256 == sources_sha256(*own, *LOOK)


def test_an_unknown_robot_is_answered_with_the_nearest_name() -> None:
    with pytest.raises(InputError, match=r"'peper' is not a robot; did you mean pepper\?"):
        load_robot("peper", HERE)


def test_peppers_hand_drives_its_fourteen_fingers_and_nothing_else() -> None:
    pepper = load_robot("pepper", HERE)
    closed = pepper.qpos({**pepper.home, "LHand": 0.0})
    opened = pepper.qpos({**pepper.home, "LHand": 1.0})
    changed = {name for name in opened if opened[name] != closed[name]}
    assert len(changed) == 14
    assert all(name.startswith(("LFinger", "LThumb")) for name in changed)
    assert all(math.isclose(opened[name], 0.872665) for name in changed)


def test_pepper_is_as_tall_as_the_real_one() -> None:
    from stimuli.scene import extent

    pepper = load_robot("pepper", HERE)
    straight = pepper.build().compile()
    low, high = extent(straight, pepper)
    assert low == pytest.approx(0.0, abs=0.02)
    assert high == pytest.approx(1.21, abs=0.01)


def test_peppers_left_and_right_mirror_each_other() -> None:
    pepper = load_robot("pepper", HERE)
    body = pepper.build().compile()
    data = mujoco.MjData(body)
    flipped = ("ShoulderRoll", "ElbowYaw", "ElbowRoll", "WristYaw")
    arm = {
        "ShoulderPitch": 0.3,
        "ShoulderRoll": 0.4,
        "ElbowYaw": -0.7,
        "ElbowRoll": -0.9,
        "WristYaw": 0.5,
        "Hand": 0.6,
    }
    right = {f"R{name}": -value if name in flipped else value for name, value in arm.items()}
    still = dict.fromkeys(pepper.joint_names, 0.0)
    pose(body, data, pepper, {**still, **{f"L{name}": value for name, value in arm.items()}, **right})
    for left, other in (("l_wrist", "r_wrist"), ("LFinger23", "RFinger23"), ("LThumb2", "RThumb2")):
        mirrored = data.body(other).xpos * (1, -1, 1)
        np.testing.assert_allclose(data.body(left).xpos, mirrored, atol=1e-4)
