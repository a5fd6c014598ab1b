"""A contact sheet is cut to where the robots move, and loses nothing of them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from PIL import Image

from stimuli.contact_sheet import GAP, contact_sheet
from stimuli.manifest import Clip, Manifest
from stimuli.video import write_video


def test_a_contact_sheet_shows_all_that_moves_and_little_else(tmp_path: Path) -> None:
    frames = [np.full((100, 200, 3), 190, np.uint8) for _ in range(8)]
    for k, frame in enumerate(frames):
        frame[40:60, 60 + 5 * k : 80 + 5 * k] = 20
    write_video(tmp_path / "square.mp4", frames, fps=8)
    clip = Clip(
        file="square.mp4",
        file_sha256="",
        spec={},
        spec_sha256="",
        frames=8,
        fps=8,
        duration_s=1.0,
        width=200,
        height=100,
        size_bytes=0,
        software={},
        gl_renderer="",
    )
    manifest = Manifest(stimuli={"square": clip})
    drawn = contact_sheet(manifest, tmp_path, tmp_path / "sheet.png", columns=8, frame_height=100)
    with Image.open(drawn) as picture:
        sheet = np.asarray(picture.convert("L"))[GAP:-GAP]
    label = int((sheet < 255).all(axis=0).argmax())
    cells = np.split(sheet[:, label:], 8, axis=1)
    widths = [int((cell[50, :-GAP] < 100).sum()) for cell in cells]
    assert all(abs(width - 20) <= 1 for width in widths), "the square is whole in every frame"
    assert cells[0].shape[1] - GAP <= 55 + 2 * 4 + 4, "and little besides its way is shown"
