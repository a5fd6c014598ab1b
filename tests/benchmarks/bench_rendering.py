"""Our clips against mujoco.Renderer and mediapy: the same poses in the same scene; mjr_render is the limit.

Every run is a process of its own, counted from its start to its end with all its children (ffmpeg, workers).
"""

from __future__ import annotations

import json
import os
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

from stimuli.spec import StimulusSpec
from tests.benchmarks.compare import Row

PAPER = Path(__file__).parents[2] / "protocols" / "hielscher2025"
PEER = "mujoco.Renderer + mediapy"
FRAMES = 150  # of 1280 by 720
ROUNDS = 3
CLIPS = 4  # in the batch
WORKERS = 2


def rows() -> Iterator[Row]:
    """Every comparison."""
    with tempfile.TemporaryDirectory() as folder:
        wanted = Path(folder, "specs.json")
        wanted.write_text(json.dumps([spec.model_dump(mode="json") for spec in _specs()]))
        runs = [{way: _run(way, wanted) for way in ("ours", "peer", "raw")} for _ in range(ROUNDS)]

    def ratio(what: str, other: str) -> float:
        return statistics.median(run["ours"][what] / run[other][what] for run in runs)

    detail = ", ".join(
        f"{way} {statistics.median(run[way]['cpu_s'] for run in runs) / CLIPS:.1f} s" for way in runs[0]
    )
    each = f"CPU per clip of some {FRAMES} frames, 720p"
    yield Row(each, PEER, ratio("cpu_s", "peer"), 0.65, at_most=True, detail=detail)
    limit = "mjr_render alone, neither read back nor encoded"
    yield Row(each, limit, ratio("cpu_s", "raw"), 1.0, at_most=True)
    batch = f"wall time of {CLIPS} such clips on {WORKERS} cores"
    yield Row(batch, f"{PEER}, one after another", ratio("wall_s", "peer"), 0.55, at_most=True)


def _specs() -> list[StimulusSpec]:
    """The stimuli of the paper's study whose clips are nearest to 150 frames, nearest first."""
    from stimuli.motion import generate
    from stimuli.robots import load_robot
    from study.protocol import load_protocol
    from study.specs import specs

    protocol = load_protocol(PAPER)
    robot = load_robot(protocol.robot, protocol.folder)

    def off(spec: StimulusSpec) -> float:
        video = spec.video
        length_s = video.lead_in_s + generate(spec, robot).trajectory.duration_s + video.hold_s
        return abs(length_s * video.fps - FRAMES)

    nearest = sorted(specs(protocol).values(), key=off)[:CLIPS]
    return [
        spec.model_copy(update={"video": spec.video.model_copy(update={"camera": "upper_body"})})
        for spec in nearest
    ]


def _run(name: str, wanted: Path) -> dict[str, float]:
    """One way of rendering in a new process: processor time with all children, and wall time."""
    with tempfile.TemporaryDirectory() as out:
        start = time.perf_counter()
        command = [sys.executable, "-m", "tests.benchmarks.bench_rendering", name, str(wanted), out]
        process = subprocess.Popen(command, env={**os.environ, "MUJOCO_GL": "egl"})
        _, status, used = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        if process.returncode:
            raise RuntimeError(f"{name} ended with {process.returncode}")
        return {"cpu_s": used.ru_utime + used.ru_stime, "wall_s": time.perf_counter() - start}


def ours(wanted: list[StimulusSpec], out: Path) -> None:
    """As `study render` does it."""
    from stimuli.library import render_missing
    from stimuli.robots import load_robot

    robots = {spec.robot: load_robot(spec.robot, PAPER) for spec in wanted}
    render_missing(wanted, robots, out, workers=WORKERS)


def peer(wanted: list[StimulusSpec], out: Path) -> None:
    """As MuJoCo's tutorial does it: Renderer, then mediapy."""
    import mediapy
    import mujoco

    for spec in wanted:
        model, data, put = _scene(spec)
        with mujoco.Renderer(model, spec.video.height, spec.video.width) as renderer:
            frames = []
            for put_next in put:
                put_next()
                renderer.update_scene(data, camera=spec.video.camera)
                frames.append(renderer.render())
        mediapy.write_video(str(out / f"{spec.id}.mp4"), frames, fps=spec.video.fps)


def raw(wanted: list[StimulusSpec], out: Path) -> None:
    """Every frame drawn, one pixel of it read to wait for it, and thrown away."""
    import mujoco
    import numpy as np

    pixel = np.empty((1, 1, 3), np.uint8)
    for spec in wanted:
        model, data, put = _scene(spec)
        size = mujoco.MjrRect(0, 0, spec.video.width, spec.video.height)
        with mujoco.Renderer(model, spec.video.height, spec.video.width) as renderer:
            for put_next in put:
                put_next()
                renderer.update_scene(data, camera=spec.video.camera)
                mujoco.mjr_render(size, renderer.scene, renderer._mjr_context)
                mujoco.mjr_readPixels(pixel, None, mujoco.MjrRect(0, 0, 1, 1), renderer._mjr_context)


def _scene(spec: StimulusSpec) -> tuple[Any, Any, Iterator[Callable[[], None]]]:
    """The studio, its state, and for each frame what puts the robot into its pose."""
    import mujoco

    from stimuli.motion import generate
    from stimuli.robots import load_robot
    from stimuli.scene import pose, studio
    from stimuli.video import frame_positions

    robot = load_robot(spec.robot, PAPER)
    trajectory = generate(spec, robot).trajectory
    model = studio(robot, width=spec.video.width, height=spec.video.height)
    data = mujoco.MjData(model)

    def poses() -> Iterator[Callable[[], None]]:
        for row in frame_positions(trajectory, spec.video).tolist():
            positions = {**robot.home, **dict(zip(trajectory.joints, row, strict=True))}
            yield lambda positions=positions: pose(model, data, robot, positions)

    return model, data, poses()


if __name__ == "__main__":
    way, wanted_file, folder_out = sys.argv[1:]
    chosen = [StimulusSpec.model_validate(spec) for spec in json.loads(Path(wanted_file).read_text())]
    {"ours": ours, "peer": peer, "raw": raw}[way](chosen, Path(folder_out))
