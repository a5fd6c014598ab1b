"""Clips are exact: every frame there, the same bytes each time, playable anywhere."""

from __future__ import annotations

import hashlib
from pathlib import Path

import av
import numpy as np
import pytest

from stimuli.spec import Video
from stimuli.trajectory import Trajectory
from stimuli.video import frame_positions, read_frames, write_video


def moving_square(count: int) -> list[np.ndarray]:
    frames = np.full((count, 48, 64, 3), (150, 160, 170), np.uint8)
    for k in range(count):
        frames[k, 8:24, k : k + 16] = (230, 60, 40)
    return list(frames)


def test_what_is_written_reads_back_frame_by_frame(tmp_path: Path) -> None:
    frames = moving_square(25)
    assert write_video(tmp_path / "clip.mp4", frames, fps=10) == 25
    back = read_frames(tmp_path / "clip.mp4")
    assert len(back) == 25
    for before, after in zip(frames, back, strict=True):
        assert np.abs(before.astype(int) - after).mean() < 3


def test_the_file_is_what_browsers_play(tmp_path: Path) -> None:
    write_video(tmp_path / "clip.mp4", moving_square(25), fps=10)
    with av.open(str(tmp_path / "clip.mp4")) as file:
        stream = file.streams.video[0]
        coder = stream.codec_context
        assert (coder.name, coder.pix_fmt, stream.average_rate, stream.frames) == ("h264", "yuv420p", 10, 25)
        assert (coder.colorspace, coder.color_primaries, coder.color_trc, coder.color_range) == (1, 1, 1, 1)
        times = [float(frame.time) for frame in file.decode(video=0)]
        file.seek(0)
        keys = [packet.pts * packet.time_base for packet in file.demux(video=0) if packet.is_keyframe]
    np.testing.assert_allclose(times, np.arange(25) / 10)
    assert keys == [0, 1, 2]
    start = (tmp_path / "clip.mp4").read_bytes()
    assert start.index(b"moov") < start.index(b"mdat")


def test_the_same_frames_give_the_same_bytes(tmp_path: Path) -> None:
    for name in ("a.mp4", "b.mp4"):
        write_video(tmp_path / name, moving_square(12), fps=30)
    first, second = (hashlib.sha256((tmp_path / name).read_bytes()).digest() for name in ("a.mp4", "b.mp4"))
    assert first == second


def test_a_run_that_breaks_off_leaves_nothing_behind(tmp_path: Path) -> None:
    def breaking() -> object:
        yield from moving_square(5)
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        write_video(tmp_path / "clip.mp4", breaking(), fps=10)  # type: ignore[arg-type]
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("motion_s", "lead_in_s", "hold_s", "fps", "frames"),
    [(1.0, 0.5, 0.5, 30, 60), (0.99, 0, 0.02, 10, 10), (0.05, 0, 0, 30, 2)],
)
def test_a_clip_has_as_many_frames_as_its_time_says(
    motion_s: float, lead_in_s: float, hold_s: float, fps: int, frames: int
) -> None:
    times = np.linspace(0, motion_s, 50)
    ramp = Trajectory(times, times[:, None] / motion_s, ("HeadYaw",))
    video = Video(fps=fps, lead_in_s=lead_in_s, hold_s=hold_s)
    shown = frame_positions(ramp, video)[:, 0]
    assert len(shown) == frames
    expected = np.clip((np.arange(frames) / fps - lead_in_s) / motion_s, 0, 1)
    np.testing.assert_allclose(shown, expected, atol=1e-9)
