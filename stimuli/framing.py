"""Which camera suits a robot's motions: the same for all of them, so that framing never differs."""

from __future__ import annotations

import itertools
from collections.abc import Sequence

import mujoco
import numpy as np

from stimuli.errors import InputError
from stimuli.outline import Outline, places
from stimuli.robots.model import Robot
from stimuli.scene import PRESETS, SHADOW, pose, studio
from stimuli.trajectory import FloatArray, Trajectory

MARGIN = 0.03  # of the picture's height that stays free
MOVES_M = 0.015  # a place on the robot that moves less may lie outside
RATE_HZ = 15
DIRECTIONS = np.array([d for d in itertools.product([-1, 0, 1], repeat=3) if any(d)])  # (26, 3)


def closest_camera(robot: Robot, motions: Sequence[Trajectory], *, width: int, height: int) -> str:
    """The closest preset in which nothing that moves leaves the frame. InputError where there is none."""
    model = studio(robot, width=width, height=height)
    outline = _outermost(model)
    fitting = list(PRESETS)
    for motion in motions:
        points = _swept(model, outline, robot, motion)
        fitting = [name for name in fitting if _inside(points, model, name, width / height)]
    if not fitting:
        widest = list(PRESETS)[-1]
        raise InputError(
            f"camera: auto: {robot.title} moves out of every picture, the widest too. Let it move less, or "
            f"name the camera that is to show a part of it: `camera: {widest}`"
        )
    return fitting[0]


def _outermost(model: mujoco.MjModel) -> Outline:
    """Of each part that can move only the points furthest out in a direction; the margin holds the rest."""
    moving = model.body_weldid[model.geom_bodyid] > 0
    moving[model.geom(SHADOW).id] = False
    points = {geom: points for geom, points in Outline.of(model).points.items() if moving[geom]}
    return Outline({g: p[np.unique(np.argmax(p @ DIRECTIONS.T, axis=0))] for g, p in points.items()})


def _swept(model: mujoco.MjModel, outline: Outline, robot: Robot, trajectory: Trajectory) -> FloatArray:
    """Where the points of the robot that move come, shape (n, 3)."""
    times = np.arange(trajectory.times[0], trajectory.times[-1] + 1 / RATE_HZ, 1 / RATE_HZ)
    data = mujoco.MjData(model)
    taken = []
    for row in trajectory.at(times).tolist():
        pose(model, data, robot, {**robot.home, **dict(zip(trajectory.joints, row, strict=True))})
        taken.append(outline.placed(places(data)))
    points = np.stack(taken)  # (times, points, 3)
    moves = np.linalg.norm(points - points[0], axis=-1).max(axis=0) > MOVES_M
    return points[:, moves].reshape(-1, 3)


def _inside(points: FloatArray, model: mujoco.MjModel, name: str, aspect: float) -> bool:
    camera = model.camera(name)
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    seen = (points - data.cam_xpos[camera.id]) @ data.cam_xmat[camera.id].reshape(3, 3)
    height = np.tan(np.radians(camera.fovy[0]) / 2) * -seen[:, 2]
    x, y = np.abs(seen[:, 0]) / height, np.abs(seen[:, 1]) / height
    return bool(np.all(x < aspect - MARGIN) and np.all(y < 1 - MARGIN))
