"""A study is the folder of its protocol: all it is made of lies there, is hashed and is kept."""

from __future__ import annotations

import os
from pathlib import Path

import mujoco
import pytest

from stimuli.robots import load_robot
from study.protocol import ProtocolError
from study.specs import robot_titles
from study.versions import copy_protocol, refuse_undeclared

URDF = """\
<robot name="two">
  <link name="foot"><visual><geometry><mesh filename="package://arm/foot.obj"/></geometry></visual></link>
  <link name="arm"><visual><geometry><sphere radius="0.1"/></geometry></visual></link>
  <joint name="lift" type="revolute"><parent link="foot"/><child link="arm"/>
    <axis xyz="0 1 0"/><limit lower="-1" upper="1" velocity="2" effort="1"/></joint>
</robot>
"""
MJCF = """\
<mujoco><compiler meshdir="{}" angle="radian"/><asset><mesh name="arm" file="foot.obj"/></asset>
<worldbody><include file="more/arm.xml"/></worldbody></mujoco>
"""
ARM = """\
<mujoco><body name="arm"><joint name="lift" axis="0 1 0" range="-1 1" limited="true"/>
<geom type="mesh" mesh="arm"/></body></mujoco>
"""
TETRAHEDRON = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"
OF_URDF = ("robots/arm.yaml", "robots/two.urdf", "robots/arm/foot.obj")
OF_MJCF = ("robots/arm.yaml", "robots/two.xml", "robots/arm/foot.obj", "robots/more/arm.xml")


@pytest.fixture
def own(tmp_path: Path, written):
    """The paper's study with a robot of one's own."""
    for name, text in {
        "arm/foot.obj": TETRAHEDRON,
        "more/arm.xml": ARM,
        "two.urdf": URDF,
        "two.xml": MJCF.format("arm"),
        "arm.yaml": "robot: two\ntitle: Two links\nmodel: two.urdf\n",
    }.items():
        file = tmp_path / "robots" / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text)
    return written | {"robot": "robots/arm.yaml"}


def of_model(folder: Path, model: str) -> None:
    (folder / "robots" / "arm.yaml").write_text(f"robot: two\ntitle: Two links\nmodel: {model}\n")


@pytest.mark.parametrize(("model", "files"), [("two.urdf", OF_URDF), ("two.xml", OF_MJCF)])
def test_a_change_in_any_file_of_a_robot_is_a_change_of_the_study(own, load, tmp_path, model, files):
    of_model(tmp_path, model)
    assert load_robot("robots/arm.yaml", tmp_path).joint_names == ("lift",)
    begun = load(own)
    assert robot_titles(begun) == ["Two links"]
    known = {begun.sha256}
    assert set(begun.files_of_robot("robots/arm.yaml")) == set(files)
    copy_protocol(begun, tmp_path / "kept")
    for file in files:
        before = (tmp_path / file).read_bytes()
        assert (tmp_path / "kept" / file).read_bytes() == before
        (tmp_path / file).write_bytes(before + b"\n")
        with pytest.raises(ProtocolError, match="has changed since participants took part"):
            refuse_undeclared(load(own), known)
        (tmp_path / file).write_bytes(before)
    refuse_undeclared(load(own), known)


@pytest.mark.parametrize(
    ("model", "include"),
    [
        (MJCF.format("arm"), "arm.xml"),
        (MJCF.format("arm").replace("arm.xml", "arm.inc"), "arm.inc"),
        (MJCF.format("nowhere/../arm").replace("more/arm.xml", "more\\\\arm"), "arm"),
    ],
)
def test_every_file_that_mujoco_would_read_is_among_them(own, load, tmp_path, model, include):
    of_model(tmp_path, "two.xml")
    (tmp_path / "robots" / "two.xml").write_text(model)
    (tmp_path / "robots" / "more" / "arm.xml").rename(tmp_path / "robots" / "more" / include)
    assert load_robot("robots/arm.yaml", tmp_path).joint_names == ("lift",)
    read = mujoco.mju_getXMLDependencies(str(tmp_path / "robots" / "two.xml"))
    files = load(own).files_of_robot("robots/arm.yaml")
    assert {os.path.relpath(file, tmp_path) for file in read} <= set(files)
    assert len(read) > 1


@pytest.mark.parametrize(
    ("robot", "meshes", "message"),
    [
        ("../robots/arm.yaml", "arm", "'../robots/arm.yaml' leaves the study's folder; copy it there"),
        ("robots/arm.yaml", "../../arm", "needs ../arm/foot.obj, which leaves the study's folder"),
    ],
)
def test_robots_outside_the_folder_are_refused(own, load, tmp_path, robot, meshes, message):
    of_model(tmp_path, "two.xml")
    (tmp_path / "robots" / "arm").rename(tmp_path.parent / "arm")
    (tmp_path / "robots" / "two.xml").write_text(MJCF.format(meshes))
    with pytest.raises(ProtocolError) as refused:
        load(own | {"robot": robot})
    (problem,) = refused.value.problems
    assert problem.field == "robot" and message in problem.message
    (tmp_path.parent / "arm").rename(tmp_path / "robots" / "arm")


@pytest.mark.parametrize(
    ("mesh", "remedy"),
    [
        ("file://{0}/robots/arm/foot.obj", "as seen from the model"),
        ("package://{0.name}/robots/arm/foot.obj", "put"),
    ],
)
def test_names_that_lead_elsewhere_in_a_copy_are_refused(own, load, tmp_path, mesh, remedy):
    name = mesh.format(tmp_path)
    (tmp_path / "robots" / "two.urdf").write_text(URDF.replace("package://arm/foot.obj", name))
    with pytest.raises(ProtocolError) as refused:
        load(own)
    (problem,) = refused.value.problems
    assert problem.field == "robot" and f"names {name}, which in a copy" in problem.message
    assert remedy in problem.message


def test_a_shape_that_is_not_drawn_need_not_be_there(own, load, tmp_path):
    collision = '<collision><geometry><mesh filename="package://arm/hull.obj"/></geometry></collision></link>'
    (tmp_path / "robots" / "two.urdf").write_text(URDF.replace("</link>", collision, 1))
    (tmp_path / "robots" / "arm" / "hull.obj").write_text(TETRAHEDRON)
    assert load(own).files_of_robot("robots/arm.yaml") == OF_URDF


def test_a_link_in_the_folder_is_taken_for_what_it_leads_to(own, load, tmp_path):
    before = load(own).sha256
    meshes = tmp_path / "robots" / "arm"
    meshes.rename(tmp_path.parent / "linked")
    meshes.symlink_to(tmp_path.parent / "linked")
    assert load_robot("robots/arm.yaml", tmp_path).joint_names == ("lift",)
    assert load(own).sha256 == before


def test_a_robot_that_cannot_be_read_is_no_reason_not_to_read_the_protocol(own, load, tmp_path):
    (tmp_path / "robots" / "two.urdf").write_text("<robot")
    assert load(own).files_of_robot("robots/arm.yaml") == ("robots/arm.yaml", "robots/two.urdf")
    (tmp_path / "robots" / "arm.yaml").write_text("robot: [")
    assert load(own).files_of_robot("robots/arm.yaml") == ("robots/arm.yaml",)
    assert load(own | {"robot": "robots/none.yaml"}).files_of_robot("robots/none.yaml") == (
        "robots/none.yaml",
    )


def test_files_outside_the_folder_are_refused_as_no_copy_of_the_study_would_have_them(load, written):
    written["gestures"]["wave"] = "../shared/wave.yaml"
    written["texts"] = {"consent": {"en": "../shared/consent.md", "de": "/shared/consent.md"}}
    with pytest.raises(ProtocolError) as refused:
        load(written)
    assert [p.field for p in refused.value.problems] == [
        "gestures.wave", "texts.consent.en", "texts.consent.de"
    ]  # fmt: skip
    assert all("leaves the study's folder; copy it there" in p.message for p in refused.value.problems)


def test_absolute_paths_are_refused_as_another_machine_would_not_have_them(load, written, tmp_path):
    written["gestures"]["wave"] = str(tmp_path / "wave.yaml")
    written["robot"] = str(tmp_path / "robot.yaml")
    with pytest.raises(ProtocolError) as refused:
        load(written)
    assert [problem.field for problem in refused.value.problems] == ["robot", "gestures.wave"]
