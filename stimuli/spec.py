"""The complete description of one stimulus: what is hashed, named after its hash and never rendered twice."""

from __future__ import annotations

import hashlib
import json
from pathlib import Path
from typing import Literal

from pydantic import BaseModel, ConfigDict, Field

from stimuli.dmp import Learning
from stimuli.principles import Modulation

Camera = Literal["auto", "head", "upper_body", "full_body", "wide"]
"""The scene's presets, closest first; auto: the closest in which no motion leaves the frame."""

MOTION = "motion/3"
"""Names the way from a demonstration to a motion; whoever changes what comes out changes the name."""


class Video(BaseModel):
    """Size, timing and framing, the same for every clip of a study."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    width: int = Field(1280, ge=16, le=7680, multiple_of=2)
    height: int = Field(720, ge=16, le=4320, multiple_of=2)
    fps: int = Field(30, ge=1, le=120)
    camera: str = "auto"  # a preset of the scene; auto: the closest in which no motion leaves the frame
    lead_in_s: float = Field(0.5, ge=0, le=60)  # first pose held before the motion
    hold_s: float = Field(0.5, ge=0, le=60)  # last pose held after the motion


class StimulusSpec(BaseModel):
    """Everything one clip depends on, all parameters written out."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    id: str
    robot: str  # name in stimuli.robots, or the path of a robot file
    robot_sha256: str
    gesture: Path  # the demonstration's file
    gesture_sha256: str
    modulation: Modulation
    learning: Learning
    video: Video
    motion: str = MOTION

    @property
    def sha256(self) -> str:
        """Hash of all that changes the picture: not of the id, nor of where the demonstration's file lies."""
        content = self.model_dump(mode="json", exclude={"id", "gesture"})
        return hashlib.sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()
