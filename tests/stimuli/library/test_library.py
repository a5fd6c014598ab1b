"""A folder of clips: complete after a run, untouched by a second, and never half written."""

from __future__ import annotations

import hashlib
import json
import math
import os
import subprocess
import sys
from collections.abc import Callable
from fractions import Fraction
from pathlib import Path

import av
import numpy as np
import pytest

from stimuli.contact_sheet import contact_sheet
from stimuli.errors import InputError
from stimuli.filming import render_clip
from stimuli.library import Progress, render_missing
from stimuli.manifest import Manifest
from stimuli.motion import generate
from stimuli.robots import load_robot
from stimuli.robots.model import Robot
from stimuli.spec import StimulusSpec, Video
from stimuli.video import frame_positions

SMALL = Video(width=64, height=64, fps=10, camera="head", lead_in_s=0.1, hold_s=0.2)
MakeSpec = Callable[..., StimulusSpec]
Rendered = tuple[Manifest, Path, list[Progress]]


def test_every_stimulus_has_its_clip_and_equal_ones_share_it(
    rendered: Rendered, study: list[StimulusSpec]
) -> None:
    manifest, folder, told = rendered
    assert list(manifest.clips) == ["neutral", "slow", "same"]
    assert manifest.clips["neutral"].file == manifest.clips["same"].file
    assert sorted(path.suffix for path in folder.iterdir()) == [".json", ".mp4", ".mp4"]
    assert [(p.done, p.total) for p in told if p.stimulus] == [(1, 2), (2, 2)]
    assert [p.done + p.under_way for p in told] == sorted(p.done + p.under_way for p in told)
    for one in study:
        clip = manifest.clips[one.id]
        assert not Path(clip.spec["gesture"]).is_absolute()  # nor does it depend on where one stands
        gesture = (folder / clip.spec["gesture"]).resolve()
        assert StimulusSpec.model_validate({**clip.spec, "gesture": gesture}) == one
        assert clip.file == f"{one.sha256[:16]}.mp4"
        assert clip.file_sha256 == hashlib.sha256((folder / clip.file).read_bytes()).hexdigest()
        assert clip.gl_renderer not in ("", "unknown")


def test_every_clip_shows_each_pose_once_at_its_time(rendered: Rendered, pepper: Robot) -> None:
    manifest, folder, _ = rendered
    for clip in manifest.clips.values():
        spec = StimulusSpec.model_validate({**clip.spec, "gesture": folder / clip.spec["gesture"]})
        trajectory, video = generate(spec, pepper).trajectory, spec.video
        poses = frame_positions(trajectory, video)
        with av.open(str(folder / clip.file)) as file:
            stream = file.streams.video[0]
            assert (stream.codec_context.name, stream.codec_context.pix_fmt) == ("h264", "yuv420p")
            assert stream.average_rate == stream.base_rate == clip.fps == video.fps
            packets = [packet for packet in file.demux(stream) if packet.pts is not None]
            file.seek(0)
            frames = list(file.decode(stream))
        seconds = video.lead_in_s + trajectory.duration_s + video.hold_s
        assert len(frames) == len(poses) == clip.frames == math.floor(seconds * video.fps + 0.5)
        assert [frame.time for frame in frames] == [k / video.fps for k in range(clip.frames)]
        assert {packet.duration * packet.time_base for packet in packets} == {Fraction(1, video.fps)}
        grey = np.stack([frame.to_ndarray(format="gray").astype(int) for frame in frames])
        changes = np.abs(np.diff(grey, axis=0)).max(axis=(1, 2))
        moves = np.abs(np.diff(poses, axis=0)).max(axis=1)
        assert changes[moves > np.radians(1)].min() > 2 * changes[moves == 0].max()
        content = (folder / clip.file).read_bytes()
        assert content.index(b"moov") < content.index(b"mdat")


def test_a_second_run_renders_nothing_and_imports_nothing_heavy(
    rendered: Rendered, study: list[StimulusSpec], tmp_path: Path
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
    rendered: Rendered, study: list[StimulusSpec], pepper: Robot, tmp_path: Path
) -> None:
    manifest, _, _ = rendered
    assert render_clip(study[1], pepper, tmp_path).file_sha256 == manifest.clips["slow"].file_sha256


def test_a_damaged_clip_and_a_changed_stimulus_alone_are_rendered_again_and_none_changed_back(
    rendered: Rendered,
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
    told.clear()
    back = render_missing(study, {"pepper": pepper}, tmp_path, workers=1, progress=told.append)
    assert {p.stimulus for p in told} == {None} and back.clips == manifest.clips, "what is there is used"
    (tmp_path / after.clips["slow"].file).unlink()
    render_missing(study, {"pepper": pepper}, tmp_path)
    assert Manifest.load(tmp_path).unused == ()


def test_auto_framing_is_decided_once_for_the_whole_study(
    spec: MakeSpec, pepper: Robot, tmp_path: Path
) -> None:
    auto = SMALL.model_copy(update={"camera": "auto"})
    specs = [spec("one", auto), spec("two", auto, exa=1.2)]
    manifest = render_missing(specs, {"pepper": pepper}, tmp_path, workers=1)
    assert {clip.spec["video"]["camera"] for clip in manifest.clips.values()} == {"head"}
    assert Manifest.load(tmp_path) == manifest


def test_a_killed_run_leaves_no_clip_half_written_and_the_next_one_finishes(
    spec: MakeSpec, pepper: Robot, begun: Callable[[Path], Path], tmp_path: Path
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
    left = begun(clips)
    running.kill()
    running.wait()
    assert left.exists()
    assert not [path for path in clips.iterdir() if not path.name.startswith(".")]
    short = [spec("short")]
    render_missing(short, {"pepper": pepper}, clips, workers=1)
    assert sorted(path.suffix for path in clips.iterdir()) == [".json", ".mp4"]


def test_a_contact_sheet_shows_every_clip(rendered: Rendered, tmp_path: Path) -> None:
    from PIL import Image

    manifest, folder, _ = rendered
    contact_sheet(manifest, folder, tmp_path / "one.png", stimuli=["slow"], frame_height=64)
    contact_sheet(manifest, folder, tmp_path / "three.png", frame_height=64)
    with Image.open(tmp_path / "one.png") as one, Image.open(tmp_path / "three.png") as three:
        assert one.height == 4 + (three.height - 4) // 3
        assert np.asarray(three).std() > 10


def test_a_broken_manifest_is_named_with_the_way_out(tmp_path: Path) -> None:
    (tmp_path / "manifest.json").write_text('{"stimuli": 3}')
    with pytest.raises(InputError, match=r"manifest\.json: this is not a manifest.*Delete it"):
        Manifest.load(tmp_path)


@pytest.mark.parametrize("backend", ["foo", "glfw"])
def test_a_wrong_backend_is_said_before_anything_is_drawn(
    backend: str, pepper: Robot, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("MUJOCO_GL", backend)
    said = rf"^MUJOCO_GL is '{backend}', .* egl or osmesa"
    with pytest.raises(InputError, match=said):
        render_missing([], {"pepper": pepper}, tmp_path)
    with pytest.raises(InputError, match=said):
        load_robot("robot.yaml", tmp_path)


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
