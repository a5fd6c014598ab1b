"""Bring things into an order: 1 for the one that fits best, each rank given once."""

from __future__ import annotations

import random
from collections.abc import Mapping
from functools import cached_property
from typing import ClassVar, Literal

from pydantic import Field

from study.questions.question import AnswerError, Question
from study.text import NamedTexts, Text


class Rank(Question):
    """A grid of items by ranks; a rank given anew is taken from whoever had it."""

    kind: ClassVar[str] = "rank"
    written_items: NamedTexts = Field(alias="items", min_length=2)
    item_order: Literal["fixed", "shuffled"] = "fixed"  # shuffled: once per participant, then the same

    @property
    def items(self) -> Mapping[str, Text]:
        """What is ranked."""
        return self.written_items

    @cached_property
    def values(self) -> Mapping[str, Text]:
        """The ranks, "1" being the first."""
        return {str(rank): Text(str(rank)) for rank in range(1, len(self.items) + 1)}

    @property
    def shuffles_items(self) -> bool:
        """Whether the rows are shuffled for each participant."""
        return self.item_order == "shuffled"

    @property
    def answering(self) -> str:
        """The ranks."""
        return f"by ranks from 1 to {len(self.items)}, each given once"

    def check(self, answers: Mapping[str, str]) -> None:
        """Each rank once; a question that is left out is left out whole."""
        super().check(answers)
        given = [answer for item in self.items if (answer := answers.get(item))]
        for rank in given:
            if given.count(rank) > 1:
                raise AnswerError(f"rank {rank} is given {given.count(rank)} times; each is given once")
        if given and len(given) < len(self.items):
            raise AnswerError(f"{len(given)} of {len(self.items)} are ranked; rank all or none")

    def straight_lined(self) -> dict[str, str]:
        """The order written, as by somebody who does not care."""
        return dict(zip(self.items, self.values, strict=True))

    def simulate(self, rng: random.Random, target: str | None = None, effect: float = 1.0) -> dict[str, str]:
        """A random order, the target often put first."""
        order = rng.sample(tuple(self.items), len(self.items))
        if target in order and rng.random() < 0.7 * effect:
            order.remove(target)
            order.insert(0, target)
        return {item: str(order.index(item) + 1) for item in self.items}
