"""Check that somebody is attending: a question whose answer is given in its words."""

from __future__ import annotations

import random
from collections.abc import Mapping
from typing import Annotated, Any, ClassVar

from pydantic import Field, model_validator

from stimuli.errors import nearest
from study.questions.choice import Choice
from study.written import AN_ITEM, wrong_at


class Attention(Choice):
    """“Please choose ‘strongly’ here.”, on every page of the part or on some (`at: [4, 9]`, counted from 1).

    Wrong answers are kept; `participants: {exclude: {failed_attention: 2}}` counts them.
    """

    kind: ClassVar[str] = "attention"
    item: str = Field("attention", pattern=AN_ITEM)
    expected: str
    at: tuple[Annotated[int, Field(ge=1)], ...] | None = Field(None, min_length=1)  # trials; all, unless told

    @model_validator(mode="before")
    @classmethod
    def _expected_as_text(cls, value: Any) -> Any:
        """Options may look like numbers: `options: [1, 2, 3], expected: 2`."""
        if isinstance(value, Mapping) and isinstance(value.get("expected"), int):
            return {**value, "expected": str(value["expected"])}
        return value

    @model_validator(mode="after")
    def _can_be_passed(self) -> Attention:
        if self.expected not in self.options:
            message = f"is no option; {nearest(self.expected, self.options)}"
            raise wrong_at(("expected",), message, self.expected)
        return self

    @property
    def answering(self) -> str:
        """The options, and which was asked for."""
        trials = f" on trial {' and '.join(map(str, self.at))}" if self.at else ""
        passed = self.options[self.expected].in_("en")
        return f"{super().answering}; an attention check{trials}, passed by “{passed}”"

    def asked_at(self, trial: int) -> bool:
        """Whether it stands on the page of this trial, counted from 1; 0 is practice."""
        return self.at is None or trial in self.at

    def passed(self, answer: str) -> bool:
        """Whether this is the answer that was asked for."""
        return answer == self.expected

    def simulate(self, rng: random.Random, _target: str | None = None, effect: float = 1.0) -> dict[str, str]:
        """Whoever sees the stimuli reads the question too; others hit the answer by chance."""
        answer = self.expected if rng.random() < 0.3 + 0.7 * effect else self.guess(rng)
        return {self.item: answer}

    def codebook(self, language: str = "en") -> list[dict[str, Any]]:
        """As for every question, and the answer that was asked for."""
        return [entry | {"expected": self.expected} for entry in super().codebook(language)]
