"""Pick one of a list of options, as small buttons or a list: gender, first language, field of study."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar

from pydantic import Field

from study.questions.question import Question
from study.text import NamedTexts, Text


class Select(Question):
    """One of several options, always in the order written."""

    kind: ClassVar[str] = "select"
    item: str = Field(pattern=r"^[a-z][a-z0-9_]*$")
    options: NamedTexts = Field(min_length=2)

    @property
    def items(self) -> Mapping[str, Text]:
        """The one choice."""
        return {self.item: self.text}

    @property
    def values(self) -> Mapping[str, Text]:
        """The options."""
        return self.options

    @property
    def option_orders(self) -> tuple[tuple[str, ...], ...]:
        """As written."""
        return (tuple(self.options),)
