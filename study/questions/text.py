"""Write a few words or sentences."""

from __future__ import annotations

import random
from collections.abc import Mapping
from typing import ClassVar

from pydantic import Field

from study.questions.question import AnswerError, Question
from study.text import Text
from study.written import AN_ITEM


class FreeText(Question):
    """A field for words of one's own."""

    kind: ClassVar[str] = "text"
    item: str = Field(pattern=AN_ITEM)
    longest: int = Field(2000, ge=1, le=10_000)  # characters

    @property
    def items(self) -> Mapping[str, Text]:
        """The one text."""
        return {self.item: self.text}

    def _check_value(self, item: str, answer: str) -> None:
        if len(answer) > self.longest:
            raise AnswerError(f"{item}: {len(answer)} characters are too many; {self.longest} fit")

    def guess(self, rng: random.Random) -> str:
        """A remark that exports badly where exports are careless."""
        remarks = (
            "It waved, and nodded.",
            'He said "hello";\nthen he left.',
            "=1+1",
            "Schön – très naturel!",
        )
        return rng.choice(remarks)[: self.longest]
