"""Rate one or more items on a scale of points, such as 1 (not at all) to 5 (very strongly)."""

from __future__ import annotations

import random
from collections.abc import Mapping
from typing import ClassVar, Literal

from pydantic import Field

from study.questions.question import Question
from study.text import Ends, NamedTexts, Text


class Rate(Question):
    """A grid: one row per item, one column per point, the ends labelled."""

    kind: ClassVar[str] = "rate"
    written_items: NamedTexts = Field(alias="items", min_length=1)
    points: int = Field(5, ge=2, le=11)
    ends: Ends
    item_order: Literal["fixed", "shuffled"] = "fixed"  # shuffled: once per participant, then the same

    @property
    def items(self) -> Mapping[str, Text]:
        """The rated items."""
        return self.written_items

    @property
    def scale(self) -> tuple[int, int]:
        """Lowest and highest point."""
        return 1, self.points

    @property
    def values(self) -> Mapping[str, Text]:
        """The points "1" to "5"; only the ends bear a label."""
        labels = {1: self.ends[0], self.points: self.ends[1]}
        return {str(point): labels.get(point, Text(str(point))) for point in range(1, self.points + 1)}

    @property
    def shuffles_items(self) -> bool:
        """Whether the rows are shuffled for each participant."""
        return self.item_order == "shuffled"

    def simulate(self, rng: random.Random, target: str | None = None, effect: float = 1.0) -> dict[str, str]:
        """Rate the target high and the rest low, as a rounded normal judgement."""
        middle, width = (1 + self.points) / 2, (self.points - 1) / 4
        answers = {}
        for item in self.items:
            lean = 0.0 if target is None else effect * (0.9 if item == target else -0.9)
            judgement = rng.gauss(middle + lean * width, width)
            answers[item] = str(min(max(round(judgement), 1), self.points))
        return answers
