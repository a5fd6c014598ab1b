"""How participants answered: how fast, and how much their answers differ."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from analysis.answers import Answers, FloatArray
from analysis.dataset import Responses
from analysis.exclusions import gave_one_answer

BARS = 24


@dataclass(frozen=True)
class Spread:
    """Numbers of which each is one participant's."""

    n: int
    median: float
    least: float
    most: float


@dataclass(frozen=True)
class Pace:
    """Seconds per answer, each participant's median."""

    seconds: Spread
    participants: tuple[int, ...]  # how many from the least to the most, in equal steps of the logarithm


@dataclass(frozen=True)
class Variety:
    """How much a participant's own ratings differ.

    Their SD is the intra-individual response variability (Dunn et al. 2018, J. Bus. Psychol. 33).
    """

    part: str
    sd: Spread
    one_answer: int  # participants who gave the same to everything


def pace(responses: Responses) -> Pace | None:
    """How fast participants answered; None where the file does not say."""
    if responses.median_rt_s is None or not (spread := _spread(responses.median_rt_s)):
        return None
    times = np.log(np.maximum(responses.median_rt_s[~np.isnan(responses.median_rt_s)], 1e-3))
    return Pace(spread, tuple(np.histogram(times, BARS)[0].tolist()))


def varieties(responses: Responses) -> Iterator[Variety]:
    """Of each question with several rated items."""
    for question in responses.questions:
        if len(question.items) > 1 and question.scale and (sd := _spread(_own_sd(question))):
            yield Variety(question.part, sd, int(gave_one_answer(question).sum()))


def _own_sd(question: Answers) -> FloatArray:
    """Standard deviation of each participant's ratings (participants,), NaN of fewer than two."""
    people = np.arange(len(question.participants))
    given = np.zeros((people.size, len(question.options) + 1), dtype=np.int32)  # the last: no answer
    _, stimuli, items = question.codes.shape
    for column in question.codes.reshape(people.size, stimuli * items).T:
        given[people, column] += 1
    counts, points = given[:, :-1], np.array([float(option) for option in question.options])
    n = counts.sum(axis=1)
    squares = counts @ points**2 - (counts @ points) ** 2 / np.maximum(n, 1)
    sd: FloatArray = np.where(n > 1, np.sqrt(np.maximum(squares, 0) / np.maximum(n - 1, 1)), np.nan)
    return sd


def _spread(values: FloatArray) -> Spread | None:
    there = values[~np.isnan(values)]
    if there.size == 0:
        return None
    return Spread(there.size, float(np.median(there)), float(there.min()), float(there.max()))
