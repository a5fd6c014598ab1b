"""Choose one of a few options, as large buttons: lower or higher, this or that."""

from __future__ import annotations

from typing import ClassVar, Literal

from pydantic import Field

from study.designs import williams
from study.questions.choice import Choice
from study.written import AN_ITEM


class Choose(Choice):
    """A forced choice. With balanced sides each option stands in each place for equally many participants."""

    kind: ClassVar[str] = "choose"
    item: str = Field("choice", pattern=AN_ITEM)
    sides: Literal["fixed", "balanced"] = "fixed"

    @property
    def option_orders(self) -> tuple[tuple[str, ...], ...]:
        """As written, or the rows of a balanced square."""
        options = tuple(self.options)
        if self.sides == "fixed":
            return (options,)
        return tuple(tuple(options[place] for place in row) for row in williams(len(options)))
