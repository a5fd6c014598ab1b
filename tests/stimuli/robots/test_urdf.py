"""URDFs as people have them: packages, meshes of three formats, joints that follow others."""

from __future__ import annotations

import re
import struct
from pathlib import Path

import collada
import mujoco
import numpy as np
import pytest
from scipy.spatial import ConvexHull

from stimuli.errors import InputError
from stimuli.relations import relations_of
from stimuli.rendering import Renderer
from stimuli.robots import load_robot
from stimuli.robots.model import Relation, Robot
from stimuli.scene import extent, pose

pytestmark = pytest.mark.filterwarnings("ignore:the matrix subclass")  # pycollada's own

CORNERS = np.array([[0, 0, 0], [0.2, 0, 0], [0, 0.2, 0], [0, 0, 0.4]])
FACES = ConvexHull(CORNERS).simplices
URDF = """\
<robot name="gripper">
  <link name="palm">{palm}</link>
  <link name="left">{finger}</link>
  <link name="right">{finger}</link>
  <link name="tip"><visual><geometry><sphere radius="0.02"/></geometry></visual></link>
  <joint name="grip" type="revolute"><parent link="palm"/><child link="left"/>
    <origin xyz="0 0.1 -0.5"/><axis xyz="1 0 0"/><limit lower="0" upper="1" velocity="1.5" effort="1"/>
  </joint>
  <joint name="follow" type="revolute"><parent link="palm"/><child link="right"/>
    <origin xyz="0 -0.1 -0.5"/><axis xyz="1 0 0"/><limit lower="-2" upper="2" velocity="0" effort="1"/>
    <mimic joint="grip" multiplier="-2" offset="0.1"/></joint>
  <joint name="bend" type="continuous"><parent link="right"/><child link="tip"/>
    <origin xyz="0 0 -0.3"/><axis xyz="1 0 0"/></joint>
</robot>
"""
YAML = """\
robot: gripper
title: A gripper
model: gripper.urdf
"""


def visual(filename: str, scale: float = 1.0) -> str:
    shape = f'<mesh filename="{filename}" scale="{scale} {scale} {scale}"/>'
    return f"<visual><geometry>{shape}</geometry></visual>"


def binary_stl() -> bytes:
    facets = (struct.pack("<12fH", 0, 0, 0, *CORNERS[face].ravel(), 0) for face in FACES)
    return bytes(80) + struct.pack("<I", len(FACES)) + b"".join(facets)


def text_stl() -> bytes:
    facets = []
    for face in FACES:
        vertices = "".join("vertex {} {} {}\n".format(*corner) for corner in CORNERS[face])
        facets.append(f"facet normal 0 0 0\nouter loop\n{vertices}endloop\nendfacet\n")
    return f"solid tetrahedron\n{''.join(facets)}endsolid\n".encode()


def obj() -> bytes:
    lines = ["v {} {} {}".format(*corner) for corner in CORNERS]
    return "\n".join([*lines, *("f {} {} {}".format(*face) for face in FACES + 1)]).encode()


def write_dae(path: Path) -> None:
    """The tetrahedron twice, in centimetres: a red one, and a blue one moved 1 m up by its node."""
    document = collada.Collada()
    document.assetInfo.unitmeter, document.assetInfo.unitname = 0.01, "centimeter"
    nodes = []
    for name, colour, up in (("red", (1, 0, 0), 0), ("blue", (0, 0, 1), 100)):
        effect = collada.material.Effect(f"{name}-effect", [], "phong", diffuse=colour)
        material = collada.material.Material(f"{name}-material", name, effect)
        document.effects.append(effect)
        document.materials.append(material)
        points = collada.source.FloatSource("points", 100 * CORNERS.ravel(), ("X", "Y", "Z"))
        geometry = collada.geometry.Geometry(document, name, name, [points])
        inputs = collada.source.InputList()
        inputs.addInput(0, "VERTEX", "#points")
        geometry.primitives.append(geometry.createTriangleSet(FACES.ravel(), inputs, name))
        document.geometries.append(geometry)
        bound = collada.scene.GeometryNode(geometry, [collada.scene.MaterialNode(name, material, inputs=[])])
        moved = collada.scene.TranslateTransform(0, 0, up)
        nodes.append(collada.scene.Node(name, children=[bound], transforms=[moved]))
    scene = collada.scene.Scene("scene", nodes)
    document.scenes.append(scene)
    document.scene = scene
    with path.open("wb") as file:
        document.write(file)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A package with a mesh of each kind, beside the folder of the robot."""
    meshes = tmp_path / "descriptions" / "gripper_description" / "meshes"
    meshes.mkdir(parents=True)
    for name, data in (("a.stl", binary_stl()), ("text.STL", text_stl()), ("a.obj", obj())):
        (meshes / name).write_bytes(data)
    write_dae(meshes / "a.dae")
    (tmp_path / "robots").mkdir()
    return tmp_path / "robots"


def load(folder: Path, mesh: str, *, more: str = "search: [../descriptions]\n", scale: float = 1.0) -> Robot:
    shape = visual(f"package://gripper_description/meshes/{mesh}", scale)
    (folder / "gripper.urdf").write_text(URDF.format(palm=shape, finger=visual(mesh_beside(folder))))
    (folder / "gripper.yaml").write_text(YAML + more)
    return load_robot("gripper.yaml", folder)


def mesh_beside(folder: Path) -> str:
    (folder / "finger.obj").write_bytes(obj())
    return "finger.obj"


def of_the_palm(model: mujoco.MjModel) -> np.ndarray:
    return np.flatnonzero(model.body_weldid[model.geom_bodyid] == 0)


@pytest.mark.parametrize("mesh", ["a.stl", "text.STL", "a.obj", "a.dae"])
def test_meshes_come_from_packages_in_their_size(mesh: str, folder: Path) -> None:
    model = load(folder, mesh, scale=0.5).build().compile()
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    corners = []
    for geom in of_the_palm(model):
        mesh_id = model.geom_dataid[geom]
        points = model.mesh_vert[model.mesh_vertadr[mesh_id] :][: model.mesh_vertnum[mesh_id]]
        corners.append(data.geom_xpos[geom] + points @ data.geom_xmat[geom].reshape(3, 3).T)
    size = np.ptp(np.concatenate(corners), axis=0)
    up = 0.5 * (1.4 if mesh == "a.dae" else 0.4)
    np.testing.assert_allclose(size, [0.1, 0.1, up], atol=1e-5)


def test_a_collada_mesh_keeps_the_colours_of_its_materials(folder: Path) -> None:
    model = load(folder, "a.dae").build().compile()
    colours = {tuple(np.round(model.geom_rgba[geom], 3)) for geom in of_the_palm(model)}
    assert colours == {(1, 0, 0, 1), (0, 0, 1, 1)}


def test_a_package_above_the_model_is_found_without_being_named(folder: Path) -> None:
    package = folder.parent / "descriptions" / "gripper_description"
    (package / "urdf").mkdir()
    assert load(package / "urdf", "a.stl", more="").joint_names == ("grip", "bend")


@pytest.mark.parametrize(
    ("mesh", "more", "said"),
    [
        ("b.stl", "search: [../descriptions]\n", "is not in the package: .*b.stl"),
        ("a.stl", "", "there is no folder 'gripper_description' in .*`search: [PATH]`"),
        ("a.blend", "search: [../descriptions]\n", ".blend is no known mesh; .stl, .obj and .dae are"),
        (
            "empty.stl",
            "search: [../descriptions]\n",
            "empty.stl: cannot be read as a mesh: it holds no triangles",
        ),
        ("bad.dae", "search: [../descriptions]\n", "bad.dae: cannot be read as a mesh"),
    ],
)
def test_a_mesh_that_cannot_be_used_is_named(mesh: str, more: str, said: str, folder: Path) -> None:
    meshes = folder.parent / "descriptions" / "gripper_description" / "meshes"
    for name in ("a.blend", "empty.stl", "bad.dae"):
        (meshes / name).write_bytes(b"solid nothing")
    with pytest.raises(InputError, match=re.escape(said).replace(r"\.\*", ".*")):
        load(folder, mesh, more=more)


def test_a_joint_that_mimics_follows_and_is_not_moved_by_itself(folder: Path) -> None:
    robot = load(folder, "a.stl")
    assert robot.joint_names == ("grip", "bend")
    assert [joint.max_velocity for joint in robot.joints] == [1.5, None]
    model = robot.build().compile()
    data = mujoco.MjData(model)
    pose(model, data, robot, {"grip": 0.4, "bend": 0.0})
    assert data.joint("follow").qpos[0] == pytest.approx(-0.7)
    with pytest.raises(
        InputError, match=r"home\.follow: 'follow' is no joint that moves by itself; known: grip, bend"
    ):
        load(folder, "a.stl", more="search: [../descriptions]\nhome: {follow: 0.1}\n")


def test_a_model_with_its_origin_in_the_torso_stands_on_the_floor(folder: Path) -> None:
    robot = load(folder, "a.stl")
    lowest, highest = extent(robot.build().compile(), robot)
    assert lowest == pytest.approx(0, abs=0.03)
    assert highest > 0.8


def test_look_relations_camera_and_home_are_what_the_file_says(folder: Path) -> None:
    more = """\
search: [../descriptions]
home: {grip: 0.3}
relations: [{source: grip, target: bend, sign: -1}]
camera: {azimuth_deg: 90}
look: {left: "#ff0000"}
"""
    plain, own = load(folder, "a.stl"), load(folder, "a.stl", more=more)
    assert own.sha256 != plain.sha256
    assert own.home == {"grip": 0.3, "bend": 0.0}
    assert relations_of(own, own.joint_names) == (Relation("grip", "bend", -1),)
    frames = []
    for robot in (plain, own):
        with Renderer(robot, width=64, height=64, camera="full_body") as renderer:
            frames.append(renderer.frame(robot.home).astype(int))
            side = renderer.model.camera("full_body").pos
    assert side[1] > 5 * abs(side[0])
    redness = [(frame[..., 0] - frame[..., 1]).max() for frame in frames]
    assert redness[0] < 30 < redness[1]
    for wrong, said in (
        ("look: {lfet: '#ff0000'}", "look.lfet: 'lfet' is no link; did you mean left"),
        ("home: {grip: 3}", "outside"),
    ):
        with pytest.raises(InputError, match=said):
            load(folder, "a.stl", more=f"search: [../descriptions]\n{wrong}\n")
