"""A robot from the user's own URDF or MJCF."""

from __future__ import annotations

import pickle
import shutil
from pathlib import Path

import mujoco
import numpy as np
import pytest
from PIL import Image

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
MJCF = """\
<mujoco><compiler meshdir="../parts" angle="radian"/><asset><mesh name="arm" file="arm.obj"/></asset>
  <worldbody><include file="../parts/arm.xml"/></worldbody></mujoco>
"""
ARM = """\
<mujoco><body name="arm"><joint name="lift" axis="0 1 0" range="-1 1" limited="true"/>
  <geom type="mesh" mesh="arm"/></body></mujoco>
"""
TETRAHEDRON = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"
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


def test_a_changed_mesh_or_include_outside_the_folder_changes_the_hash(tmp_path: Path) -> None:
    (tmp_path / "parts").mkdir()
    (tmp_path / "robot").mkdir()
    mesh, arm = tmp_path / "parts" / "arm.obj", tmp_path / "parts" / "arm.xml"
    mesh.write_text(TETRAHEDRON)
    arm.write_text(ARM)
    hashes = [load_robot(write(tmp_path / "robot", "two.xml", MJCF), tmp_path / "robot").sha256]
    mesh.write_text(TETRAHEDRON.replace("0 0 1", "0 0 0.9"))
    hashes.append(load_robot("robot.yaml", tmp_path / "robot").sha256)
    arm.write_text(ARM.replace("-1 1", "-1 2"))
    hashes.append(load_robot("robot.yaml", tmp_path / "robot").sha256)
    assert len(set(hashes)) == 3
    copied = shutil.copytree(tmp_path, tmp_path / "elsewhere")
    assert load_robot("robot.yaml", copied / "robot").sha256 == hashes[-1]


def test_the_hash_is_the_same_wherever_meshes_and_pictures_lie(tmp_path: Path) -> None:
    drawn = '<texture name="skin" type="2d" file="skin.png"/><material name="skin" texture="skin"/></asset>'
    here, there = tmp_path / "here", tmp_path / "a" / "longer" / "path"
    here.mkdir()
    (here / "arm.obj").write_text(TETRAHEDRON)
    Image.new("RGB", (2, 2), "red").save(here / "skin.png")
    model = MJCF.replace("../parts", ".").replace('<include file="./arm.xml"/>', ARM[8:-10])
    write(
        here, "two.xml", model.replace("</asset>", drawn).replace('mesh="arm"', 'mesh="arm" material="skin"')
    )
    shutil.copytree(here, there)
    assert load_robot("robot.yaml", there).sha256 == load_robot("robot.yaml", here).sha256


def test_joints_that_an_mjcf_couples_follow_their_leader(tmp_path: Path) -> None:
    finger = '<body name="{0}"><joint name="{0}" range="-60 60" ref="{1}"/><geom size=".1"/></body>'
    equality = '<equality><joint joint1="right" joint2="left" polycoef="{}"/></equality>'

    def gripper(polycoef: str) -> str:
        fingers = finger.format("left", 0) + finger.format("right", 30)
        return f"<mujoco><worldbody>{fingers}</worldbody>{equality.format(polycoef)}</mujoco>"

    (tmp_path / "robot.yaml").write_text("robot: gripper\ntitle: A gripper\nmodel: gripper.xml\n")
    (tmp_path / "gripper.xml").write_text(gripper("0.1 -2 0 0 0"))
    robot = load_robot("robot.yaml", tmp_path)
    assert robot.joint_names == ("left",)
    assert robot.qpos({"left": 0.2})["right"] == pytest.approx(np.radians(30) + 0.1 - 2 * 0.2)
    (tmp_path / "gripper.xml").write_text(gripper("0 1 2 0 0"))
    with pytest.raises(InputError, match="joint 'right' follows 'left' along a curve"):
        load_robot("robot.yaml", tmp_path)


def test_what_cannot_be_used_is_said_with_its_place(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"nowhere\.yaml: cannot be read"):
        load_robot("nowhere.yaml", tmp_path)
    broken = URDF.replace('<cylinder radius="0.1" length="0.2"/>', '<mesh filename="package://a/b.dae"/>')
    with pytest.raises(InputError, match=r"two\.urdf:2: .* there is no folder 'a' in .*`search: \[PATH\]`"):
        load_robot(write(tmp_path, "two.urdf", broken), tmp_path)
    name = write(tmp_path, "two.urdf", URDF)
    (tmp_path / name).write_text((tmp_path / name).read_text().replace("{lift", "{lfit"))
    with pytest.raises(
        InputError,
        match=r"robot\.yaml:4: home\.lfit: 'lfit' is no joint that moves by itself; did you mean lift\?",
    ):
        load_robot(name, tmp_path)
    for wrong, message in (
        ("home: {lift: 0.1}\n", r"robot\.yaml:6: home stands there twice, first in line 4"),
        ("camera: {elevation_deg: -20}\n", r"robot\.yaml:6: camera: elevation_deg is -20; it lies from 0"),
        (
            "velocities: {lift: 1.0e+9}\n",
            r"robot\.yaml:6: velocities\.lift: .* to 1000, not 1000000000",
        ),
        ("look: " + "[" * 5000, r"robot\.yaml: cannot be read"),
    ):
        (tmp_path / name).write_text(YAML.format(model="two.urdf") + wrong)
        with pytest.raises(InputError, match=message):
            load_robot(name, tmp_path)
    ball = (
        '<mujoco><worldbody><body><joint name="b" type="ball"/><geom size=".1"/></body></worldbody></mujoco>'
    )
    with pytest.raises(InputError, match="joint 'b': only hinges and slides"):
        load_robot(write(tmp_path, "two.xml", ball), tmp_path)
