"""How a study's clips look and may be watched, as a protocol has it."""

from __future__ import annotations

from pydantic import Field, field_validator

from stimuli.spec import Camera
from study.text import Text
from study.written import A_SIZE, Seconds, Written, wrong


class Video(Written):
    """Size, timing and framing, the same for every clip of a study."""

    size: str = Field("1280x720", pattern=A_SIZE)
    fps: int = Field(30, ge=1, le=120)
    camera: Camera = "auto"
    lead_in: Seconds = 0.5
    hold: Seconds = 0.5
    replays: int | None = Field(None, ge=0)  # of a clip watched in full; any number unless told
    description: Text | None = None  # read out to who cannot see the clips; must not tell the condition

    @field_validator("size")
    @classmethod
    def _can_be_filmed(cls, size: str) -> str:
        width, height = map(int, size.split("x"))
        if width % 2 or height % 2:
            raise wrong("must have even sides, as the video format demands")
        if not (16 <= width <= 7680 and 16 <= height <= 4320):
            raise wrong("must be at least 16x16 and at most 7680x4320")
        return size

    @field_validator("lead_in", "hold")
    @classmethod
    def _is_waited_for(cls, seconds: float) -> float:
        if seconds > 60:
            raise wrong("must be at most 60 s")
        return seconds

    @property
    def pixels(self) -> tuple[int, int]:
        """Width and height."""
        width, height = self.size.split("x")
        return int(width), int(height)
