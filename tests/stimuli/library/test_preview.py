"""What is looked at before a study shows every clip, joint and variant asked for."""

from __future__ import annotations

import csv
import shutil
from pathlib import Path

import av
import numpy as np
import pytest
from PIL import Image

from stimuli.curves import curves
from stimuli.errors import InputError
from stimuli.library import Progress
from stimuli.manifest import Manifest
from stimuli.motion import generate
from stimuli.preview import draw_preview
from stimuli.robots.model import Robot
from stimuli.spec import StimulusSpec

Gestures = dict[str, Path]


@pytest.fixture
def gestures(study: list[StimulusSpec], tmp_path: Path) -> Gestures:
    """The study's only demonstration by its hash; it lies elsewhere now."""
    return {study[0].gesture_sha256: Path(shutil.copy(study[0].gesture, tmp_path / "moved.yaml"))}


@pytest.fixture
def clips(rendered: tuple[Manifest, Path, list[Progress]]) -> tuple[Manifest, Path]:
    return rendered[:2]


def test_a_preview_of_all_is_a_contact_sheet_and_a_table(
    clips: tuple[Manifest, Path], pepper: Robot, gestures: Gestures, tmp_path: Path
) -> None:
    sheet, table = draw_preview(*clips, tmp_path, robots={"pepper": pepper}, gestures=gestures)
    with Image.open(sheet) as picture:
        assert np.asarray(picture).std() > 10
    rows = list(csv.DictReader(table.read_text().splitlines()))
    assert [row["stimulus"] for row in rows] == ["neutral", "slow", "same"]
    assert float(rows[1]["duration_s"]) > float(rows[0]["duration_s"])
    assert float(rows[0]["amplitude_HeadPitch"]) > float(rows[0]["amplitude_LHand"]) == 0


def test_stimuli_named_get_poster_curves_and_a_comparison(
    clips: tuple[Manifest, Path], pepper: Robot, gestures: Gestures, tmp_path: Path
) -> None:
    drawn = draw_preview(
        *clips, tmp_path, stimuli=["neutral", "slow"], robots={"pepper": pepper}, gestures=gestures
    )
    assert sorted(path.name for path in drawn) == sorted(
        [
            "neutral-slow.png",
            "descriptors.csv",
            *(f"{id_}.{kind}.png" for id_ in ("neutral", "slow") for kind in ("poster", "curves")),
            "neutral-slow.mp4",
        ]
    )
    with Image.open(tmp_path / "slow.poster.png") as poster:
        assert poster.size == (64, 64)
    with av.open(str(tmp_path / "neutral-slow.mp4")) as film:
        frames = [frame.to_ndarray(format="rgb24") for frame in film.decode(video=0)]
    assert len(frames) == clips[0].clips["slow"].frames
    height, width, _ = frames[0].shape
    cell = width // 2
    assert height == 64 + 36 and cell > 64, "the longer name is wider than its clip"
    left, right = (
        np.abs(frames[-1][40:, half].astype(int) - frames[-4][40:, half]).max()
        for half in (slice(0, cell), slice(cell, width))
    )
    assert left < right  # the quick one has ended and holds its last frame
    written = np.flatnonzero((frames[0][:34] < 128).any(axis=(0, 2)))
    assert np.diff(written).max() > 12, "the names do not run into each other"


def test_the_curves_show_the_joints_that_move_demonstrated_and_made(
    study: list[StimulusSpec], pepper: Robot
) -> None:
    motion = generate(study[1], pepper)
    figure = curves(motion, pepper, title="slow")
    panels = [panel for panel in figure.axes if panel.get_visible()]
    assert [panel.get_title(loc="left") for panel in panels] == ["HeadPitch (°)"]
    left, right = panels[0].get_subplotspec().get_position(figure).intervalx
    assert right - left > 0.5  # a single panel fills the picture
    demonstrated, made = panels[0].get_lines()[:2]
    assert (demonstrated.get_linestyle(), made.get_linestyle()) == ("--", "-")
    np.testing.assert_allclose(made.get_ydata(), np.degrees(motion.trajectory.joint("HeadPitch")))
    assert made.get_xdata()[-1] > demonstrated.get_xdata()[-1]


def test_curves_are_of_the_demonstration_a_clip_was_rendered_from(
    clips: tuple[Manifest, Path], pepper: Robot, tmp_path: Path
) -> None:
    with pytest.raises(InputError, match=r"slow: nod\.yaml has changed since the clip was rendered"):
        draw_preview(*clips, tmp_path, stimuli=["slow"], robots={"pepper": pepper}, gestures={})


def test_a_clip_that_is_missing_or_damaged_is_named(
    clips: tuple[Manifest, Path], pepper: Robot, gestures: Gestures, tmp_path: Path
) -> None:
    manifest, _ = clips
    file = manifest.clips["slow"].file
    for content in (None, b"junk"):
        if content:
            (tmp_path / file).write_bytes(content)
        with pytest.raises(InputError, match=rf"{file}: the clip of slow is missing or damaged"):
            draw_preview(
                manifest, tmp_path, tmp_path, stimuli=["slow"], robots={"pepper": pepper}, gestures=gestures
            )


def test_many_stimuli_share_a_file_whose_name_is_not_too_long(
    clips: tuple[Manifest, Path], pepper: Robot, gestures: Gestures, tmp_path: Path
) -> None:
    manifest, folder = clips
    names = [f"{letter * 60}" for letter in "ab"]
    many = Manifest(stimuli=dict.fromkeys(names, manifest.clips["neutral"]))
    drawn = draw_preview(many, folder, tmp_path, stimuli=names, robots={"pepper": pepper}, gestures=gestures)
    assert [path.name for path in (drawn[0], drawn[-1])] == [
        f"{names[0]}-and-1-more{end}" for end in (".png", ".mp4")
    ]


def test_a_stimulus_that_is_not_there_is_named_with_the_nearest(
    clips: tuple[Manifest, Path], pepper: Robot, gestures: Gestures, tmp_path: Path
) -> None:
    with pytest.raises(InputError, match=r"there is no clip of 'slwo'; did you mean slow\?"):
        draw_preview(*clips, tmp_path, stimuli=["slwo"], robots={"pepper": pepper}, gestures=gestures)
