"""Place a mark on a line between two ends: a visual analogue scale."""

from __future__ import annotations

import random
from collections.abc import Mapping
from functools import cached_property
from typing import ClassVar

from pydantic import Field

from study.questions.question import Question
from study.text import Ends, NamedTexts, Text

LONGEST = 100  # the right end; the left one is 0


class Slider(Question):
    """One line per item, answered by whole numbers from 0 to 100. No mark is there before one is made."""

    kind: ClassVar[str] = "slider"
    written_items: NamedTexts = Field(alias="items", min_length=1)
    ends: Ends

    @property
    def items(self) -> Mapping[str, Text]:
        """What is placed."""
        return self.written_items

    @cached_property
    def values(self) -> Mapping[str, Text]:
        """The places "0" to "100"; only the ends bear a label."""
        labels = {0: self.ends[0], LONGEST: self.ends[1]}
        return {str(place): labels.get(place, Text(str(place))) for place in range(LONGEST + 1)}

    def simulate(self, rng: random.Random, target: str | None = None, effect: float = 1.0) -> dict[str, str]:
        """Place the target to the right and the rest to the left, as a normal judgement."""
        answers = {}
        for item in self.items:
            lean = 0.0 if target is None else effect * (22 if item == target else -22)
            answers[item] = str(min(max(round(rng.gauss(50 + lean, 22)), 0), LONGEST))
        return answers
