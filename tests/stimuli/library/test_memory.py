"""A worker needs no more memory after ninety clips than after forty."""

from __future__ import annotations

import multiprocessing
from collections.abc import Callable
from pathlib import Path

from stimuli.robots.model import Robot
from stimuli.spec import StimulusSpec, Video
from stimuli.workers import film_here

MakeSpec = Callable[..., StimulusSpec]

TINY = Video(width=64, height=36, fps=5, camera="head", lead_in_s=0, hold_s=0)
CLIPS, SETTLED = 90, 40
RENDERER_KB = 19_000  # what one left open would keep; a thousand clips took 2 MB more than forty did


def resident_kb(pid: int) -> int:
    lines = Path(f"/proc/{pid}/status").read_text().splitlines()
    return next(int(line.split()[1]) for line in lines if line.startswith("VmRSS"))


def test_memory_is_flat_over_many_clips(spec: MakeSpec, pepper: Robot, tmp_path: Path) -> None:
    wanted = [spec(f"clip{k}", TINY, exa=1 + k / 1000) for k in range(CLIPS)]
    used = []
    for clip, _ in film_here(wanted, {"pepper": pepper}, tmp_path, workers=1):
        if clip:
            (worker,) = multiprocessing.active_children()
            assert worker.pid is not None
            used.append(resident_kb(worker.pid))
    assert len(used) == CLIPS
    assert used[-1] - used[SETTLED] < RENDERER_KB / 3
