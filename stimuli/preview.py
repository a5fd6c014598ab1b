"""What to look at before a study: contact sheet, and for single stimuli poster, curves and a comparison."""

from __future__ import annotations

import csv
from collections.abc import Mapping, Sequence
from pathlib import Path

from stimuli.contact_sheet import contact_sheet
from stimuli.curves import draw_curves
from stimuli.errors import InputError, nearest
from stimuli.manifest import Manifest
from stimuli.motion import generate
from stimuli.robots.model import Robot
from stimuli.side_by_side import poster, side_by_side
from stimuli.spec import StimulusSpec

LONGEST = 80  # characters of a file's name


def draw_preview(
    manifest: Manifest,
    folder: Path,
    out: Path,
    *,
    stimuli: Sequence[str] = (),
    robots: Mapping[str, Robot],
    gestures: Mapping[str, Path],
) -> list[Path]:
    """Draw a contact sheet and write the descriptors of all clips; of those named, also the rest.

    That is a poster and the joints' curves of each, and, of two or more, a clip of them side by side.
    `gestures` are the demonstrations' files by their hashes.
    """
    for id_ in stimuli:
        if id_ not in manifest.clips:
            raise InputError(f"{folder}: there is no clip of {id_!r}; {nearest(id_, manifest.clips)}")
    for id_ in stimuli or manifest.clips:
        if not (clip := manifest.clips[id_]).is_whole(folder):
            remedy = "`study render` makes it again"
            raise InputError(f"{folder / clip.file}: the clip of {id_} is missing or damaged; {remedy}")
    out.mkdir(parents=True, exist_ok=True)
    name = _name_of(stimuli)
    drawn = [
        contact_sheet(manifest, folder, out / f"{name}.png", stimuli=stimuli or None),
        write_descriptors(manifest, out / "descriptors.csv"),
    ]
    for id_ in stimuli:
        drawn.append(poster(manifest, folder, id_, out / f"{id_}.poster.png"))
        spec = StimulusSpec.model_validate(manifest.clips[id_].spec)
        if spec.gesture_sha256 not in gestures:
            raise InputError(
                f"{id_}: {spec.gesture.name} has changed since the clip was rendered: render again"
            )
        spec, robot = spec.model_copy(update={"gesture": gestures[spec.gesture_sha256]}), robots[spec.robot]
        drawn.append(draw_curves(generate(spec, robot), robot, out / f"{id_}.curves.png", title=id_))
    if len(stimuli) > 1:
        drawn.append(side_by_side(manifest, folder, stimuli, out / f"{name}.mp4"))
    return drawn


def _name_of(stimuli: Sequence[str]) -> str:
    """Name of the files that show them all."""
    name = "-".join(stimuli) or "contact_sheet"
    return name if len(name) <= LONGEST else f"{stimuli[0][:LONGEST]}-and-{len(stimuli) - 1}-more"


def write_descriptors(manifest: Manifest, out: Path) -> Path:
    """Write what describes each motion as a table, a row for each stimulus.

    Also `amplitude_<joint>`, peak to peak in the joint's unit, of every joint.
    """
    rows = [
        {"stimulus": id_, **clip.descriptors}
        | {f"amplitude_{joint}": left["amplitude"] for joint, left in clip.margins.items()}
        for id_, clip in manifest.clips.items()
    ]
    with out.open("w", encoding="utf-8", newline="") as file:
        table = csv.DictWriter(file, list(dict.fromkeys(name for row in rows for name in row)))
        table.writeheader()
        table.writerows(rows)
    return out
