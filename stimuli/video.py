"""From a motion to the pose in each frame, and from frames to H.264 that plays in every browser."""

from __future__ import annotations

from collections.abc import Iterable
from fractions import Fraction
from pathlib import Path

import av
import numpy as np
from numpy.typing import NDArray

from stimuli.spec import Video
from stimuli.trajectory import FloatArray, Trajectory
from stimuli.whole_files import whole_or_nothing

BT709, LIMITED = 1, 1  # ITU-T H.273 code points: colour matrix, transfer and primaries; video range
OPTIONS = {"preset": "veryfast", "crf": "18", "profile": "high"}


def frame_positions(trajectory: Trajectory, video: Video) -> FloatArray:
    """Joint positions in each frame, shape (frames, joints).

    There are round((lead-in + motion + hold) · fps) frames, halves up. Frame k shows the motion at time
    k / fps − lead-in: its first pose before it starts, its last after it ends.
    """
    total_s = video.lead_in_s + trajectory.duration_s + video.hold_s
    frames = max(1, int(np.floor(total_s * video.fps + 0.5)))
    times = trajectory.times[0] + np.arange(frames) / video.fps - video.lead_in_s
    return trajectory.at(times)


def write_video(path: Path, frames: Iterable[NDArray[np.uint8]], *, fps: int) -> int:
    """Write frames (height, width, 3) RGB at a constant rate and return how many there were.

    The same array again is a frame held. The file appears under its name only when it is whole. One encoder
    thread, so that the bytes do not depend on the number of cores; a keyframe each second, so that a
    participant can go back; the index first, so that playing starts before all is loaded.
    """
    with whole_or_nothing(path) as partial:
        return _encode(partial, frames, fps)


def _encode(path: Path, frames: Iterable[NDArray[np.uint8]], fps: int) -> int:
    count = 0
    with av.open(str(path), "w", format="mp4", options={"movflags": "faststart"}) as file:
        stream = file.add_stream("libx264", rate=fps, options=OPTIONS)
        stream.pix_fmt = "yuv420p"
        coder = stream.codec_context
        coder.thread_count = 1
        coder.gop_size = fps
        coder.time_base = Fraction(1, fps)
        coder.colorspace = coder.color_primaries = coder.color_trc = BT709
        coder.color_range = LIMITED
        last: tuple[NDArray[np.uint8], av.VideoFrame] | None = None
        for count, image in enumerate(frames, start=1):
            if last is None or image is not last[0]:  # else it is held, and converted already
                last = image, _picture(image)
            picture = last[1]
            if count == 1:
                stream.height, stream.width = image.shape[:2]
            picture.pts, picture.time_base = count - 1, coder.time_base
            file.mux(stream.encode(picture))
        file.mux(stream.encode())
    return count


def _picture(image: NDArray[np.uint8]) -> av.VideoFrame:
    """An RGB image as the encoder takes it."""
    picture = av.VideoFrame.from_ndarray(np.ascontiguousarray(image), format="rgb24").reformat(
        format="yuv420p", dst_colorspace="ITU709", dst_color_range="MPEG", threads=1
    )
    picture.colorspace = picture.color_primaries = picture.color_trc = BT709
    picture.color_range = LIMITED
    return picture


def read_frames(path: Path) -> list[NDArray[np.uint8]]:
    """Every frame of a clip as RGB, shape (height, width, 3)."""
    with av.open(str(path)) as file:
        return [np.asarray(frame.to_ndarray(format="rgb24"), np.uint8) for frame in file.decode(video=0)]
