"""Frames of a robot in the studio: the only place that draws.

MuJoCo's own renderer, off screen, through EGL, or OSMesa where `MUJOCO_GL=osmesa` says so or EGL is missing.
Only what moves is drawn again: the rectangle around every part that left its place in the clip's first frame
is rendered through a part of the camera's frustum and pasted into that first frame. The pasted pixels are
those of a full frame but for rounding on single edge samples. Where that cannot hold, because something casts
shadows, reflects or has no outline, every frame is drawn in full.
"""

from __future__ import annotations

import ctypes
import os
from collections.abc import Mapping
from importlib import import_module
from types import TracebackType
from typing import Any, Self

import mujoco
import numpy as np
from numpy.typing import NDArray

from stimuli.errors import InputError
from stimuli.outline import Outline, places
from stimuli.robots.model import Robot
from stimuli.scene import pose, studio
from stimuli.trajectory import FloatArray

Image = NDArray[np.uint8]

SAMPLES = 4  # per pixel against jaggies; software rendering knows 4 or none
STILL = 1e-7  # a part that moved less (m, or in its rotation matrix) has not moved
BORDER = 2  # pixels drawn around what moves


class RenderingError(InputError):
    """No picture can be drawn on this machine; the message says what to install."""


class Renderer:
    """One robot in the studio seen by one camera, with the OpenGL context it is drawn in."""

    def __init__(self, robot: Robot, *, width: int, height: int, camera: str, crop: bool = True) -> None:
        self.robot, self.width, self.height = robot, width, height
        self._gl = open_context(width, height)
        self.model = studio(robot, width=width, height=height)
        self.model.vis.quality.offsamples = SAMPLES
        self.data = mujoco.MjData(self.model)
        self._outline = Outline.of(self.model)
        self._scene = mujoco.MjvScene(self.model, maxgeom=self.model.ngeom + 10)
        for flag in (
            mujoco.mjtRndFlag.mjRND_SHADOW,
            mujoco.mjtRndFlag.mjRND_SKYBOX,
            mujoco.mjtRndFlag.mjRND_HAZE,
        ):
            self._scene.flags[flag] = False
        self._context = mujoco.MjrContext(self.model, mujoco.mjtFontScale.mjFONTSCALE_50)
        mujoco.mjr_setBuffer(mujoco.mjtFramebuffer.mjFB_OFFSCREEN, self._context)
        self.gl_renderer = gl_renderer()
        self._view = mujoco.MjvCamera()
        self._view.type = mujoco.mjtCamera.mjCAMERA_FIXED
        self._option = mujoco.MjvOption()
        self._option.sitegroup[:] = False
        self._crop = crop and _changes_where_it_is(self.model)
        self.look_through(camera)

    def look_through(self, camera: str) -> None:
        """Change the camera; the next frame is the first of a clip."""
        self._view.fixedcamid = self.model.camera(camera).id
        self._first: tuple[Image, FloatArray] | None = None
        self._last: tuple[Mapping[str, float], Image] | None = None

    def frame(self, positions: Mapping[str, float]) -> Image:
        """The robot in this pose, (height, width, 3), top row first. A held pose gives the same array."""
        if self._last is not None and self._last[0] == positions:
            return self._last[1]
        pose(self.model, self.data, self.robot, positions)
        mujoco.mjv_updateScene(
            self.model, self.data, self._option, None, self._view, mujoco.mjtCatBit.mjCAT_ALL, self._scene
        )
        image = self._whole() if self._first is None or not self._crop else self._cropped(*self._first)
        if self._first is None:
            self._first = (image, places(self.data))
        self._last = (dict(positions), image)
        return image

    def _whole(self) -> Image:
        return self._draw(0, 0, self.width, self.height)

    def _cropped(self, image: Image, before: FloatArray) -> Image:
        """The first frame with what moved drawn anew, where it was and where it is."""
        now = places(self.data)
        moved = np.flatnonzero(np.abs(now - before).max(axis=1) > STILL).tolist()
        if not moved:
            return image
        x, y = self.project(np.vstack([self._outline.placed(where, moved) for where in (before, now)])).T
        left, bottom = max(0, int(x.min()) - BORDER), max(0, int(y.min()) - BORDER)
        right, top = min(self.width, int(x.max()) + 1 + BORDER), min(self.height, int(y.max()) + 1 + BORDER)
        if right <= left or top <= bottom:
            return image
        frame = image.copy()
        frame[self.height - top : self.height - bottom, left:right] = self._draw(left, bottom, right, top)
        return frame

    def project(self, points: FloatArray) -> FloatArray:
        """Pixel coordinates (n, 2) of points in the world (n, 3): x from the left, y from the bottom."""
        camera = self._view.fixedcamid
        seen = (points - self.data.cam_xpos[camera]) @ self.data.cam_xmat[camera].reshape(3, 3)
        focal = self.height / 2 / np.tan(np.radians(self.model.cam_fovy[camera]) / 2)
        depth = np.maximum(-seen[:, 2:], self.model.vis.map.znear * self.model.stat.extent)
        pixels: FloatArray = np.array([self.width / 2, self.height / 2]) + focal * seen[:, :2] / depth
        return pixels

    def _draw(self, left: int, bottom: int, right: int, top: int) -> Image:
        """Draw a rectangle of the picture and read it back, top row first."""
        across, up = (left + right - self.width) / 2, np.array([bottom, top]) - self.height / 2
        for eye in self._scene.camera:
            pixel = (eye.frustum_top - eye.frustum_bottom) / self.height
            eye.frustum_center, eye.frustum_width = across * pixel, (right - left) / 2 * pixel
            eye.frustum_bottom, eye.frustum_top = up * pixel
        area = mujoco.MjrRect(left, bottom, right - left, top - bottom)
        mujoco.mjr_render(area, self._scene, self._context)
        pixels = np.empty((top - bottom, right - left, 3), np.uint8)
        mujoco.mjr_readPixels(pixels, None, area, self._context)
        return pixels[::-1]

    def close(self) -> None:
        """Free the context; a renderer left open costs some 20 MB."""
        self._context.free()
        self._gl.free()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()


def _changes_where_it_is(model: mujoco.MjModel) -> bool:
    """Whether whatever moves changes the picture within its outline alone."""
    elsewhere = model.light_castshadow.any() or model.mat_reflectance.any()
    without_outline = model.nskin or model.nflex or model.ntendon
    return not (elsewhere or without_outline)


def open_context(width: int, height: int) -> Any:
    """An OpenGL context without a screen, made current: EGL, else OSMesa."""
    wanted = os.environ.get("MUJOCO_GL", "")
    backends = (wanted,) if wanted in ("egl", "osmesa") else ("egl", "osmesa")
    problems = []
    for backend in backends:
        try:
            context = import_module(f"mujoco.{backend}").GLContext(width, height)
            context.make_current()
        except Exception as error:  # drivers raise anything, even AttributeError
            problems.append(f"{backend}: {type(error).__name__}: {error}")
        else:
            return context
    raise RenderingError(
        "No picture can be drawn: OpenGL without a screen is not available here. On Debian or Ubuntu: "
        "apt-get install --no-install-recommends libegl1 libopengl0 libgl1-mesa-dri. "
        f"`study doctor` looks closer. Tried {'; '.join(problems)}"
    )


def gl_renderer() -> str:
    """What draws: the graphics card's name, or llvmpipe where the processor does it."""
    opengl = import_module("OpenGL.raw.GL.VERSION.GL_1_0")  # OpenGL.GL would bring all versions' functions
    name = opengl.glGetString(0x1F01)  # GL_RENDERER
    return ctypes.string_at(name).decode() if name else "unknown"
