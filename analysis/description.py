"""Answers that no hypothesis is about: means where they are numbers, else how often each was given.

Of words of one's own only how many wrote something: they are to be read, in the file of responses.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from analysis.answers import Answers
from analysis.open_answers import OpenAnswers
from analysis.plan import Findings
from analysis.statistics.samples import Moments, moments

Spread = tuple[Moments, int, float | None, float | None, float | None]  # with n, median, least and most


@dataclass(frozen=True)
class Means:
    """Of each clip the mean of every item, or of every series of items."""

    part: str
    columns: tuple[str, ...]
    rows: Mapping[str, tuple[Moments, ...]]  # by stimulus
    says: str = "mean (SD)"


@dataclass(frozen=True)
class Counts:
    """How often each answer was given."""

    part: str
    columns: tuple[str, ...]
    rows: Mapping[str, tuple[int, ...]]  # by stimulus, and item where there are several
    says: str = "how many gave each answer"


@dataclass(frozen=True)
class Numbers:
    """Numbers that were asked for."""

    part: str
    rows: Mapping[str, Spread]  # by stimulus and item
    columns: tuple[str, ...] = ("mean (SD)", "n", "median", "least", "most")
    says: str = "numbers"


@dataclass(frozen=True)
class Written:
    """How many wrote something in words of their own."""

    part: str
    rows: Mapping[str, tuple[int, ...]]  # by stimulus and item
    columns: tuple[str, ...] = ("written", "left empty")
    says: str = "answers in words; they stand in the file of responses"


def described(findings: Findings) -> Iterator[Means | Counts | Numbers | Written]:
    """Every question without a hypothesis, and the scores of every series."""
    yield from opened(findings.responses.open)
    tested = {(outcome.part, outcome.answers.items) for outcome in findings.outcomes.values()}
    for answers in findings.responses.questions:
        if answers.series:
            yield means(answers, tuple(answers.series))
        elif (answers.part, answers.items) not in tested:
            yield means(answers, answers.items) if answers.scale else counts(answers)


def means(answers: Answers, columns: tuple[str, ...]) -> Means:
    """Mean and spread of items or series, by clip."""
    values = [answers.on(column) for column in columns]  # of (participants, stimuli)
    return Means(
        answers.part,
        columns,
        {s: tuple(moments(value[:, at]) for value in values) for at, s in enumerate(answers.stimuli)},
    )


def counts(answers: Answers) -> Counts:
    """How often each option was chosen, by clip."""
    several = len(answers.items) > 1
    given = {
        f"{stimulus}: {item}" if several else stimulus: answers.codes[:, s, i]
        for s, stimulus in enumerate(answers.stimuli)
        for i, item in enumerate(answers.items)
    }
    options = range(len(answers.options))
    return Counts(
        answers.part,
        answers.options,
        {row: tuple(int(np.sum(codes == option)) for option in options) for row, codes in given.items()},
    )


def opened(answers: Sequence[OpenAnswers]) -> Iterator[Counts | Numbers | Written]:
    """Numbers, words, and what participants say of themselves, part by part."""
    for part in dict.fromkeys(one.part for one in answers):
        here = {" ".join(filter(None, (one.stimulus, one.item))): one for one in answers if one.part == part}
        if numbers := {row: _spread(one) for row, one in here.items() if one.kind == "number"}:
            yield Numbers(part, numbers)
        if texts := {row: one.given for row, one in here.items() if one.kind == "text"}:
            yield Written(
                part, {row: (len(given) - given.count(""), given.count("")) for row, given in texts.items()}
            )
        for row, one in here.items():
            if one.options:
                yield Counts(part, one.options, {row: tuple(map(one.given.count, one.options))})


def _spread(answers: OpenAnswers) -> Spread:
    x = answers.numbers
    if x.size == 0:
        return moments(x), 0, None, None, None
    return moments(x), x.size, float(np.median(x)), float(x.min()), float(x.max())
