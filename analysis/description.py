"""Answers that no hypothesis is about: means where they are numbers, else how often each was given."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from analysis.dataset import Answers
from analysis.plan import Findings
from analysis.statistics.samples import Moments, moments


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


def described(findings: Findings) -> Iterator[Means | Counts]:
    """Every question without a hypothesis, and the scores of every series."""
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
