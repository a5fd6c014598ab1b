"""What a file of responses calls the names of a study."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from analysis.answers import MISSING, Answers

if TYPE_CHECKING:
    from analysis.columns import Column
    from study.protocol import Protocol

UNKNOWN = MISSING - 1  # an answer that is no option


@dataclass(frozen=True)
class Naming:
    """How to find our names in a file: each mapping is from ours to theirs."""

    columns: Mapping[str, str] = field(default_factory=dict)
    stimuli: Mapping[str, str] = field(default_factory=dict)
    items: Mapping[str, str] = field(default_factory=dict)
    answers: Mapping[str, Mapping[str, Sequence[str]]] = field(default_factory=dict)  # by part or item

    @classmethod
    def of(cls, protocol: Protocol, columns: Mapping[str, str]) -> Naming:
        """As the protocol has it; `columns` are said elsewhere and come first."""
        said = protocol.analysis.responses
        return cls({**said.columns, **columns}, said.stimuli, said.items, said.answers)

    def ours(self, name: str, column: Column) -> Column:
        """A column of the file with our names for stimuli or items."""
        theirs = {"stimulus": self.stimuli, "item": self.items}.get(name, {})
        names = {their: our for our, their in theirs.items()}
        return column.renamed(names) if names else column

    def spellings(self, stimulus: str, item: str, *, alone: bool) -> list[str]:
        """What the column of an answer may be called; the stimulus alone where it has but one item."""
        theirs, item = self.stimuli.get(stimulus, stimulus), self.items.get(item, item)
        return [f"{theirs}_{item}", *([theirs] if alone else [])]

    def options(self, question: Answers) -> dict[str, int]:
        """What stands in the file for each option, and its place; what stands for no answer is at −1."""
        said = dict(self.answers.get(question.part, {}))
        for item in question.items:
            said |= self.answers.get(item, {})
        places = {code: place for place, option in enumerate(question.options)
                  for code in said.get(option, (option,))}  # fmt: skip
        return dict.fromkeys(("", *said.get("", ())), MISSING) | places


def option_of(answer: str, options: Mapping[str, int]) -> int:
    """Which option an answer is; a number may be written 4, 4.0 or 4,0."""
    if answer in options:
        return options[answer]
    try:
        number = float(answer.replace(",", "."))
    except ValueError:
        return UNKNOWN
    return next((at for option, at in options.items() if _is(option, number)), UNKNOWN)


def _is(option: str, number: float) -> bool:
    try:
        return float(option) == number
    except ValueError:
        return False
