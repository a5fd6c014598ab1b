"""Answers that no test is about: numbers, words of one's own, and what participants say of themselves."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from analysis.rows import Rows, among
from study.questions.number import Number
from study.questions.text import FreeText

if TYPE_CHECKING:
    from study.protocol import Protocol
    from study.questions import Question

ABOUT_PARTICIPANTS = "demographics"  # the part of answers that are about no clip


@dataclass(frozen=True)
class OpenAnswers:
    """The answers to one item, asked about one clip or about participants themselves."""

    part: str
    stimulus: str  # empty where it is about participants themselves
    item: str
    kind: str  # number, text, or that of a question with options
    options: tuple[str, ...]
    given: tuple[str, ...]  # by participant; empty for none

    def of_participants(self, kept: NDArray[np.bool_]) -> OpenAnswers:
        """The same with fewer participants."""
        given = tuple(answer for answer, keep in zip(self.given, kept, strict=True) if keep)
        return OpenAnswers(self.part, self.stimulus, self.item, self.kind, self.options, given)

    @property
    def numbers(self) -> NDArray[np.float64]:
        """The numbers given."""
        return np.array([float(answer.replace(",", ".")) for answer in self.given if answer])


def open_answers(rows: Rows, protocol: Protocol) -> Iterator[OpenAnswers]:
    """The answers to every number and text, and to the questions about participants; none where none came.

    Raises ResponsesError where a number is none or an answer is given twice.
    """
    for part, stimulus, question in _asked(protocol):
        for item in question.items:
            if stimulus not in rows.names("stimulus") or item not in rows.names("item"):
                continue
            mine = (rows.codes("stimulus", {stimulus: 0}) == 0) & (rows.codes("item", {item: 0}) == 0)
            mine &= rows.person >= 0
            if "part" in rows.columns:
                mine &= rows.codes("part", {part: 0}) == 0
            if mine.any():
                yield _answers(rows, mine, part, stimulus, item, question)


def _asked(protocol: Protocol) -> Iterator[tuple[str, str, Question]]:
    """Part, stimulus and question of whatever no test is about."""
    for question in protocol.demographics:
        yield ABOUT_PARTICIPANTS, "", question
    for part in protocol.parts.values():
        for question in part.questions:
            if isinstance(question, Number | FreeText):
                for stimulus in part.stimuli:
                    yield part.id, stimulus, question


def _answers(
    rows: Rows, mine: NDArray[np.bool_], part: str, stimulus: str, item: str, question: Question
) -> OpenAnswers:
    people = rows.person[mine]
    rows.refuse_second(mine, people.astype(np.int64), len(rows.participants))
    column = rows.columns["response"]
    codes = column.codes[mine]
    if isinstance(question, Number):
        is_none = np.array([not _is_number(column.values[code]) for code in codes], dtype=bool)
        rows.refuse_if(
            among(mine, is_none),
            lambda row: f"response {rows.value('response', row)!r} to {item} is not a number",
        )
    given = [""] * len(rows.participants)
    for person, code in zip(people, codes, strict=True):
        given[person] = column.values[code]
    options = tuple(question.values or ())
    return OpenAnswers(part, stimulus, item, question.kind, options, tuple(given))


def _is_number(answer: str) -> bool:
    try:
        return not answer or bool(np.isfinite(float(answer.replace(",", "."))))
    except ValueError:
        return False
