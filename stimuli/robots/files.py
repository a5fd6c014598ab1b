"""A user's own robot: an MJCF or URDF model, and one small YAML file beside it.

robot: my_robot
title: My robot
model: my_robot.urdf            # or MJCF; meshes by relative path, STL or OBJ
home: {shoulder: 0.4}           # rad or m; joints not named are at zero, or at the nearest limit
velocities: {shoulder: 2.0}     # per second, where the model has none or they should differ
hands: [wrist]
head: head
"""

from __future__ import annotations

import hashlib
import xml.etree.ElementTree as ET
from collections.abc import Mapping
from functools import partial
from pathlib import Path

import mujoco
import numpy as np
import yaml
from pydantic import BaseModel, ConfigDict, Field, ValidationError
from scipy.spatial.transform import Rotation

from stimuli.errors import InputError
from stimuli.robots.facts import LOOK, sources_sha256
from stimuli.robots.model import Joint, JointKind, Robot, Vector

KINDS: Mapping[int, JointKind] = {
    int(mujoco.mjtJoint.mjJNT_HINGE): "revolute",
    int(mujoco.mjtJoint.mjJNT_SLIDE): "prismatic",
}


class RobotFile(BaseModel):
    """What the YAML file says."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    robot: str
    title: str
    model: Path
    home: Mapping[str, float] = Field(default_factory=dict)
    velocities: Mapping[str, float] = Field(default_factory=dict)
    hands: tuple[str, ...] = ()
    head: str | None = None


def read_robot(path: Path) -> Robot:
    """The robot a YAML file describes. InputError where the file or its model cannot be used."""
    try:
        facts = RobotFile.model_validate(yaml.safe_load(path.read_text(encoding="utf-8")))
    except (OSError, yaml.YAMLError) as error:
        raise InputError(f"{path}: cannot be read as a robot file: {error}") from error
    except ValidationError as error:
        first = error.errors()[0]
        raise InputError(f"{path}: {'.'.join(map(str, first['loc']))}: {first['msg']}") from error
    source = path.parent / facts.model
    model = build(source).compile()
    velocities = {**_urdf_velocities(source), **facts.velocities}
    joints = _joints(model, source, velocities)
    names = {joint.name for joint in joints}
    for field, given in (("home", facts.home), ("velocities", facts.velocities)):
        unknown = sorted(set(given) - names)
        if unknown:
            raise InputError(
                f"{path}: {field}: {unknown[0]!r} is no joint. Known: {', '.join(sorted(names))}."
            )
    return Robot(
        name=facts.robot,
        title=facts.title,
        joints=joints,
        home={
            joint.name: facts.home.get(joint.name, min(max(0.0, joint.lower), joint.upper))
            for joint in joints
        },
        build=partial(build, source),
        hands=facts.hands,
        head=facts.head,
        sources=(str(facts.model),),
        sha256=_sha256(path, source),
    )


def build(source: Path) -> mujoco.MjSpec:
    """The model without lights and cameras, and without collision shapes where there are visible ones."""
    try:
        if source.suffix == ".urdf":
            spec = mujoco.MjSpec.from_string(_urdf_for_mujoco(source))
            spec.modelfiledir = str(source.parent)
        else:
            spec = mujoco.MjSpec.from_file(str(source))
        spec.compiler.boundmass = spec.compiler.boundinertia = 1e-4  # nothing is simulated
        spec.compile()
    except (OSError, ValueError, ET.ParseError) as error:
        raise InputError(
            f"{source}: MuJoCo cannot read this model: {error}. Meshes must be STL or OBJ, by relative path."
        ) from error
    for thing in (*spec.lights, *spec.cameras):
        spec.delete(thing)
    shown = [geom for geom in spec.geoms if not geom.contype and not geom.conaffinity]
    for geom in [geom for geom in spec.geoms if shown and (geom.contype or geom.conaffinity)]:
        spec.delete(geom)
    return spec


def _urdf_for_mujoco(source: Path) -> str:
    """The URDF, told to keep what is only to be seen and every link."""
    root = ET.parse(source).getroot()
    options = root.find("mujoco")
    options = ET.SubElement(root, "mujoco") if options is None else options
    compiler = options.find("compiler")
    compiler = ET.SubElement(options, "compiler") if compiler is None else compiler
    compiler.attrib.update(discardvisual="false", fusestatic="false", strippath="false")
    return ET.tostring(root, encoding="unicode")


def _urdf_velocities(source: Path) -> dict[str, float]:
    """Velocity limits, which MuJoCo does not keep."""
    if source.suffix != ".urdf":
        return {}
    limits = (
        (joint.get("name", ""), joint.find("limit")) for joint in ET.parse(source).getroot().iter("joint")
    )
    return {name: float(limit.get("velocity", "nan")) for name, limit in limits if limit is not None}


def _joints(model: mujoco.MjModel, source: Path, velocities: Mapping[str, float]) -> tuple[Joint, ...]:
    """Joints between links that move against each other; links fixed to one another count as one."""
    data = mujoco.MjData(model)
    data.qpos[:] = 0
    mujoco.mj_kinematics(model, data)
    joints = []
    for index in range(model.njnt):
        joint, child = model.joint(index), model.jnt_bodyid[index]
        if int(joint.type[0]) not in KINDS or model.body_jntnum[child] > 1 or np.any(joint.pos):
            raise InputError(
                f"{source}: joint {joint.name!r}: only hinges and slides through their link's origin can be "
                "used, one for each link. Give each joint a link of its own."
            )
        parent = model.body_weldid[model.body_parentid[child]]
        turn = data.xmat[parent].reshape(3, 3).T
        limited = bool(joint.limited[0])
        low, high = joint.range if limited else (-np.pi, np.pi)
        xyz = turn @ (data.xpos[child] - data.xpos[parent])
        rpy = Rotation.from_matrix(turn @ data.xmat[child].reshape(3, 3)).as_euler("xyz")
        joints.append(
            Joint(
                name=joint.name,
                parent=model.body(parent).name,
                child=model.body(child).name,
                kind=KINDS[int(joint.type[0])],
                origin_xyz=_vector(xyz),
                origin_rpy=_vector(rpy),
                axis=_vector(joint.axis),
                lower=float(low),
                upper=float(high),
                max_velocity=velocities.get(joint.name),
            )
        )
    return tuple(joints)


def _vector(values: np.ndarray[tuple[int, ...], np.dtype[np.float64]]) -> Vector:
    x, y, z = values.tolist()
    return x, y, z


def _sha256(path: Path, source: Path) -> str:
    """Hash of the two files, of every mesh and picture in the model's folder, and of the studio."""
    digest = hashlib.sha256(sources_sha256("robots/files.py", *LOOK).encode())
    seen = {".stl", ".obj", ".msh", ".mtl", ".png", ".xml"}
    assets = sorted(file for file in source.parent.rglob("*") if file.suffix.lower() in seen)
    for file in dict.fromkeys((path, source, *assets)):
        digest.update(file.read_bytes())
    return digest.hexdigest()
