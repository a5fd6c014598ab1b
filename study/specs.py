"""From a protocol to the complete description of each of its stimuli."""

from __future__ import annotations

import hashlib
from functools import cache
from pathlib import Path

from stimuli.robots import load_robot
from stimuli.spec import StimulusSpec, Video
from study.protocol import Protocol, ProtocolError


def specs(protocol: Protocol) -> dict[str, StimulusSpec]:
    """The specification of every stimulus by id. Raises ProtocolError where a gesture's file is missing."""
    robot = load_robot(protocol.robot, protocol.folder)
    missing = [
        protocol.source.problem(("gestures", name), "cannot be found in this folder")
        for name, path in protocol.gestures.items()
        if not (protocol.folder / path).is_file()
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
            robot=protocol.robot,
            robot_sha256=robot.sha256,
            gesture=gesture,
            gesture_sha256=sha256_of(gesture),
            modulation=stimulus.modulation,
            learning=protocol.learning,
            video=video,
        )
        for stimulus in protocol.stimuli.values()
        for gesture in [protocol.folder / protocol.gestures[stimulus.gesture]]
    }


def _sha256(file: Path) -> str:
    return hashlib.sha256(file.read_bytes()).hexdigest()
