"""A user's own robot: a URDF or MJCF model, and what `stimuli.robots.robot_file` says of it."""

from __future__ import annotations

import hashlib
import inspect
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path

import mujoco
import numpy as np
from scipy.spatial.transform import Rotation

from stimuli.errors import InputError
from stimuli.outline import placed, places, vertices
from stimuli.robots.descriptions import PREFIX, find_description
from stimuli.robots.facts import LOOK, sources_sha256
from stimuli.robots.limits import Limits, beyond_belief
from stimuli.robots.mimics import Mimic, coupled, mimicked
from stimuli.robots.model import Joint, JointKind, Robot, Vector
from stimuli.robots.robot_file import Place, RobotFile, check_names, read_robot_file
from stimuli.robots.urdf import read_urdf

KINDS: Mapping[int, JointKind] = {
    int(mujoco.mjtJoint.mjJNT_HINGE): "revolute",
    int(mujoco.mjtJoint.mjJNT_SLIDE): "prismatic",
}
HALF_TURNS = (-np.pi, np.pi)  # of a hinge that turns without end
ANYWHERE = (-np.inf, np.inf)  # where a joint that follows may go, if it has no range
CODE = tuple(
    f"robots/{name}.py" for name in ("files", "robot_file", "urdf", "packages", "mimics", "limits", "meshes")
)


@dataclass(frozen=True)
class Body:
    """A model file, and how it is dressed and put on the floor."""

    source: Path
    search: tuple[Path, ...] = ()
    look: Mapping[str, str] = field(default_factory=dict)
    lift_m: float = 0.0


def read_robot(path: Path) -> Robot:
    """The robot a YAML file describes. InputError where the file or its model cannot be used."""
    facts, place = read_robot_file(path)
    return robot_from(facts, place, path.parent)


def described_robot(name: str) -> Robot:
    """A robot of the package `robot_descriptions`, as it comes."""
    title = name.removeprefix(PREFIX).removesuffix("_description").removesuffix("_mj").replace("_", " ")
    return robot_from(RobotFile(robot=name, title=title, model=name), lambda _: name, Path())


def robot_from(facts: RobotFile, place: Place, folder: Path) -> Robot:
    """The robot with these facts, written at this place; its model's path is relative to the folder."""
    if facts.model.startswith(PREFIX):
        found = find_description(facts.model)
        source, search, origin = found.model, found.search, found.origin
    else:
        source, search, origin = folder / facts.model, (), facts.model
    body = Body(source, (*(folder / other for other in facts.search), *search))
    urdf = read_urdf(source, body.search) if source.suffix.lower() == ".urdf" else None
    spec = build(body)
    model = spec.compile()
    mimics = urdf.mimics if urdf else coupled(model, source)
    every = _joints(model, source, {**(urdf.velocities if urdf else {}), **facts.velocities}, mimics)
    if not every or not model.ngeom:
        raise InputError(f"{source}: it has nothing {'to see' if every else 'that moves'}")
    links = [model.body(index).name for index in range(model.nbody)]
    check_names(facts, [joint.name for joint in every], links, place)
    home = {j.name: facts.home.get(j.name, min(max(0.0, j.lower), j.upper)) for j in every}
    for joint in every:
        if not joint.lower <= home[joint.name] <= joint.upper:
            led = any(mimic.joint == joint.name for mimic in mimics.values())
            why = "; joints that follow it keep to theirs" if led else ""
            raise InputError(
                f"{place(('home', joint.name))}: {home[joint.name]:g} is outside the joint's range, "
                f"{joint.lower:g} to {joint.upper:g} {joint.unit}{why}"
            )
    body = replace(body, look=facts.look, lift_m=-_lowest(model, mimicked(home, mimics)))
    return Robot(
        name=facts.robot,
        title=facts.title,
        joints=every,
        home=home,
        build=partial(build, body),
        qpos=partial(mimicked, mimics=mimics) if mimics else dict,
        relations=facts.relations,
        hands=facts.hands,
        head=facts.head,
        view=facts.camera,
        sources=(origin,),
        sha256=_sha256(facts, spec, model),
    )


def build(body: Body) -> mujoco.MjSpec:
    """The model alone: no lights, cameras or floor, no collision shapes where there are visible ones."""
    source = body.source
    mujoco.mj_clearCache(mujoco.mj_getCache())  # it tells a changed mesh by the second alone
    try:
        if source.suffix.lower() == ".urdf":
            urdf = read_urdf(source, body.search)
            spec = mujoco.MjSpec.from_string(urdf.xml, assets=dict(urdf.meshes))
        else:
            spec = mujoco.MjSpec.from_file(str(source))
        spec.compiler.boundmass = spec.compiler.boundinertia = 1e-4  # nothing is simulated
        spec.compile()
    except (OSError, ValueError) as error:
        reason = " ".join(str(error).split())
        raise InputError(
            f"{source}: MuJoCo cannot read this model: {reason}. It must be a URDF, or an MJCF with "
            "meshes in STL or OBJ."
        ) from error
    shown = [geom for geom in spec.geoms if not geom.contype and not geom.conaffinity]
    hidden = [geom for geom in spec.geoms if shown and (geom.contype or geom.conaffinity)]
    floors = [geom for geom in spec.worldbody.geoms if geom.type == mujoco.mjtGeom.mjGEOM_PLANE]
    free = [joint for joint in spec.joints if joint.type == mujoco.mjtJoint.mjJNT_FREE]
    for thing in (*spec.lights, *spec.cameras, *spec.keys, *free, *dict.fromkeys((*hidden, *floors))):
        spec.delete(thing)
    for link, colour in body.look.items():
        for geom in spec.body(link).geoms:
            geom.material = ""
            geom.rgba = [*(int(colour[at : at + 2], 16) / 255 for at in (1, 3, 5)), 1.0]
    for thing in (*spec.worldbody.bodies, *spec.worldbody.geoms):
        thing.pos = thing.pos + np.array([0.0, 0.0, body.lift_m])
    return spec


def _lowest(model: mujoco.MjModel, positions: Mapping[str, float]) -> float:
    """Height of the lowest visible point: robots stand on the floor, wherever their model has its origin."""
    data = mujoco.MjData(model)
    for name, value in positions.items():
        data.joint(name).qpos[0] = value
    mujoco.mj_kinematics(model, data)
    where = places(data)
    return min((placed(vertices(model, k), where[k])[:, 2].min() for k in range(model.ngeom)), default=0.0)


def _joints(
    model: mujoco.MjModel, source: Path, velocities: Mapping[str, float], mimics: Mapping[str, Mimic]
) -> tuple[Joint, ...]:
    """Joints between links that move against each other; links fixed to one another count as one.

    Joints that follow others are none of their own: below them links count as fixed.
    """
    data = mujoco.MjData(model)
    data.qpos[:] = 0
    mujoco.mj_kinematics(model, data)
    joints = []
    led = {model.jnt_bodyid[model.joint(name).id] for name in mimics}
    for index in range(model.njnt):
        joint, child = model.joint(index), model.jnt_bodyid[index]
        if not joint.name:
            raise InputError(
                f"{source}: the joint of body {model.body(child).name!r} has no name; give it one"
            )
        if joint.name in mimics:
            continue
        if int(joint.type[0]) not in KINDS or model.body_jntnum[child] > 1 or np.any(joint.pos):
            raise InputError(
                f"{source}: joint {joint.name!r}: only hinges and slides through their link's origin can be "
                "used, one for each link. Give each joint a link of its own."
            )
        parent = model.body_weldid[model.body_parentid[child]]
        while parent in led:
            parent = model.body_weldid[model.body_parentid[parent]]
        turn = data.xmat[parent].reshape(3, 3).T
        kind = KINDS[int(joint.type[0])]
        if kind == "prismatic" and not joint.limited[0]:
            raise InputError(
                f'{source}: joint {joint.name!r}: a slide without a range; give range="LOWER UPPER", in m'
            )
        limits = _limits(model, joint.name, velocities, HALF_TURNS)
        if problem := beyond_belief(kind, limits):
            raise InputError(f"{source}: joint {joint.name!r}: {problem}")
        for follower in (name for name, mimic in mimics.items() if mimic.joint == joint.name):
            own = _limits(model, follower, velocities, ANYWHERE)
            limits = limits.and_also(own.of_leader(mimics[follower]))
            if limits.lower >= limits.upper:
                raise InputError(
                    f"{source}: joint {follower!r} follows {joint.name!r}, but keeping to both their ranges "
                    "neither can move; mend the ranges, or how it follows"
                )
        xyz = turn @ (data.xpos[child] - data.xpos[parent])
        rpy = Rotation.from_matrix(turn @ data.xmat[child].reshape(3, 3)).as_euler(
            "xyz", suppress_warnings=True
        )
        joints.append(
            Joint(
                name=joint.name,
                parent=model.body(parent).name,
                child=model.body(child).name,
                kind=kind,
                origin_xyz=_vector(xyz),
                origin_rpy=_vector(rpy),
                axis=_vector(joint.axis),
                lower=limits.lower,
                upper=limits.upper,
                max_velocity=limits.velocity,
            )
        )
    return tuple(joints)


def _limits(
    model: mujoco.MjModel, name: str, velocities: Mapping[str, float], unlimited: tuple[float, float]
) -> Limits:
    joint = model.joint(name)
    lower, upper = map(float, joint.range if joint.limited[0] else unlimited)
    return Limits(lower, upper, velocities.get(name))


def _vector(values: np.ndarray[tuple[int, ...], np.dtype[np.float64]]) -> Vector:
    x, y, z = values.tolist()
    return x, y, z


def _sha256(facts: RobotFile, spec: mujoco.MjSpec, model: mujoco.MjModel) -> str:
    """Hash of what the file says, of all MuJoCo read, meshes and pictures too, and of the studio."""
    digest = hashlib.sha256(sources_sha256(*CODE, *LOOK).encode())
    digest.update(facts.model_dump_json(exclude={"search"}).encode())
    digest.update(spec.to_xml().encode())
    for name, value in inspect.getmembers(model, lambda value: isinstance(value, np.ndarray)):
        if not name.startswith("_") and not name.endswith("_pathadr"):  # these count letters of files' paths
            digest.update(value.tobytes())
    return digest.hexdigest()
