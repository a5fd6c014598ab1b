"""Choose one of a few options, as large buttons: lower or higher, this or that."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar, Literal

from pydantic import Field

from study.designs import williams
from study.questions.question import Question
from study.text import NamedTexts, Text


class Choose(Question):
    """A forced choice. With balanced sides each option stands in each place for equally many participants."""

    kind: ClassVar[str] = "choose"
    item: str = Field("choice", pattern=r"^[a-z][a-z0-9_]*$")
    options: NamedTexts = Field(min_length=2)
    sides: Literal["fixed", "balanced"] = "fixed"

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
        """As written, or the rows of a balanced square."""
        options = tuple(self.options)
        if self.sides == "fixed":
            return (options,)
        return tuple(tuple(options[place] for place in row) for row in williams(len(options)))
