"""Place something between pairs of opposites: Fake 1 2 3 4 5 Natural."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property
from typing import ClassVar

from pydantic import Field

from study.questions.scale import Scale
from study.text import Ends, Text


class Differential(Scale):
    """Rows of opposites; the left one is 1."""

    kind: ClassVar[str] = "differential"
    items_field: ClassVar[str] = "pairs"
    points: int = Field(5, ge=2, le=11)
    pairs: dict[str, Ends] = Field(min_length=1)

    @property
    def scale(self) -> tuple[int, int]:
        """Lowest and highest point."""
        return 1, self.points

    @cached_property
    def items(self) -> Mapping[str, Text]:
        """The pairs, written Left – Right."""
        return {item: _joined(left, right) for item, (left, right) in self.pairs.items()}


def _joined(left: Text, right: Text) -> Text:
    languages = dict.fromkeys([*left.root, *right.root])
    return Text({language: f"{left.in_(language)} – {right.in_(language)}" for language in languages})
