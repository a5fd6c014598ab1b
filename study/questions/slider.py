"""Place a mark on a line between two ends: a visual analogue scale."""

from __future__ import annotations

from typing import ClassVar

from study.questions.scale import Rating


class Slider(Rating):
    """One line per item, answered by whole numbers from 0 to 100. No mark is there before one is made."""

    kind: ClassVar[str] = "slider"

    @property
    def scale(self) -> tuple[int, int]:
        """The left and the right end."""
        return 0, 100

    @property
    def answering(self) -> str:
        """The line's ends."""
        return f"on a line from {self.ends[0].in_('en')} (0) to {self.ends[1].in_('en')} (100)"
