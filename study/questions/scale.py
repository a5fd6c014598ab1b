"""What rating, differentials and sliders share: items on one scale, and series scored by their means.

`set: godspeed` or `set: rosas` brings the items of a published questionnaire, `set: godspeed animacy` one of
its series (study/defaults/sets/).
"""

from __future__ import annotations

import random
from abc import abstractmethod
from collections.abc import Mapping
from functools import cached_property
from typing import Any, ClassVar, Literal

from pydantic import Field, model_validator

from stimuli.errors import nearest
from study.questions.question import Question
from study.questions.sets import question_sets
from study.text import Ends, NamedTexts, Text
from study.written import wrong_at


class Scale(Question):
    """Items that are all answered by a whole number between the same two ends."""

    items_field: ClassVar[str]  # where a protocol writes the items, and a set brings them

    set: str | None = None
    series: dict[str, str] = Field(default_factory=dict)  # item → the scale it is scored in
    item_order: Literal["fixed", "shuffled"] = "fixed"  # shuffled: once per participant, then the same

    @model_validator(mode="before")
    @classmethod
    def _from_a_set(cls, value: Any) -> Any:
        name = value.get("set") if isinstance(value, Mapping) else None
        if name is None:
            return value
        sets = {known: one for known, one in question_sets().items() if one.kind == cls.kind}
        if not isinstance(name, str):
            raise wrong_at(("set",), "must be the name of a set of questions", name)
        if name not in sets:
            raise wrong_at(("set",), f"is no set of questions here; {nearest(name, sets)}", name)
        chosen = sets[name]
        return {**chosen.fields, cls.items_field: chosen.items, "series": chosen.series, **value}

    @property
    def unpublished(self) -> tuple[str, ...]:
        """The languages in which its set is our own translation, not a published one."""
        return question_sets()[self.set].unpublished if self.set else ()

    @property
    @abstractmethod
    def scale(self) -> tuple[int, int]:
        """Lowest and highest number."""

    @property
    def labels(self) -> Mapping[int, Text]:
        """What numbers are called, where not by themselves."""
        return {}

    @cached_property
    def values(self) -> Mapping[str, Text]:
        """The numbers, from the lowest."""
        lowest, highest = self.scale
        labels = self.labels
        return {str(n): labels.get(n, Text(str(n))) for n in range(lowest, highest + 1)}

    @property
    def shuffles_items(self) -> bool:
        """Whether the rows are shuffled for each participant."""
        return self.item_order == "shuffled"

    def simulate(self, rng: random.Random, target: str | None = None, effect: float = 1.0) -> dict[str, str]:
        """Rate the target high and the rest low, as a rounded normal judgement."""
        lowest, highest = self.scale
        middle, width = (lowest + highest) / 2, (highest - lowest) / 4
        answers = {}
        for item in self.items:
            lean = 0.0 if target is None else effect * (0.9 if item == target else -0.9)
            judgement = rng.gauss(middle + lean * width, width)
            answers[item] = str(min(max(round(judgement), lowest), highest))
        return answers

    def codebook(self, language: str = "en") -> list[dict[str, Any]]:
        """As for every question, and the series each item is scored in."""
        return [entry | {"series": self.series.get(entry["item"])} for entry in super().codebook(language)]

    def scores(self, answers: Mapping[str, str]) -> dict[str, float]:
        """The mean of each series over its answered items; series without an answer are left out."""
        given: dict[str, list[int]] = {}
        for item, series in self.series.items():
            if answers.get(item):
                given.setdefault(series, []).append(int(answers[item]))
        return {series: sum(points) / len(points) for series, points in given.items()}

    @property
    def answering(self) -> str:
        """The numbers, and what the ends are called."""
        lowest, highest = (f"{self.values[str(end)].in_('en')} ({end})" for end in self.scale)
        if not self.labels:
            lowest, highest = (str(end) for end in self.scale)
        return f"on {self.scale[1] - self.scale[0] + 1} points from {lowest} to {highest}"


class Rating(Scale):
    """Items between two labelled ends, as points or as a line."""

    items_field: ClassVar[str] = "items"
    written_items: NamedTexts = Field(alias="items", min_length=1)
    ends: Ends

    @property
    def items(self) -> Mapping[str, Text]:
        """What is rated."""
        return self.written_items

    @property
    def labels(self) -> Mapping[int, Text]:
        """Only the ends bear a label."""
        return dict(zip(self.scale, self.ends, strict=True))
