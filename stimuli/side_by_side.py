"""Clips beside each other in one clip, to compare variants of a motion, and single frames as pictures."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from pathlib import Path

import av
import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw, ImageFont

from stimuli.manifest import Manifest
from stimuli.video import write_video

WIDTH = 640  # pixels of each clip at most
COLUMNS = 3
LABEL = 36  # pixels above each clip
INDENT = 12  # pixels on either side of a label
FONT = ImageFont.load_default(20)


def side_by_side(manifest: Manifest, folder: Path, stimuli: Sequence[str], out: Path) -> Path:
    """Write a clip of these stimuli starting together, each below its id; one that ends holds its end."""
    clips = [manifest.clips[id_] for id_ in stimuli]
    columns = min(COLUMNS, len(clips))
    rows = -(-len(clips) // columns)
    width = min(WIDTH, clips[0].width) // 2 * 2
    height = round(width * clips[0].height / clips[0].width / 2) * 2
    cell = max(width, *(2 * math.ceil(FONT.getlength(id_) / 2 + INDENT) for id_ in stimuli))
    sheet = Image.new("RGB", (columns * cell, rows * (height + LABEL)), "white")
    corners = [(k % columns * cell, k // columns * (height + LABEL)) for k in range(len(clips))]
    for (left, top), id_ in zip(corners, stimuli, strict=True):
        ImageDraw.Draw(sheet).text((left + INDENT, top + 6), id_, "black", FONT)

    def frames() -> Iterator[NDArray[np.uint8]]:
        running = [_frames(folder / clip.file) for clip in clips]
        for _ in range(max(clip.frames for clip in clips)):
            for (left, top), film in zip(corners, running, strict=True):
                frame = next(film, None)
                if frame is not None:
                    sheet.paste(frame.resize((width, height)), (left, top + LABEL))
            yield np.asarray(sheet)

    write_video(out, frames(), fps=clips[0].fps)
    return out


def poster(manifest: Manifest, folder: Path, stimulus: str, out: Path, *, at: float = 0.5) -> Path:
    """Write one frame of a stimulus as a picture: the one at this share of its time."""
    clip = manifest.clips[stimulus]
    for k, frame in enumerate(_frames(folder / clip.file)):
        if k >= at * (clip.frames - 1):
            frame.save(out)
            break
    return out


def _frames(path: Path) -> Iterator[Image.Image]:
    with av.open(str(path)) as file:
        for frame in file.decode(video=0):
            yield Image.fromarray(frame.to_ndarray(format="rgb24"))
