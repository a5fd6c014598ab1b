"""Which camera suits a set of motions: the same for all of them, so that framing never differs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import mujoco
import numpy as np

from stimuli.robots.model import Robot
from stimuli.scene import PRESETS, outline, pose, studio
from stimuli.trajectory import FloatArray, Trajectory

MARGIN = 0.03  # of the picture's height that stays free
MOVES_M = 0.015  # a part none of whose points moves farther may be cut by the edge
RATE_HZ = 15


def closest_camera(motions: Sequence[tuple[Robot, Trajectory]], *, width: int, height: int) -> str:
    """The closest preset in which no part that moves leaves the frame; the widest where all fail."""
    fitting = list(PRESETS)[:-1]
    studios: dict[str, mujoco.MjModel] = {}
    for robot, trajectory in motions:
        model = studios.setdefault(robot.sha256, studio(robot, width=width, height=height))
        points = _swept(model, robot, trajectory)
        fitting = [name for name in fitting if _inside(points, model, name, width / height)]
    return fitting[0] if fitting else list(PRESETS)[-1]


def _swept(model: mujoco.MjModel, robot: Robot, trajectory: Trajectory) -> FloatArray:
    """All places, shape (n, 3), of the points of parts that move."""
    times = np.arange(trajectory.times[0], trajectory.times[-1] + 1 / RATE_HZ, 1 / RATE_HZ)
    data = mujoco.MjData(model)
    geoms = [geom for geom in range(model.ngeom) if model.body_weldid[model.geom_bodyid[geom]] != 0]
    places: list[list[FloatArray]] = []
    for row in trajectory.at(times).tolist():
        positions: Mapping[str, float] = {**robot.home, **dict(zip(trajectory.joints, row, strict=True))}
        pose(model, data, robot, positions)
        places.append([outline(model, data, geom)[::4] for geom in geoms])
    parts = [np.stack(part) for part in zip(*places, strict=True)]  # each (times, points, 3)
    moving = [part for part in parts if np.linalg.norm(part - part[0], axis=-1).max() > MOVES_M]
    return np.concatenate([part.reshape(-1, 3) for part in moving]) if moving else np.empty((0, 3))


def _inside(points: FloatArray, model: mujoco.MjModel, name: str, aspect: float) -> bool:
    camera = model.camera(name)
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    seen = (points - data.cam_xpos[camera.id]) @ data.cam_xmat[camera.id].reshape(3, 3)
    height = np.tan(np.radians(camera.fovy[0]) / 2) * -seen[:, 2]
    x, y = np.abs(seen[:, 0]) / height, np.abs(seen[:, 1]) / height
    return bool(np.all(x < aspect - MARGIN) and np.all(y < 1 - MARGIN))
