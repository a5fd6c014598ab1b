"""What participants see: one motion of one gesture."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from stimuli.principles import Modulation

Alike = Literal["gesture", "modulation", "principle", "level"]


@dataclass(frozen=True)
class Stimulus:
    """One motion to be seen: a gesture under a modulation."""

    id: str
    gesture: str
    modulation: Modulation
    part: str
    name: str | None = None  # of the modulation, where it has one
    principle: str | None = None
    level: str | None = None

    @property
    def condition(self) -> str | None:
        """The level or the modulation: what hypotheses and pairs compare."""
        return self.level or self.name

    def feature(self, alike: Alike) -> str | None:
        """What this stimulus has in common with others."""
        return {
            "gesture": self.gesture,
            "modulation": self.name,
            "principle": self.principle,
            "level": self.level,
        }[alike]
