"""A robot from the user's own URDF or MJCF."""

from __future__ import annotations

import pickle
from pathlib import Path

import mujoco
import numpy as np
import pytest

from stimuli.errors import InputError
from stimuli.rendering import Renderer
from stimuli.robots import load_robot

URDF = """\
<robot name="two">
  <link name="base"><visual><geometry><cylinder radius="0.1" length="0.2"/></geometry></visual>
    <collision><geometry><box size="0.5 0.5 0.5"/></geometry></collision></link>
  <link name="post"/>
  <joint name="fixed" type="fixed"><parent link="base"/><child link="post"/><origin xyz="0 0 0.1"/></joint>
  <link name="arm"><visual><origin xyz="0 0 0.25"/>
    <geometry><box size="0.06 0.06 0.5"/></geometry></visual></link>
  <joint name="lift" type="revolute"><parent link="post"/><child link="arm"/>
    <origin xyz="0 0 0.2" rpy="0 0 0.3"/><axis xyz="0 1 0"/>
    <limit lower="-1" upper="1.5" velocity="2.5" effort="1"/></joint>
</robot>
"""
YAML = """\
robot: two
title: Two links
model: {model}
home: {{lift: 0.2}}
hands: [arm]
"""


def write(folder: Path, model: str, text: str) -> str:
    (folder / model).write_text(text)
    (folder / "robot.yaml").write_text(YAML.format(model=model))
    return "robot.yaml"


def test_a_urdf_keeps_its_limits_and_velocities(tmp_path: Path) -> None:
    robot = load_robot(write(tmp_path, "two.urdf", URDF), tmp_path)
    (lift,) = robot.joints
    assert (lift.kind, lift.lower, lift.upper, lift.max_velocity) == ("revolute", -1.0, 1.5, 2.5)
    np.testing.assert_allclose(lift.origin_xyz, (0, 0, 0.3), atol=1e-9)
    np.testing.assert_allclose(lift.origin_rpy, (0, 0, 0.3), atol=1e-6)
    assert robot.home == {"lift": 0.2}


def test_it_is_drawn_by_its_visible_shapes_and_goes_to_a_worker(tmp_path: Path) -> None:
    robot = pickle.loads(pickle.dumps(load_robot(write(tmp_path, "two.urdf", URDF), tmp_path)))
    types = [int(kind) for kind in robot.build().compile().geom_type]
    assert sorted(types) == sorted(map(int, (mujoco.mjtGeom.mjGEOM_CYLINDER, mujoco.mjtGeom.mjGEOM_BOX)))
    with Renderer(robot, width=64, height=64, camera="full_body") as renderer:
        still = renderer.frame(robot.home).astype(int)
        assert np.abs(still - renderer.frame({"lift": 1.2})).max() > 30


def test_a_changed_model_changes_the_hash(tmp_path: Path) -> None:
    before = load_robot(write(tmp_path, "two.urdf", URDF), tmp_path).sha256
    assert load_robot(write(tmp_path, "two.urdf", URDF.replace("0.06", "0.07")), tmp_path).sha256 != before


def test_what_cannot_be_used_is_said_with_its_place(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"nowhere\.yaml: cannot be read"):
        load_robot("nowhere.yaml", tmp_path)
    broken = URDF.replace('<cylinder radius="0.1" length="0.2"/>', '<mesh filename="package://a/b.dae"/>')
    with pytest.raises(InputError, match=r"two\.urdf: .* there is no folder 'a' in .*`search: \[PATH\]`"):
        load_robot(write(tmp_path, "two.urdf", broken), tmp_path)
    name = write(tmp_path, "two.urdf", URDF)
    (tmp_path / name).write_text((tmp_path / name).read_text().replace("{lift", "{lfit"))
    with pytest.raises(InputError, match=r"home: 'lfit' is no joint that moves by itself\. Known: lift\."):
        load_robot(name, tmp_path)
    ball = (
        '<mujoco><worldbody><body><joint name="b" type="ball"/><geom size=".1"/></body></worldbody></mujoco>'
    )
    with pytest.raises(InputError, match="joint 'b': only hinges and slides"):
        load_robot(write(tmp_path, "two.xml", ball), tmp_path)
