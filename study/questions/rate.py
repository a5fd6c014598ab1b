"""Rate one or more items on a scale of points, such as 1 (not at all) to 5 (very strongly)."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property
from typing import ClassVar

from pydantic import Field

from study.questions.scale import Scale
from study.text import Ends, NamedTexts, Text


class Rate(Scale):
    """A grid: one row per item, one column per point, the ends labelled."""

    kind: ClassVar[str] = "rate"
    items_field: ClassVar[str] = "items"
    written_items: NamedTexts = Field(alias="items", min_length=1)
    ends: Ends

    @property
    def items(self) -> Mapping[str, Text]:
        """The rated items."""
        return self.written_items

    @cached_property
    def values(self) -> Mapping[str, Text]:
        """The points "1" to "5"; only the ends bear a label."""
        labels = {1: self.ends[0], self.points: self.ends[1]}
        return {str(point): labels.get(point, Text(str(point))) for point in range(1, self.points + 1)}
