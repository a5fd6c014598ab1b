"""A robot's links and joints as a MuJoCo model, and the meshes and materials that dress them."""

from __future__ import annotations

from collections.abc import Sequence

import mujoco
import numpy as np
from scipy.spatial.transform import Rotation

from stimuli.robots.facts import Facts
from stimuli.robots.model import Vector
from stimuli.robots.shapes import Mesh
from stimuli.trajectory import FloatArray

Material = tuple[str, Vector, float, float, float]  # name, colour, specular, shininess, emission

JOINT_TYPES = {"revolute": mujoco.mjtJoint.mjJNT_HINGE, "prismatic": mujoco.mjtJoint.mjJNT_SLIDE}


def skeleton(name: str, facts: Facts) -> mujoco.MjSpec:
    """Bare links and joints, one body a link; dimensionless joints drive others and have no link here."""
    spec = mujoco.MjSpec()
    spec.modelname = name
    spec.compiler.degree = False
    spec.compiler.boundmass = spec.compiler.boundinertia = 1e-4  # links without a visible part
    spec.worldbody.add_body(name=facts.base.link, pos=facts.base.xyz)
    for joint in facts.joints:
        if joint.kind != "dimensionless":
            body = add_link(spec, joint.parent, joint.child, xyz=joint.xyz, rpy=joint.rpy)
            body.add_joint(
                name=joint.name,
                type=JOINT_TYPES[joint.kind],
                axis=joint.axis,
                range=[joint.lower, joint.upper],
                limited=True,
            )
    return spec


def add_link(spec: mujoco.MjSpec, parent: str, child: str, *, xyz: Vector, rpy: Vector) -> mujoco.MjsBody:
    """A new body fixed in another; roll, pitch, yaw about fixed axes as in URDF."""
    return spec.body(parent).add_body(name=child, pos=xyz, quat=quaternion(rpy))


def quaternion(rpy: Vector) -> FloatArray:
    """Rotation as MuJoCo writes it: (w, x, y, z)."""
    wxyz: FloatArray = np.asarray(Rotation.from_euler("xyz", rpy).as_quat(scalar_first=True))
    return wxyz


def add_materials(spec: mujoco.MjSpec, materials: Sequence[Material]) -> None:
    """Name what links are made of."""
    for name, rgb, specular, shininess, emission in materials:
        spec.add_material(
            name=name, rgba=[*rgb, 1], specular=specular, shininess=shininess, emission=emission
        )


def dress(spec: mujoco.MjSpec, link: str, **looks: Mesh) -> None:
    """Give a link its visible meshes, one for each material named."""
    for material, mesh in looks.items():
        name = f"{link}_{material}"
        asset = spec.add_mesh(
            name=name,
            uservert=mesh.vertices.ravel().tolist(),
            userface=mesh.faces.ravel().tolist(),
            smoothnormal=True,
        )
        asset.inertia = mujoco.mjtMeshInertia.mjMESH_INERTIA_SHELL
        spec.body(link).add_geom(
            type=mujoco.mjtGeom.mjGEOM_MESH,
            meshname=name,
            material=material,
            contype=0,
            conaffinity=0,
            mass=0.01,
        )
