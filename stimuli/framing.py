"""Which camera suits a set of motions: the same for all of them, so that framing never differs."""

from __future__ import annotations

import itertools
from collections.abc import Sequence

import mujoco
import numpy as np

from stimuli.robots.model import Robot
from stimuli.scene import PRESETS, SHADOW, Outline, places, pose, studio
from stimuli.trajectory import FloatArray, Trajectory

MARGIN = 0.03  # of the picture's height that stays free
MOVES_M = 0.015  # a place on the robot that moves less may lie outside
RATE_HZ = 15
DIRECTIONS = np.array([d for d in itertools.product([-1, 0, 1], repeat=3) if any(d)])  # (26, 3)


def closest_camera(motions: Sequence[tuple[Robot, Trajectory]], *, width: int, height: int) -> str:
    """The closest preset in which nothing that moves leaves the frame; the widest where all fail."""
    fitting = list(PRESETS)[:-1]
    studios: dict[str, tuple[mujoco.MjModel, Outline]] = {}
    for robot, trajectory in motions:
        if robot.sha256 not in studios:
            model = studio(robot, width=width, height=height)
            moving = np.flatnonzero(model.body_weldid[model.geom_bodyid])
            studios[robot.sha256] = (
                model,
                _outermost(Outline(model, moving[moving != model.geom(SHADOW).id])),
            )
        model, outline = studios[robot.sha256]
        points = _swept(model, outline, robot, trajectory)
        fitting = [name for name in fitting if _inside(points, model, name, width / height)]
    return fitting[0] if fitting else list(PRESETS)[-1]


def _outermost(outline: Outline) -> Outline:
    """Of each part only the points furthest out in one of the directions; the margin holds the rest."""
    kept = [
        here[np.unique(np.argmax(outline.points[here] @ DIRECTIONS.T, axis=0))]
        for here in (np.flatnonzero(outline.geoms == geom) for geom in np.unique(outline.geoms))
    ]
    chosen = np.concatenate(kept)
    outline.points, outline.geoms = outline.points[chosen], outline.geoms[chosen]
    return outline


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
