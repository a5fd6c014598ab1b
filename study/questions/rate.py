"""Rate one or more items on a scale of points, such as 1 (not at all) to 5 (very strongly)."""

from __future__ import annotations

from typing import ClassVar

from pydantic import Field

from study.questions.scale import Rating


class Rate(Rating):
    """A grid: one row per item, one column per point, the ends labelled."""

    kind: ClassVar[str] = "rate"
    points: int = Field(5, ge=2, le=11)

    @property
    def scale(self) -> tuple[int, int]:
        """Lowest and highest point."""
        return 1, self.points
