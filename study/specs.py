"""From a protocol to the complete description of each of its stimuli."""

from __future__ import annotations

import hashlib
from functools import cache
from pathlib import Path

from stimuli.robots import load_robot, title_of
from stimuli.spec import StimulusSpec, Video
from study.protocol import Protocol, ProtocolError

ABSENT = "cannot be found in this folder"  # said of a gesture's file


def specs(protocol: Protocol) -> dict[str, StimulusSpec]:
    """The specification of every stimulus by id. Raises ProtocolError where a gesture's file is missing."""
    robots = {name: load_robot(name, protocol.folder) for name in protocol.robots}
    missing = [
        protocol.source.problem(("gestures", name), ABSENT)
        for name, gesture in protocol.gestures.items()
        if not (protocol.folder / gesture.file).is_file()
    ]
    if missing:
        raise ProtocolError(missing)
    width, height = protocol.video.pixels
    video = Video(
        width=width,
        height=height,
        fps=protocol.video.fps,
        camera=protocol.video.camera,
        lead_in_s=protocol.video.lead_in,
        hold_s=protocol.video.hold,
    )
    sha256_of = cache(_sha256)
    return {
        stimulus.id: StimulusSpec(
            id=stimulus.id,
            robot=robot,
            robot_sha256=robots[robot].sha256,
            gesture=file,
            gesture_sha256=sha256_of(file),
            modulation=stimulus.modulation,
            learning=protocol.learning,
            video=video,
        )
        for stimulus in protocol.stimuli.values()
        for robot in [protocol.robot_of(stimulus.gesture)]
        for file in [protocol.folder / protocol.gestures[stimulus.gesture].file]
    }


def robot_titles(protocol: Protocol) -> list[str]:
    """What the robots are called that are seen. InputError where one's own file cannot be read."""
    return [title_of(robot, protocol.folder) for robot in protocol.robots]


def _sha256(file: Path) -> str:
    return hashlib.sha256(file.read_bytes()).hexdigest()
