"""A folder of clips: complete after a run, untouched by a second, and never half written."""

from __future__ import annotations

import hashlib
import json
import os
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from stimuli.contact_sheet import contact_sheet
from stimuli.errors import InputError
from stimuli.filming import render_clip
from stimuli.library import Progress, render_missing
from stimuli.manifest import Manifest
from stimuli.robots.model import Robot
from stimuli.spec import StimulusSpec, Video

SMALL = Video(width=64, height=64, fps=10, camera="head", lead_in_s=0.1, hold_s=0.2)
MakeSpec = Callable[..., StimulusSpec]


@pytest.fixture(scope="module")
def rendered(
    study: list[StimulusSpec], pepper: Robot, tmp_path_factory: pytest.TempPathFactory
) -> tuple[Manifest, Path, list[Progress]]:
    folder = tmp_path_factory.mktemp("clips")
    told: list[Progress] = []
    manifest = render_missing(study, {"pepper": pepper}, folder, workers=2, progress=told.append)
    return manifest, folder, told


def test_every_stimulus_has_its_clip_and_equal_ones_share_it(
    rendered: tuple[Manifest, Path, list[Progress]], study: list[StimulusSpec]
) -> None:
    manifest, folder, told = rendered
    assert list(manifest.clips) == ["neutral", "slow", "same"]
    assert manifest.clips["neutral"].file == manifest.clips["same"].file
    assert sorted(path.suffix for path in folder.iterdir()) == [".json", ".mp4", ".mp4"]
    assert [(p.done, p.total) for p in told if p.stimulus] == [(1, 2), (2, 2)]
    assert [p.done + p.under_way for p in told] == sorted(p.done + p.under_way for p in told)
    for one in study:
        clip = manifest.clips[one.id]
        assert StimulusSpec.model_validate(clip.spec) == one
        assert clip.file == f"{one.sha256[:16]}.mp4"
        assert clip.file_sha256 == hashlib.sha256((folder / clip.file).read_bytes()).hexdigest()
        assert clip.gl_renderer not in ("", "unknown")


def test_a_second_run_renders_nothing_and_imports_nothing_heavy(
    rendered: tuple[Manifest, Path, list[Progress]], study: list[StimulusSpec], tmp_path: Path
) -> None:
    _, folder, _ = rendered
    specs = tmp_path / "specs.json"
    specs.write_text(json.dumps([one.model_dump(mode="json") for one in study]))
    again = f"""
import json, sys
from collections.abc import Callable
from pathlib import Path
from stimuli.library import render_missing
from stimuli.robots import load_robot
from stimuli.spec import StimulusSpec
specs = [StimulusSpec.model_validate(one) for one in json.loads(Path({str(specs)!r}).read_text())]
told = []
render_missing(specs, {{"pepper": load_robot("pepper", Path())}}, Path({str(folder)!r}), progress=told.append)
assert [(p.done, p.total) for p in told] == [(0, 0)], told
assert not {{"mujoco", "scipy", "av"}} & set(sys.modules)
"""
    before = {path: path.stat().st_mtime_ns for path in folder.iterdir()}
    subprocess.run([sys.executable, "-c", again], check=True)
    assert {path: path.stat().st_mtime_ns for path in folder.iterdir()} == before


def test_rendering_elsewhere_gives_the_same_bytes(
    rendered: tuple[Manifest, Path, list[Progress]], study: list[StimulusSpec], pepper: Robot, tmp_path: Path
) -> None:
    manifest, _, _ = rendered
    assert render_clip(study[1], pepper, tmp_path).file_sha256 == manifest.clips["slow"].file_sha256


def test_a_damaged_clip_and_a_changed_stimulus_alone_are_rendered_again(
    rendered: tuple[Manifest, Path, list[Progress]],
    study: list[StimulusSpec],
    pepper: Robot,
    spec: MakeSpec,
    tmp_path: Path,
) -> None:
    manifest, folder, _ = rendered
    for path in folder.iterdir():
        (tmp_path / path.name).write_bytes(path.read_bytes())
    (tmp_path / manifest.clips["neutral"].file).write_bytes(b"not a clip")
    changed = [study[0], spec("slow", time=1.25)]
    told: list[Progress] = []
    after = render_missing(changed, {"pepper": pepper}, tmp_path, workers=1, progress=told.append)
    assert {p.stimulus for p in told} == {None, "neutral", "slow"}
    assert after.clips["neutral"].file_sha256 == manifest.clips["neutral"].file_sha256
    assert after.clips["slow"].file != manifest.clips["slow"].file


def test_auto_framing_is_decided_once_for_the_whole_study(
    spec: MakeSpec, pepper: Robot, tmp_path: Path
) -> None:
    auto = SMALL.model_copy(update={"camera": "auto"})
    specs = [spec("one", auto), spec("two", auto, exa=1.2)]
    manifest = render_missing(specs, {"pepper": pepper}, tmp_path, workers=1)
    assert {clip.spec["video"]["camera"] for clip in manifest.clips.values()} == {"head"}
    assert Manifest.load(tmp_path) == manifest


def test_a_killed_run_leaves_no_clip_half_written_and_the_next_one_finishes(
    spec: MakeSpec, pepper: Robot, tmp_path: Path
) -> None:
    long = Video(width=320, height=180, fps=60, camera="head", lead_in_s=2, hold_s=0)
    one = spec("long", long)
    (tmp_path / "spec.json").write_text(one.model_dump_json())
    clips = tmp_path / "clips"
    start = f"""
from collections.abc import Callable
from pathlib import Path
from stimuli.filming import render_clip
from stimuli.robots import load_robot
from stimuli.spec import StimulusSpec
one = StimulusSpec.model_validate_json(Path({str(tmp_path / "spec.json")!r}).read_text())
render_clip(one, load_robot("pepper", Path()), Path({str(clips)!r}))
"""
    clips.mkdir()
    running = subprocess.Popen([sys.executable, "-c", start])
    deadline = time.monotonic() + 60
    while not list(clips.glob(".*.part.mp4")) and time.monotonic() < deadline:
        time.sleep(0.01)
    running.kill()
    running.wait()
    assert list(clips.glob(".*.part.mp4"))
    assert not [path for path in clips.iterdir() if not path.name.startswith(".")]
    short = [spec("short")]
    render_missing(short, {"pepper": pepper}, clips, workers=1)
    assert sorted(path.suffix for path in clips.iterdir()) == [".json", ".mp4"]


def test_a_contact_sheet_shows_every_clip(
    rendered: tuple[Manifest, Path, list[Progress]], tmp_path: Path
) -> None:
    from PIL import Image

    manifest, folder, _ = rendered
    contact_sheet(manifest, folder, tmp_path / "one.png", stimuli=["slow"], frame_width=64)
    contact_sheet(manifest, folder, tmp_path / "three.png", frame_width=64)
    with Image.open(tmp_path / "one.png") as one, Image.open(tmp_path / "three.png") as three:
        assert (one.width, one.height) == (three.width, 4 + (three.height - 4) // 3)
        assert np.asarray(three).std() > 10


def test_a_broken_manifest_is_named_with_the_way_out(tmp_path: Path) -> None:
    (tmp_path / "manifest.json").write_text('{"stimuli": 3}')
    with pytest.raises(InputError, match=r"manifest\.json: this is not a manifest.*Delete it"):
        Manifest.load(tmp_path)


def test_leftovers_of_running_processes_are_not_swept_away(
    spec: MakeSpec, pepper: Robot, tmp_path: Path
) -> None:
    own = tmp_path / f".abc.{os.getpid()}.part.mp4"
    own.write_bytes(b"being written")
    render_missing([], {"pepper": pepper}, tmp_path)
    assert own.exists()


def test_a_motion_the_robot_cannot_do_stops_the_run_with_its_reason(
    spec: MakeSpec, pepper: Robot, tmp_path: Path
) -> None:
    with pytest.raises(InputError, match=r"^wild: HeadPitch at .* limit"):
        render_missing([spec("wild", exa=9)], {"pepper": pepper}, tmp_path, workers=1)
