"""What choosing, selecting and attention checks share: one item, answered by one of a few options."""

from __future__ import annotations

from collections.abc import Mapping

from pydantic import Field

from study.questions.question import Question
from study.text import NamedTexts, Text
from study.written import AN_ITEM


class Choice(Question):
    """One of several options, in the order written."""

    item: str = Field(pattern=AN_ITEM)
    options: NamedTexts = Field(min_length=2)

    @property
    def items(self) -> Mapping[str, Text]:
        """The one choice."""
        return {self.item: self.text}

    @property
    def values(self) -> Mapping[str, Text]:
        """The options."""
        return self.options
