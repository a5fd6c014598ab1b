"""Give a number, such as an age."""

from __future__ import annotations

import random
import re
from collections.abc import Mapping
from typing import ClassVar

from pydantic import Field, model_validator

from study.questions.question import AnswerError, Question
from study.text import Text
from study.written import AN_ITEM, wrong_at


class Number(Question):
    """A field for a number with its bounds and unit."""

    kind: ClassVar[str] = "number"
    item: str = Field(pattern=AN_ITEM)
    least: float | None = None
    most: float | None = None
    whole: bool = False
    unit: Text | None = None

    @model_validator(mode="after")
    def _bounds_leave_room(self) -> Number:
        if self.least is not None and self.most is not None and self.most < self.least:
            raise wrong_at(("most",), f"must not be less than least ({self.least:g})", self.most)
        return self

    @property
    def items(self) -> Mapping[str, Text]:
        """The one number."""
        return {self.item: self.text}

    @property
    def answering(self) -> str:
        """Which numbers."""
        least = "" if self.least is None else f" from {self.least:g}"
        most = "" if self.most is None else f" to {self.most:g}"
        return f"by a {'whole ' if self.whole else ''}number{least}{most}"

    def _check_value(self, item: str, answer: str) -> None:
        if not re.fullmatch(r"-?[0-9]{1,15}" if self.whole else r"-?[0-9]{1,15}(\.[0-9]{1,15})?", answer):
            raise AnswerError(f"{item}: {answer!r} is not a {'whole ' if self.whole else ''}number")
        if self.least is not None and float(answer) < self.least:
            raise AnswerError(f"{item}: {answer} is less than {self.least:g}")
        if self.most is not None and float(answer) > self.most:
            raise AnswerError(f"{item}: {answer} is more than {self.most:g}")

    def guess(self, rng: random.Random) -> str:
        """A whole number within the bounds, more often near the lower one: 18 to 65 years, mostly young."""
        least = 0 if self.least is None else self.least
        most = least + 47 if self.most is None else min(self.most, least + 47)
        return str(round(least + (most - least) * rng.betavariate(1.3, 3.0)))
