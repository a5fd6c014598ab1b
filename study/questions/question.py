"""What every kind of question can do: say its items, check and make answers, describe the data it yields."""

from __future__ import annotations

import random
from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from typing import Any, ClassVar, Self

from stimuli.errors import InputError, nearest
from study.text import Text
from study.written import Written


class AnswerError(InputError):
    """An answer that no form of this question could have sent."""


class Question(Written, ABC):
    """One question on a page. Answers are texts by item id; an item is what one answer is given to."""

    kind: ClassVar[str]
    text: Text
    optional: bool = False

    def __hash__(self) -> int:
        return id(self)  # the fields hold mappings; a question's HTML is made once and found by this

    @property
    @abstractmethod
    def items(self) -> Mapping[str, Text]:
        """What is answered: item ids and the texts beside them, in the order written."""

    @property
    def values(self) -> Mapping[str, Text] | None:
        """The answers an item can have, with their labels, in the order written; None where it is open."""
        return None

    def asked_at(self, trial: int) -> bool:  # noqa: ARG002
        """Whether it stands on the page of this trial of its part, counted from 1; 0 is practice."""
        return True

    def among(self, stimuli: Sequence[str]) -> Self:  # noqa: ARG002
        """The question as it is asked about stimuli that are compared; the same for all kinds but one."""
        return self

    def simulate(self, rng: random.Random, target: str | None = None, effect: float = 1.0) -> dict[str, str]:
        """Answer as a participant might.

        `target` is what the stimulus is meant to evoke: an item where items are rated, an answer where one
        is chosen. `effect` 0 answers by chance; 1 sees the target about as well as the paper's participants.
        """
        seen = self.values is not None and target in self.values and rng.random() < 0.7 * effect
        return {item: target if seen and target else self.guess(rng) for item in self.items}

    def straight_lined(self) -> dict[str, str]:
        """The last answer offered to every item, as by somebody who does not care."""
        return dict.fromkeys(self.items, list(self.values or ("",))[-1])

    def guess(self, rng: random.Random) -> str:
        """Any possible answer."""
        return rng.choice(tuple(self.values or ("",)))

    def check(self, answers: Mapping[str, str]) -> None:
        """Raise AnswerError unless there is one possible answer to each item, and to nothing else."""
        for item in answers:
            if item not in self.items:
                raise AnswerError(f"{item!r} is not asked here; {nearest(item, self.items)}")
        for item in self.items:
            answer = answers.get(item, "")
            if answer:
                self._check_value(item, answer)
            elif not self.optional:
                raise AnswerError(f"{item}: an answer is missing")

    def _check_value(self, item: str, answer: str) -> None:
        if self.values is not None and answer not in self.values:
            raise AnswerError(f"{item}: {answer!r} is no possible answer; {nearest(answer, self.values)}")

    @property
    def shuffles_items(self) -> bool:
        """Whether each participant gets an item order of their own, the same on every page."""
        return False

    @property
    def option_orders(self) -> tuple[tuple[str, ...], ...]:
        """The orders in which options are shown; participants are spread evenly over them."""
        return ((),)

    @property
    def answering(self) -> str:
        """How it is answered, in English words: “by a or b”."""
        if self.values is None:
            return "in free words"
        *others, last = (f"“{label.in_('en')}”" for label in self.values.values())
        return f"by {', '.join(others)} or {last}" if others else f"by {last}"

    @property
    def template(self) -> str:
        """Name of the HTML file beside this kind's Python file."""
        return f"{self.kind}.html"

    def codebook(self, language: str = "en") -> list[dict[str, Any]]:
        """One entry per item: what was asked, and what the answers mean."""
        values = None if self.values is None else {v: text.in_(language) for v, text in self.values.items()}
        return [
            {
                "item": item,
                "kind": self.kind,
                "question": self.text.in_(language),
                "label": label.in_(language),
                "values": values,
                "optional": self.optional,
            }
            for item, label in self.items.items()
        ]
