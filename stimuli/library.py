"""A folder of clips kept complete: what is missing is rendered, what is there is not.

A clip's name is the hash of everything its picture depends on, so a changed stimulus has another name and an
unchanged one is found. A run that was stopped is taken up where it stopped: a clip appears only when it is
whole, and the manifest is written after each.
"""

from __future__ import annotations

import hashlib
import importlib.metadata
import multiprocessing
import os
import signal
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from stimuli.errors import InputError
from stimuli.manifest import Clip, Framing, Manifest, sha256_of
from stimuli.robots.model import Robot
from stimuli.spec import StimulusSpec, Video

if TYPE_CHECKING:
    from stimuli.rendering import Renderer

AUTO = "auto"
SOFTWARE = ("expressive-motion-study", "mujoco", "av", "numpy", "scipy")
ATTEMPTS = 2  # a clip whose worker died is tried once more


@dataclass(frozen=True)
class Progress:
    """How far a run is: said at its start and after each clip."""

    done: int  # clips
    total: int
    stimulus: str | None = None  # the one just finished


def render_missing(
    specs: Sequence[StimulusSpec],
    robots: Mapping[str, Robot],
    folder: Path,
    *,
    workers: int | None = None,
    progress: Callable[[Progress], None] | None = None,
) -> Manifest:
    """Render the clips the folder does not have, one worker a core, and return the folder's manifest."""
    folder.mkdir(parents=True, exist_ok=True)
    _sweep(folder)
    manifest = Manifest.load(folder)
    framing, specs = _framed(specs, robots, manifest.framing)
    whole = {clip.spec_sha256: clip for clip in manifest.stimuli.values() if _is_whole(clip, folder)}
    missing = {spec.sha256: spec for spec in specs if spec.sha256 not in whole}
    told = progress or (lambda _: None)
    told(Progress(0, len(missing)))

    def listed() -> Manifest:
        return Manifest(
            stimuli={s.id: _as(s, whole[s.sha256]) for s in specs if s.sha256 in whole}, framing=framing
        )

    for done, clip in enumerate(_rendered(list(missing.values()), robots, folder, workers), start=1):
        whole[clip.spec_sha256] = clip
        listed().save(folder)
        told(Progress(done, len(missing), clip.spec["id"]))
    if listed() != manifest:
        listed().save(folder)
    return listed()


def render_clip(spec: StimulusSpec, robot: Robot, folder: Path) -> Clip:
    """Make one stimulus' motion, film it, and say what came out. The camera must be resolved."""
    from stimuli.descriptors import describe
    from stimuli.motion import generate
    from stimuli.video import frame_positions, write_video

    motion = generate(spec, robot)
    video = spec.video
    renderer = _renderer(robot, video)
    path = folder / f"{spec.sha256[:16]}.mp4"
    poses = frame_positions(motion.trajectory, video)
    joints = motion.trajectory.joints
    renderer.look_through(video.camera)
    images = (renderer.frame({**robot.home, **dict(zip(joints, row, strict=True))}) for row in poses.tolist())
    frames = write_video(path, images, fps=video.fps)
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
        software={name: importlib.metadata.version(name) for name in SOFTWARE},
        gl_renderer=renderer.gl_renderer,
    )


def _rendered(
    specs: Sequence[StimulusSpec], robots: Mapping[str, Robot], folder: Path, workers: int | None
) -> Iterator[Clip]:
    """Clips as they are finished. A worker that dies takes its pool along: the rest goes to a new one."""
    left = {spec.sha256: spec for spec in specs}
    for attempt in range(1, ATTEMPTS + 1):
        if not left:
            return
        count = min(workers or os.cpu_count() or 1, len(left))
        pool = ProcessPoolExecutor(count, multiprocessing.get_context("spawn"), _start_worker, (count,))
        try:
            waiting: set[Future[Clip]] = {
                pool.submit(render_clip, spec, robots[spec.robot], folder) for spec in left.values()
            }
            while waiting:
                finished, waiting = wait(waiting, return_when=FIRST_COMPLETED)
                for future in finished:
                    clip = future.result()
                    del left[clip.spec_sha256]
                    yield clip
        except BrokenProcessPool as error:
            if attempt == ATTEMPTS:
                names = ", ".join(spec.id for spec in left.values())
                raise InputError(
                    f"The process that renders died {ATTEMPTS} times; not rendered: {names}. "
                    "Is memory short? Try fewer workers, and `study doctor`."
                ) from error
        finally:
            _stop(pool)
            _sweep(folder)


def _start_worker(workers: int) -> None:
    """Runs in each worker first: Ctrl-C is for the parent; one thread where there is a worker per core."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    if workers > 1:
        os.environ.setdefault("LP_NUM_THREADS", "0")


def _stop(pool: ProcessPoolExecutor) -> None:
    """End a pool now; what its workers were at is thrown away."""
    processes = list((pool._processes or {}).values())  # no public name before Python 3.14
    pool.shutdown(wait=False, cancel_futures=True)
    for process in processes:
        process.terminate()
    for process in processes:
        process.join()


_open: dict[tuple[str, int, int], Renderer] = {}


def _renderer(robot: Robot, video: Video) -> Renderer:
    """This process' renderer for a robot and size, opened once and kept over clips."""
    from stimuli.rendering import Renderer

    key = (robot.sha256, video.width, video.height)
    if key not in _open:
        for other in _open.values():
            other.close()
        _open.clear()
        _open[key] = Renderer(robot, width=video.width, height=video.height, camera=video.camera)
    return _open[key]


def _framed(
    specs: Sequence[StimulusSpec], robots: Mapping[str, Robot], known: Framing | None
) -> tuple[Framing | None, list[StimulusSpec]]:
    """The specs with `auto` replaced by the one camera that suits them all."""
    open_ones = [spec for spec in specs if spec.video.camera == AUTO]
    if not open_ones:
        return None, list(specs)
    key = hashlib.sha256("".join(sorted(spec.sha256 for spec in open_ones)).encode()).hexdigest()
    if known is None or known.stimuli_sha256 != key:
        known = Framing(stimuli_sha256=key, camera=_closest_camera(open_ones, robots))
    chosen = {"camera": known.camera}
    return known, [
        spec.model_copy(update={"video": spec.video.model_copy(update=chosen)}) if spec in open_ones else spec
        for spec in specs
    ]


def _closest_camera(specs: Sequence[StimulusSpec], robots: Mapping[str, Robot]) -> str:
    """The closest preset in which no motion leaves the frame."""
    from stimuli.framing import closest_camera
    from stimuli.motion import generate

    motions = [(robots[spec.robot], generate(spec, robots[spec.robot]).trajectory) for spec in specs]
    return closest_camera(motions, width=specs[0].video.width, height=specs[0].video.height)


def _is_whole(clip: Clip, folder: Path) -> bool:
    path = folder / clip.file
    return path.is_file() and path.stat().st_size == clip.size_bytes and sha256_of(path) == clip.file_sha256


def _as(spec: StimulusSpec, clip: Clip) -> Clip:
    """The clip as this stimulus': another of the same picture may have been rendered."""
    return clip.model_copy(update={"spec": spec.model_dump(mode="json")})


def _sweep(folder: Path) -> None:
    """Remove what a killed run left half written."""
    for path in folder.glob(".*.part*"):
        pid = path.name.removesuffix(".mp4").removesuffix(".part").rpartition(".")[2]
        if pid.isdigit() and not Path(f"/proc/{pid}").exists():
            path.unlink(missing_ok=True)
