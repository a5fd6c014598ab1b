"""The studio every clip is filmed in: a seamless neutral cove, soft light, a contact shadow, camera presets.

Lights cast no shadows: at video size shadow maps leave jagged edges and acne, and they double the time of a
frame without a GPU. The robot's contact shadow is painted on the floor under its base instead.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import mujoco
import numpy as np
from scipy.spatial.transform import Rotation

from stimuli.outline import placed, places, vertices
from stimuli.robots.model import Robot, View
from stimuli.robots.shapes import lathe
from stimuli.robots.skeleton import dress
from stimuli.trajectory import FloatArray

PRESETS: Mapping[str, tuple[float, float]] = {
    "head": (0.70, 1.10),
    "upper_body": (0.33, 1.18),
    "full_body": (-0.06, 1.18),
    "wide": (-0.45, 1.75),
}
"""Lower and upper edge of the picture at the robot's distance, in heights of the robot; closest first."""

FOVY_DEG = 24.0
FORESHORTENING = (
    0.17  # how much lower the near edge of a foot appears, in its radii, for the camera's nearness
)
BACKDROP = (0.82, 0.82, 0.82)
SHADOW = "contact_shadow"  # the name of its patch of floor
STANDS_M = 0.01  # a link this near to the floor stands on it

LIGHTS = (  # direction it shines in, diffuse, specular
    ((-0.55, -0.38, -0.74), 0.42, 0.30),  # key, from the front, above and the robot's left
    ((-0.55, 0.75, -0.30), 0.15, 0.06),  # fill
    ((0.80, -0.30, -0.45), 0.16, 0.20),  # rim, from behind
)


def studio(robot: Robot, *, width: int, height: int) -> mujoco.MjModel:
    """The robot in the studio, with a camera for each preset that suits the picture's shape."""
    spec = robot.build()
    bare = spec.compile()
    foot, (_, height_m), reach_m = find_foot(bare, robot), extent(bare, robot), reach(bare, robot)
    add_light(spec)
    add_cove(spec)
    add_contact_shadow(spec, foot)
    near = foot.radius * (np.sin(np.radians(robot.view.elevation_deg)) + FORESHORTENING) / height_m
    for name, (lower, top) in PRESETS.items():
        bottom = min(lower, -near) if lower < 0 else lower
        tall = height_m * (top - bottom)
        wide = tall if name == "head" else height_m * 1.2
        if lower < 0:  # a robot that lies down is longer than it is high
            wide = max(wide, 2 * reach_m * (top - lower))
        shown = max(tall, wide * height / width)
        add_camera(spec, name, robot.view, middle=height_m * (bottom + top) / 2, tall=shown)
    spec.visual.global_.offwidth = width
    spec.visual.global_.offheight = height
    return spec.compile()


def pose(model: mujoco.MjModel, data: mujoco.MjData, robot: Robot, positions: Mapping[str, float]) -> None:
    """Put the robot into a pose and compute where every part then is."""
    for name, value in robot.qpos(positions).items():
        data.joint(name).qpos[0] = value
    mujoco.mj_kinematics(model, data)
    mujoco.mj_camlight(model, data)


def extent(model: mujoco.MjModel, robot: Robot) -> tuple[float, float]:
    """Height of the robot's lowest and of its highest point at home, in metres."""
    heights = np.concatenate([part[:, 2] for part in at_home(model, robot)[1]])
    return float(heights.min()), float(heights.max())


def reach(model: mujoco.MjModel, robot: Robot) -> float:
    """How far the robot reaches sideways from above its origin at home, in metres."""
    return max(float(np.linalg.norm(part[:, :2], axis=1).max()) for part in at_home(model, robot)[1])


@dataclass(frozen=True)
class Foot:
    """Where the robot meets the floor: on one link, or on several, which then stay where they are."""

    link: str  # "world" where several links stand
    middle: FloatArray  # (3,) on the floor, in the link's frame
    radius: float  # m


def find_foot(model: mujoco.MjModel, robot: Robot) -> Foot:
    """The links whose lowest point is on the floor at home, and the footprint of their lowest 10 cm."""
    data, parts = at_home(model, robot)
    lowest = np.array([part[:, 2].min() for part in parts])
    standing = np.unique(model.geom_bodyid[lowest < lowest.min() + STANDS_M])
    points = np.vstack([part for part, of in zip(parts, model.geom_bodyid, strict=True) if of in standing])
    body = standing[0] if len(standing) == 1 else 0
    footprint = points[points[:, 2] < 0.10][:, :2]
    middle = np.append((footprint.min(axis=0) + footprint.max(axis=0)) / 2, 0.0)
    turn = data.xmat[body].reshape(3, 3)
    return Foot(
        model.body(body).name, turn.T @ (middle - data.xpos[body]), float(np.ptp(footprint, axis=0).max() / 2)
    )


def at_home(model: mujoco.MjModel, robot: Robot) -> tuple[mujoco.MjData, list[FloatArray]]:
    """The robot's state at home, and the points (n, 3) of each of its geoms in the world."""
    data = mujoco.MjData(model)
    pose(model, data, robot, robot.home)
    where = places(data)
    return data, [placed(vertices(model, geom), where[geom]) for geom in range(model.ngeom)]


def add_light(spec: mujoco.MjSpec) -> None:
    """Even light from all sides, and a key, a fill and a rim light."""
    spec.visual.headlight.ambient = [0.40] * 3
    spec.visual.headlight.diffuse = [0.12] * 3
    spec.visual.headlight.specular = [0.04] * 3
    for direction, diffuse, specular in LIGHTS:
        spec.worldbody.add_light(
            type=mujoco.mjtLightType.mjLIGHT_DIRECTIONAL,
            dir=np.array(direction) / np.linalg.norm(direction),
            diffuse=[diffuse] * 3,
            specular=[specular] * 3,
            ambient=[0] * 3,
            castshadow=False,
        )


def add_cove(spec: mujoco.MjSpec) -> None:
    """A floor that bends up into a wall without a seam, 5.5 m from the robot."""
    bend = np.linspace(0, np.pi / 2, 12)
    curve = [(2.5 + 3.0 * np.sin(a), 3.0 - 3.0 * np.cos(a)) for a in bend]
    spec.add_material(name="cove", rgba=[*BACKDROP, 1], specular=0, shininess=0)
    body = spec.worldbody.add_body(name="cove", pos=[0, 0, -0.002])
    cove = lathe([(0.05, 0.0), *curve, (5.5, 7.0)], 72)
    dress(spec, body.name, cove=type(cove)(cove.vertices, cove.faces[:, ::-1]))


def add_contact_shadow(spec: mujoco.MjSpec, foot: Foot) -> None:
    """Soft darkness on the floor, carried by the link that stands there.

    A texture on a patch of floor, and at the patch's edge exactly the floor's own colour.
    """
    size, pixels = 5.5 * foot.radius, 256
    grid = np.linspace(-size, size, pixels) / foot.radius
    distance = np.hypot(*np.meshgrid(grid, grid))
    shade = 0.34 * np.exp(-((distance / 1.25) ** 4)) + 0.20 * np.exp(-((distance / 2.1) ** 2))
    image = np.repeat(np.rint(255 * (1 - shade)).astype(np.uint8).reshape(-1, 1), 3, axis=1)
    texture = mujoco.mjtTexture.mjTEXTURE_2D
    spec.add_texture(
        name=SHADOW, type=texture, width=pixels, height=pixels, nchannel=3, data=image.ravel().tolist()
    )
    material = spec.add_material(name=SHADOW, rgba=[*BACKDROP, 1], specular=0, shininess=0)
    material.textures[mujoco.mjtTextureRole.mjTEXROLE_RGB] = SHADOW
    corners = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]])
    patch = spec.add_mesh(
        name=SHADOW,
        uservert=(foot.middle + np.pad(size * corners, ((0, 0), (0, 1)))).ravel().tolist(),
        userface=[0, 1, 2, 0, 2, 3],
        usertexcoord=((corners + 1) / 2).ravel().tolist(),
    )
    patch.inertia = mujoco.mjtMeshInertia.mjMESH_INERTIA_SHELL
    spec.body(foot.link).add_geom(
        name=SHADOW,
        type=mujoco.mjtGeom.mjGEOM_MESH,
        meshname=SHADOW,
        material=SHADOW,
        contype=0,
        conaffinity=0,
        mass=0.01,
    )


def add_camera(spec: mujoco.MjSpec, name: str, view: View, *, middle: float, tall: float) -> None:
    """A camera that sees `tall` metres around the height `middle`, at the robot's distance."""
    turn = Rotation.from_euler("yz", [-view.elevation_deg, view.azimuth_deg], degrees=True)
    distance = tall / 2 / np.tan(np.radians(FOVY_DEG) / 2)
    position = turn.apply([distance, 0, 0]) + np.array([0, 0, middle])
    axes = turn.as_matrix()[:, [1, 2, 0]]  # right, up and backwards, as MuJoCo's cameras look along -z
    quat = Rotation.from_matrix(axes).as_quat(scalar_first=True)
    spec.worldbody.add_camera(name=name, pos=position, quat=quat, fovy=FOVY_DEG)
    spec.visual.map.znear = 0.1
    spec.visual.map.zfar = 30
    spec.stat.extent = 1.0
    spec.stat.center = [0, 0, 0.6]
