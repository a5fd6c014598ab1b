"""A URDF that leaves something open is refused at its line, with what is there and what would do."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from stimuli.errors import InputError
from stimuli.robots import load_robot

URDF = """\
<robot name="lift">
  <link name="base"><inertial><mass value="1"/>
    <inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
    <visual><geometry><cylinder radius="0.1" length="0.2"/></geometry></visual></link>
  <link name="arm"><visual><geometry><box size="0.06 0.06 0.5"/></geometry></visual></link>
  <link name="tip"/>
  <joint name="turn" type="revolute"><parent link="base"/><child link="arm"/>
    <origin xyz="0 0 0.2" rpy="0 0 0.3"/><axis xyz="0 1 0"/>
    <limit lower="-1" upper="1.5" velocity="2.5"/></joint>
  <joint name="reach" type="prismatic"><parent link="arm"/><child link="tip"/>
    <limit lower="0" upper="0.3" velocity="1"/></joint>
</robot>
"""
REACH = '<limit lower="0" upper="0.3" velocity="1"/>'
TURN = '<limit lower="-1" upper="1.5" velocity="2.5"/>'


@pytest.mark.parametrize(
    ("written", "instead", "said"),
    [
        (TURN, "", "7: joint 'turn': a revolute joint without <limit>; give <limit lower="),
        (REACH, "", "10: joint 'reach': a prismatic joint without <limit>; give <limit lower="),
        ('lower="-1" upper="1.5"', "", "9: joint 'turn': limit: lower 0 is not below upper 0; give"),
        ('lower="-1"', 'lower="2"', "9: joint 'turn': limit: lower 2 is not below upper 1.5"),
        ('lower="-1"', 'lower="nan"', "9: joint 'turn': limit: lower is 'nan', not a number"),
        ('velocity="2.5"', 'velocity="-2"', "9: joint 'turn': limit: velocity -2 is below zero; give"),
        ('velocity="2.5"', 'velocity="fast"', "9: joint 'turn': limit: velocity is 'fast', not a number"),
        ('upper="1.5"', 'upper="1e9"', "9: joint 'turn': limit: 1e+09 rad is more than 10 turns; give it in"),
        ('lower="-1"', 'lower="-90"', "9: joint 'turn': limit: -90 rad is more than 10 turns; give it in"),
        ('upper="0.3"', 'upper="300"', "11: joint 'reach': limit: 300 m is further than 100 m; give it in m"),
        ('velocity="1"', 'velocity="1e16"', "11: joint 'reach': limit: velocity 1e+16 is above 1000 per"),
        ("0 0 0.2", "0 0 200", "8: joint 'turn': origin: xyz '0 0 200' is further than 100 m; give it in m"),
        ("0.06 0.06 0.5", "60 60 500", "5: link 'arm': box: size '60 60 500'; sizes are above zero and at"),
        ('upper="1.5"', 'upper="${reach}"', "9: this is xacro still, at <limit>. Expand it"),
        ('mass value="1"', 'mass value="-1"', "2: link 'base': mass: value -1 is below zero; give"),
        ('iyy="1"', 'iyy="-1"', "3: link 'base': inertia: iyy -1 is below zero; give"),
        ("0.06 0.06 0.5", "0.06 0 0.5", "5: link 'arm': box: size '0.06 0 0.5'; sizes are above zero and at"),
        (' length="0.2"', "", "4: link 'base': cylinder: length is '', not a number"),
        ('xyz="0 1 0"', 'xyz="0 0 0"', "8: joint 'turn': axis 0 0 0 points nowhere; 0 0 1 is upwards"),
        ('rpy="0 0 0.3"', 'rpy="0 0"', "8: joint 'turn': origin: rpy is '0 0', not 3 numbers"),
        ('name="reach"', 'name="turn"', "10: joint 'turn' is there in line 7 already"),
        ('link name="tip"', "link", "6: this <link> has no name; give it one"),
        ('type="revolute"', 'type="revolut"', "7: joint 'turn': type 'revolut' is none; did you mean"),
        ('child link="tip"', 'child link="tpi"', "10: joint 'reach': child 'tpi' is no link; did you"),
        ('<parent link="arm"/>', "", "10: joint 'reach': 0 <parent>; it needs one, naming a link"),
        ('child link="tip"', 'child link="arm"', "10: joint 'reach': child 'arm' hangs on joint 'turn'"),
        ('parent link="base"', 'parent link="tip"', "10: joint 'reach': parent 'arm' hangs on it; nothing"),
        ('<link name="tip"/>', '<link name="tip"/><link name="x"/>', "6: link 'x' hangs on nothing, as"),
        (REACH, '<mimic joint="trun"/>', "11: joint 'reach': mimic: 'trun' is no joint; did you mean turn?"),
        (REACH, '<mimic joint="reach"/>', "11: joint 'reach': mimic: it follows itself"),
        (REACH, '<mimic joint="turn" offset="x"/>', "11: joint 'reach': mimic: offset is 'x', not a number"),
        ("visual", "unseen", " it has nothing to see"),
        ("robot", "robo", "1: this is no URDF: <robo> where <robot> with links"),
        ("</robot>", "", " cannot be read as a URDF: no element found: line 13"),
    ],
)  # fmt: skip
def test_what_a_urdf_leaves_open_is_refused_at_its_line(
    written: str, instead: str, said: str, tmp_path: Path
) -> None:
    assert written in URDF
    (tmp_path / "lift.urdf").write_text(URDF.replace(written, instead), encoding="utf-8")
    (tmp_path / "lift.yaml").write_text("robot: lift\ntitle: A lift\nmodel: lift.urdf\n")
    with pytest.raises(InputError, match=re.escape(f"lift.urdf:{said}")):
        load_robot("lift.yaml", tmp_path)


def test_a_joint_that_follows_another_needs_no_range_of_its_own(tmp_path: Path) -> None:
    (tmp_path / "lift.urdf").write_text(URDF.replace(REACH, '<mimic joint="turn"/>'), encoding="utf-8")
    (tmp_path / "lift.yaml").write_text("robot: lift\ntitle: A lift\nmodel: lift.urdf\n")
    assert load_robot("lift.yaml", tmp_path).joint_names == ("turn",)


@pytest.mark.parametrize(
    ("follows", "lower", "upper", "velocity"),
    [
        ('<mimic joint="turn"/>', -1, 1.5, 2.5),
        ('<mimic joint="turn" multiplier="-0.1" offset="0.1"/>' + REACH, -1, 1, 2.5),
        ('<mimic joint="turn" multiplier="0.5"/>' + REACH, 0, 0.6, 2),
        ('<mimic joint="turn" multiplier="0" offset="0.2"/>' + REACH, -1, 1.5, 2.5),
    ],
)
def test_a_leader_goes_as_far_and_fast_as_those_that_follow_it_may(
    follows: str, lower: float, upper: float, velocity: float, tmp_path: Path
) -> None:
    (tmp_path / "lift.urdf").write_text(URDF.replace(REACH, follows), encoding="utf-8")
    (tmp_path / "lift.yaml").write_text("robot: lift\ntitle: A lift\nmodel: lift.urdf\n")
    (turn,) = load_robot("lift.yaml", tmp_path).joints
    assert (turn.lower, turn.upper, turn.max_velocity) == pytest.approx((lower, upper, velocity))


def test_a_home_beyond_what_followers_leave_is_refused_with_the_reason(tmp_path: Path) -> None:
    follows = '<mimic joint="turn" multiplier="0.5"/>' + REACH
    (tmp_path / "LIFT.URDF").write_text(URDF.replace(REACH, follows), encoding="utf-8")
    yaml = "robot: lift\ntitle: A lift\nmodel: LIFT.URDF\nhome: {turn: 0.9}\n"
    (tmp_path / "lift.yaml").write_text(yaml)
    with pytest.raises(InputError, match=r"lift\.yaml:4: .* 0 to 0\.6 rad; joints that follow it keep to"):
        load_robot("lift.yaml", tmp_path)


def test_a_follower_that_leaves_its_leader_no_room_is_refused(tmp_path: Path) -> None:
    follows = '<mimic joint="turn" offset="5"/>' + REACH
    (tmp_path / "lift.urdf").write_text(URDF.replace(REACH, follows), encoding="utf-8")
    (tmp_path / "lift.yaml").write_text("robot: lift\ntitle: A lift\nmodel: lift.urdf\n")
    with pytest.raises(InputError, match="joint 'reach' follows 'turn', but keeping to both their ranges"):
        load_robot("lift.yaml", tmp_path)


@pytest.mark.parametrize(
    ("line", "said"),
    [
        ("hoem: {turn: 1}", "4: hoem: is no field here; did you mean home?"),
        ("home: {turn: 3}", "4: home.turn: 3 is outside the joint's range, -1 to 1.5 rad"),
        ("velocities: {turn: 0}", "4: velocities.turn: Input should be greater than 0, not 0"),
        ("hands:\n  - arm\n  - tpi", "6: hands.1: 'tpi' is no link; did you mean tip?"),
        ("camera: {azimut_deg: 3}", "4: camera: 'azimut_deg' is no field here; did you mean azimuth_deg?"),
        ("relations: [{source: turn, target: raech, sign: 1}]", "4: relations.0.target: 'raech' is no joint"),
    ],
)
def test_what_a_robot_file_gets_wrong_is_refused_at_its_line(line: str, said: str, tmp_path: Path) -> None:
    (tmp_path / "lift.urdf").write_text(URDF, encoding="utf-8")
    (tmp_path / "lift.yaml").write_text(f"robot: lift\ntitle: A lift\nmodel: lift.urdf\n{line}\n")
    with pytest.raises(InputError, match=re.escape(f"lift.yaml:{said}")):
        load_robot("lift.yaml", tmp_path)


@pytest.mark.parametrize(
    ("joint", "said"),
    [
        ('<joint name="reach" type="slide"/>', "joint 'reach': a slide without a range; give range="),
        ('<joint name="turn" range="-1e9 1e9"/>', "joint 'turn': -1.74533e+07 rad is more than 10 turns"),
        ("<joint/>", "the joint of body 'arm' has no name; give it one"),
        ("", "it has nothing that moves"),
    ],
)
def test_what_an_mjcf_leaves_open_is_refused(joint: str, said: str, tmp_path: Path) -> None:
    body = f'<body name="arm">{joint}<geom size=".1"/></body>'
    (tmp_path / "lift.xml").write_text(f"<mujoco><worldbody>{body}</worldbody></mujoco>")
    (tmp_path / "lift.yaml").write_text("robot: lift\ntitle: A lift\nmodel: lift.xml\n")
    with pytest.raises(InputError, match=re.escape(f"lift.xml: {said}")):
        load_robot("lift.yaml", tmp_path)
