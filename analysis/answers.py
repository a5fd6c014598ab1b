"""The answers to a question, as an array: participants by stimuli by items."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from study.protocol.parts import series_of
from study.questions.attention import Attention

if TYPE_CHECKING:
    from study.protocol import Protocol

FloatArray = NDArray[np.float64]
Codes = NDArray[np.int8]

MISSING = -1  # among codes: no answer


@dataclass(frozen=True)
class Answers:
    """The answers to one question of one part."""

    part: str
    participants: tuple[str, ...]
    stimuli: tuple[str, ...]
    items: tuple[str, ...]
    options: tuple[str, ...]
    codes: Codes  # (participants, stimuli, items) index of the option, −1: none; in memory item by item
    expected: str | None = None  # of an attention check: the answer asked for
    shown: int | None = None  # stimuli that one participant sees, where those are not all
    optional: bool = False  # whether one may finish without: by choice, or spared by earlier answers
    series: Mapping[str, tuple[str, ...]] = field(default_factory=dict)  # scales, scored by the mean of items

    @property
    def scale(self) -> tuple[float, float] | None:
        """Lowest and highest option as numbers, or None where options are not numbers."""
        try:
            numbers = [float(option) for option in self.options]
        except ValueError:
            return None
        return min(numbers), max(numbers)

    @cached_property
    def ratings(self) -> FloatArray:
        """The answers as numbers, (participants, stimuli, items), NaN where there is none."""
        return np.array([*map(float, self.options), np.nan])[self.codes]

    @cached_property
    def mean(self) -> float | None:
        """The mean of all ratings; None without any."""
        there = self.ratings.T[~np.isnan(self.ratings.T)]
        return float(there.mean()) if there.size else None

    def chose(self, option: str) -> FloatArray:
        """1 where that option was chosen, 0 where another was, NaN without answer; shaped as `codes`."""
        numbers = [float(candidate == option) for candidate in self.options]
        return np.array([*numbers, np.nan])[self.codes]

    def on(self, item: str, outcome: str | None = None) -> FloatArray:
        """Answers on an item as numbers, or whether they are `outcome`; of a series the mean of its items.

        (participants, stimuli), NaN where one is missing.
        """
        values = self.ratings if outcome is None else self.chose(outcome)
        places = [self.items.index(one) for one in self.series.get(item, (item,))]
        mean: FloatArray = values[:, :, places].mean(axis=2)
        return mean

    def of_participants(self, kept: NDArray[np.bool_]) -> Answers:
        """The same question with fewer participants."""
        names = tuple(name for name, keep in zip(self.participants, kept, strict=True) if keep)
        return replace(self, participants=names, codes=self.codes.T[..., kept].T)


def unanswered(protocol: Protocol, participants: tuple[str, ...]) -> list[Answers]:
    """Every question with options that the protocol asks, without codes as yet."""
    return [
        Answers(
            part=part.id,
            participants=participants,
            stimuli=part.stimuli,
            items=tuple(question.items),
            options=tuple(question.values),
            codes=np.empty((0, 0, 0), dtype=np.int8),
            expected=question.expected if isinstance(question, Attention) else None,
            shown=part.shown,
            optional=question.optional or bool(part.only_if),
            series=series_of((question,)),
        )
        for part in protocol.parts.values()
        for question in part.questions
        if question.values
    ]
