"""Prefer one of two clips that are shown side by side: which looks happier?"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import ClassVar, Self

from pydantic import Field, PrivateAttr

from study.questions.question import Question
from study.text import Text
from study.written import AN_ITEM


class Prefer(Question):
    """A paired comparison, answered by the id of the stimulus that was chosen. For parts with `pairs`."""

    kind: ClassVar[str] = "prefer"
    item: str = Field("preferred", pattern=AN_ITEM)

    _stimuli: tuple[str, ...] = PrivateAttr(())

    @property
    def items(self) -> Mapping[str, Text]:
        """The one choice."""
        return {self.item: self.text}

    @property
    def values(self) -> Mapping[str, Text]:
        """The stimuli one can choose among: of a page its two, of a part all."""
        return {stimulus: Text(stimulus) for stimulus in self._stimuli}

    @property
    def answering(self) -> str:
        """Which of the two."""
        return "by choosing one of the two videos, which stood left and right equally often"

    def among(self, stimuli: Sequence[str]) -> Self:
        """The same question about these stimuli, on a page the left one and the right one."""
        question = self.model_copy()
        question._stimuli = tuple(stimuli)
        return question
