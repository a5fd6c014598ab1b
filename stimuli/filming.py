"""One stimulus filmed: its motion made, drawn frame by frame and written as a clip."""

from __future__ import annotations

import importlib.metadata
import threading
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING

from stimuli.manifest import Clip, sha256_of
from stimuli.robots.model import Robot
from stimuli.spec import StimulusSpec, Video

if TYPE_CHECKING:
    from stimuli.rendering import Image, Renderer

SOFTWARE = ("expressive-motion-study", "mujoco", "av", "numpy", "scipy")

Filmed = tuple[Clip | None, float]  # a clip just finished, if any; how much of others is under way, in clips
FramesTold = Callable[[int, int], None]  # frames drawn, of how many


def render_clip(spec: StimulusSpec, robot: Robot, folder: Path, told: FramesTold | None = None) -> Clip:
    """Make one stimulus' motion, film it, and say what came out. The camera must be resolved."""
    from stimuli.descriptors import describe
    from stimuli.motion import generate
    from stimuli.video import frame_positions, write_video

    motion = generate(spec, robot)
    video = spec.video
    renderer = _renderer(robot, video)
    path = folder / f"{spec.sha256[:16]}.mp4"
    poses = frame_positions(motion.trajectory, video).tolist()
    joints = motion.trajectory.joints
    renderer.look_through(video.camera)

    def images() -> Iterator[Image]:
        for k, row in enumerate(poses, start=1):
            yield renderer.frame({**robot.home, **dict(zip(joints, row, strict=True))})
            if told:
                told(k, len(poses))

    frames = write_video(path, images(), fps=video.fps)
    return Clip(
        file=path.name,
        file_sha256=sha256_of(path),
        spec=spec.model_dump(mode="json"),
        spec_sha256=spec.sha256,
        frames=frames,
        fps=video.fps,
        duration_s=frames / video.fps,
        width=video.width,
        height=video.height,
        size_bytes=path.stat().st_size,
        descriptors=describe(motion.trajectory, robot),
        margins=motion.margins,
        robot_sources=robot.sources,
        software=software(),
        gl_renderer=renderer.gl_renderer,
    )


def software() -> dict[str, str]:
    """Versions of all that a clip's pixels come from."""
    return {name: importlib.metadata.version(name) for name in SOFTWARE}


_kept = threading.local()  # an OpenGL context belongs to one thread


def _renderer(robot: Robot, video: Video) -> Renderer:
    """This thread's renderer for a robot and size, opened once and kept over clips."""
    from stimuli.rendering import Renderer

    key = (robot.sha256, video.width, video.height)
    if getattr(_kept, "key", None) != key:
        if hasattr(_kept, "renderer"):
            _kept.key = None
            _kept.renderer.close()
        _kept.renderer = Renderer(robot, width=video.width, height=video.height, camera=video.camera)
        _kept.key = key
    renderer: Renderer = _kept.renderer
    return renderer
