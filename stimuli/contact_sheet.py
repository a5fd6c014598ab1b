"""All clips at one glance: a row for each, frames evenly over its time, cut to where the robots move."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import av
import numpy as np
from PIL import Image, ImageDraw, ImageFont

from stimuli.manifest import Clip, Manifest

GAP = 4  # pixels
FONT = ImageFont.load_default(size=15)
BACKDROP = 24  # of 255: a row of the backdrop differs by less from its first pixel, a robot by more
MARGIN = 0.02  # of a picture's width, on either side of the robots


def contact_sheet(
    manifest: Manifest,
    folder: Path,
    out: Path,
    *,
    stimuli: Sequence[str] | None = None,
    columns: int = 8,
    frame_height: int = 200,
) -> Path:
    """Write a picture of the folder's clips, or of those named: id and length, then `columns` frames each."""
    ids = list(manifest.clips if stimuli is None else stimuli)
    rows = [_frames(manifest.clips[id_], folder, columns, frame_height) for id_ in ids]
    left, right = _where_robots_are([frame for row in rows for frame in row])
    rows = [[frame.crop(_between(left, right, frame)) for frame in row] for row in rows]
    width = max((frame.width for row in rows for frame in row), default=0)
    label = 3 * GAP + max((round(FONT.getlength(id_)) for id_ in ids), default=0)
    size = (label + columns * (width + GAP), GAP + len(ids) * (frame_height + GAP))
    sheet = Image.new("RGB", size, "white")
    draw = ImageDraw.Draw(sheet)
    for number, (id_, row) in enumerate(zip(ids, rows, strict=True)):
        top = GAP + number * (frame_height + GAP)
        text = f"{id_}\n{manifest.clips[id_].duration_s:.2f} s"
        draw.text((GAP, top + frame_height // 2 - 16), text, fill="black", font=FONT)
        for column, frame in enumerate(row):
            sheet.paste(frame, (label + column * (width + GAP), top))
    sheet.save(out)
    return out


def _frames(clip: Clip, folder: Path, count: int, height: int) -> list[Image.Image]:
    """Frames from the first to the last, evenly spaced, of that height."""
    wanted = set(np.linspace(0, clip.frames - 1, count).round().astype(int).tolist())
    size = (round(height * clip.width / clip.height), height)
    with av.open(str(folder / clip.file)) as file:
        frames = (frame for k, frame in enumerate(file.decode(video=0)) if k in wanted)
        return [Image.fromarray(frame.to_ndarray(format="rgb24")).resize(size) for frame in frames]


def _where_robots_are(frames: Sequence[Image.Image]) -> tuple[float, float]:
    """Left and right end of all that stands before the backdrop, in any frame, as parts of its width."""
    left, right = 1.0, 0.0
    for frame in frames:
        pixels = np.asarray(frame).astype(np.int16)
        foreground = (np.abs(pixels - pixels[:, :1]).max(axis=2) > BACKDROP).any(axis=0)
        if foreground.any():
            left = min(left, int(foreground.argmax()) / frame.width)
            right = max(right, 1 - int(foreground[::-1].argmax()) / frame.width)
    return (max(0.0, left - MARGIN), min(1.0, right + MARGIN)) if left < right else (0.0, 1.0)


def _between(left: float, right: float, frame: Image.Image) -> tuple[int, int, int, int]:
    return round(left * frame.width), 0, round(right * frame.width), frame.height
