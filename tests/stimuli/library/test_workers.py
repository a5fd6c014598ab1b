"""Workers are watched: one that dies or hangs is replaced, its clip tried once more, then named."""

from __future__ import annotations

import dataclasses
import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from functools import partial
from pathlib import Path

import pytest

from stimuli.errors import InputError
from stimuli.library import render_missing
from stimuli.robots.model import Robot
from stimuli.spec import StimulusSpec, Video
from stimuli.workers import film_here

MakeSpec = Callable[..., StimulusSpec]
Run = Callable[..., subprocess.Popen[str]]
Begun = Callable[[Path], Path]

ONCE = """
__import__("stimuli.robots.pepper", fromlist=["build"]).build()
if __import__("os").path.exists({mark!r}) else (__import__("os").mkdir({mark!r}), {fails})
"""


def failing_once(robot: Robot, mark: Path, fails: str) -> Robot:
    """The robot whose body cannot be built the first time: what `fails` says comes instead."""
    expression = " ".join(ONCE.format(mark=str(mark), fails=fails).split("\n"))
    return dataclasses.replace(robot, build=partial(eval, expression.strip()))


@pytest.mark.parametrize("fails", ['__import__("os")._exit(9)', '__import__("time").sleep(600)'])
def test_a_clip_whose_worker_died_or_hung_is_made_by_another(
    fails: str, spec: MakeSpec, pepper: Robot, tmp_path: Path
) -> None:
    failed = tmp_path / "failed"
    frail = failing_once(pepper, failed, fails)
    wanted, clock = [spec("frail")], lambda: float(failed.exists())  # a second passes, when it has failed
    filmed = film_here(wanted, {"pepper": frail}, tmp_path, workers=1, silence_s=0.5, clock=clock)
    (clip,) = [clip for clip, _ in filmed if clip]
    assert failed.is_dir()
    assert (tmp_path / clip.file).is_file()


def test_a_stimulus_whose_worker_dies_each_time_is_named_and_the_others_are_made(
    spec: MakeSpec, pepper: Robot, tmp_path: Path
) -> None:
    deadly = dataclasses.replace(pepper, build=partial(os._exit, 9), sha256="0" * 64)
    doomed = spec("doomed").model_copy(update={"robot": "deadly", "robot_sha256": deadly.sha256})
    with pytest.raises(InputError, match=r"failed 2 times; not rendered: doomed \(died\)\."):
        render_missing([doomed, spec("well")], {"pepper": pepper, "deadly": deadly}, tmp_path, workers=1)
    assert len(list(tmp_path.glob("*.mp4"))) == 1


def test_a_worker_that_hangs_is_ended(spec: MakeSpec, pepper: Robot, tmp_path: Path) -> None:
    stuck = dataclasses.replace(pepper, build=partial(time.sleep, 600))
    with pytest.raises(InputError, match=r"not rendered: stuck \(no frame for 0\.5 s\)"):
        list(film_here([spec("stuck")], {"pepper": stuck}, tmp_path, workers=1, silence_s=0.5))


RENDER = """
import resource, sys
from pathlib import Path
from stimuli.library import render_missing
from stimuli.robots import load_robot
from stimuli.spec import StimulusSpec
folder = Path(sys.argv[1])
one = StimulusSpec.model_validate_json((folder / "spec.json").read_text())
if __name__ == "__main__":
    if len(sys.argv) > 2:
        resource.setrlimit(resource.RLIMIT_FSIZE, (int(sys.argv[2]), resource.RLIM_INFINITY))
    render_missing([one], {"pepper": load_robot("pepper", Path())}, folder / "clips", workers=1)
"""


@pytest.fixture
def run(spec: MakeSpec, tmp_path: Path) -> Run:
    """Start rendering a clip of six seconds in a process of its own."""
    long = Video(width=320, height=180, fps=60, camera="head", lead_in_s=5, hold_s=0.1)
    (tmp_path / "spec.json").write_text(spec("long", long).model_dump_json())
    (tmp_path / "run.py").write_text(RENDER)

    def start(*arguments: str) -> subprocess.Popen[str]:
        command = [sys.executable, str(tmp_path / "run.py"), str(tmp_path), *arguments]
        return subprocess.Popen(command, stderr=subprocess.PIPE, text=True)

    return start


def test_ctrl_c_leaves_nothing_half_written(run: Run, begun: Begun, tmp_path: Path) -> None:
    running = run()
    begun(tmp_path / "clips")
    running.send_signal(signal.SIGINT)
    error = running.communicate()[1]
    assert error.strip().splitlines()[-1] == "KeyboardInterrupt"
    assert list((tmp_path / "clips").iterdir()) == []


def test_a_killed_run_takes_its_workers_along_and_leaves_nothing_half_written(
    run: Run, begun: Begun, tmp_path: Path
) -> None:
    running = run()
    worker = Path("/proc", begun(tmp_path / "clips").name.split(".")[2])
    running.kill()
    running.communicate()
    for _ in range(6000):
        if worker.exists():
            time.sleep(0.05)
    assert not worker.exists()
    assert list((tmp_path / "clips").iterdir()) == []


def test_a_full_disk_leaves_nothing_half_written_and_says_so(run: Run, tmp_path: Path) -> None:
    error = run("3000").communicate()[1]  # bytes a file may have
    assert "InputError" in error.strip().splitlines()[-1]
    assert "could not be written: File too large. Nothing half written is left." in error
    assert list((tmp_path / "clips").iterdir()) == []
