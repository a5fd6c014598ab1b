"""All clips at one glance: a row for each, frames evenly over its time."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import av
import numpy as np
from PIL import Image, ImageDraw

from stimuli.manifest import Clip, Manifest

GAP, LABEL = 4, 130  # pixels


def contact_sheet(
    manifest: Manifest,
    folder: Path,
    out: Path,
    *,
    stimuli: Sequence[str] | None = None,
    columns: int = 8,
    frame_width: int = 240,
) -> Path:
    """Write a picture of the folder's clips, or of those named: id and length, then `columns` frames each."""
    ids = list(manifest.clips if stimuli is None else stimuli)
    clips = [manifest.clips[id_] for id_ in ids]
    height = max((round(frame_width * clip.height / clip.width) for clip in clips), default=0)
    sheet = Image.new(
        "RGB", (LABEL + columns * (frame_width + GAP), GAP + len(ids) * (height + GAP)), "white"
    )
    draw = ImageDraw.Draw(sheet)
    for row, (id_, clip) in enumerate(zip(ids, clips, strict=True)):
        top = GAP + row * (height + GAP)
        draw.text((GAP, top + height // 2 - 14), f"{id_}\n{clip.duration_s:.2f} s", fill="black")
        for column, frame in enumerate(_frames(clip, folder, columns)):
            sheet.paste(frame.resize((frame_width, height)), (LABEL + column * (frame_width + GAP), top))
    sheet.save(out)
    return out


def _frames(clip: Clip, folder: Path, count: int) -> list[Image.Image]:
    """Frames from the first to the last, evenly spaced."""
    wanted = set(np.linspace(0, clip.frames - 1, count).round().astype(int).tolist())
    with av.open(str(folder / clip.file)) as file:
        frames = (frame for k, frame in enumerate(file.decode(video=0)) if k in wanted)
        return [Image.fromarray(frame.to_ndarray(format="rgb24")) for frame in frames]
