"""Does an answer depend on when it was given, or on what was seen just before?"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.special import fdtrc, stdtr

from analysis.statistics.samples import FloatArray, numbers

NOTHING = -1  # seen before the first


@dataclass(frozen=True)
class Position:
    """Change of the score per place later in the part."""

    n: int
    estimate: float | None
    se: float | None
    t: float | None
    df: int | None
    p: float | None  # two-sided
    reason: str | None = None


@dataclass(frozen=True)
class CarryOver:
    """Whether scores differ by the stimulus seen just before."""

    n: int
    f: float | None
    df: tuple[int, int] | None
    p: float | None
    reason: str | None = None


def position_effect(scores: ArrayLike, places: ArrayLike) -> Position:
    """The slope of scores on places, both (participants, stimuli), NaN where missing.

    Least squares with an effect for each participant and each stimulus. Agrees with R
    `lm(score ~ participant + stimulus + place)`.

    >>> scores = [[4, 3, 5], [5, 5, 2], [3, 2, 4], [4, 1, 2]]
    >>> places = [[1, 2, 3], [2, 3, 1], [3, 1, 2], [1, 3, 2]]
    >>> result = position_effect(scores, places)
    >>> round(result.estimate, 3), round(result.t, 3), round(result.p, 3)
    (0.433, 0.835, 0.442)
    """
    y, person, stimulus, place, _ = _long(scores, places)
    base, persons = _within(_dummies(stimulus), person)
    (x,), _ = _within(place[None], person)
    (centred,), _ = _within(y[None], person)
    slope = x - _fitted(base, x)
    df = y.size - persons - _rank(base) - 1
    if df < 1 or slope @ slope < 1e-9:
        return Position(y.size, None, None, None, None, None, "undefined: places and stimuli go together")
    estimate = float(slope @ centred / (slope @ slope))
    rest = centred - _fitted(base, centred) - estimate * slope
    se = float(np.sqrt(rest @ rest / df / (slope @ slope)))
    if se < 1e-12:
        return Position(y.size, estimate, None, None, df, None, "undefined: no variance is left")
    t = estimate / se
    return Position(y.size, estimate, se, t, df, float(2 * stdtr(df, -abs(t))))


def carry_over(scores: ArrayLike, places: ArrayLike) -> CarryOver:
    """The F-test of the stimulus seen just before, beyond participant, stimulus and place.

    First answers are left out. Agrees with R `anova(lm(score ~ participant + stimulus + place), lm(… +
    previous))`.
    """
    answers = _long(scores, places)
    y, person, stimulus, place, previous = (column[answers[-1] != NOTHING] for column in answers)
    if y.size == 0:
        return CarryOver(0, None, None, None, "undefined: nothing was seen before")
    base, persons = _within(np.vstack([_dummies(stimulus), place]), person)
    more, _ = _within(np.vstack([base, _dummies(previous)]), person)
    (centred,), _ = _within(y[None], person)
    small, large = _rank(base), _rank(more)
    df = (large - small, y.size - persons - large)
    if min(df) < 1:
        return CarryOver(y.size, None, None, None, "undefined: too few answers for each pair of stimuli")
    left = [float(((centred - _fitted(design, centred)) ** 2).sum()) for design in (base, more)]
    if left[1] < 1e-12:
        return CarryOver(y.size, None, df, None, "undefined: no variance is left")
    f = max(0.0, (left[0] - left[1]) / df[0] / (left[1] / df[1]))
    return CarryOver(y.size, f, df, float(fdtrc(df[0], df[1], f)))


def _long(scores: ArrayLike, places: ArrayLike) -> tuple[FloatArray, ...]:
    """Score, participant, stimulus, place and previous stimulus of every answer with a known place."""
    score, place = numbers(scores), numbers(places)
    order: NDArray[np.int64] = np.argsort(place, axis=1)  # places that are missing come last
    before: NDArray[np.int64] = np.full(score.shape, NOTHING)
    np.put_along_axis(before, order[:, 1:], order[:, :-1], axis=1)
    there = ~np.isnan(score) & ~np.isnan(place)
    person, stimulus = (index.astype(float) for index in np.nonzero(there))
    return score[there], person, stimulus, place[there], before[there].astype(float)


def _dummies(codes: FloatArray) -> FloatArray:
    """A row of ones and zeros per value but the first, (values − 1, n)."""
    rows: FloatArray = (codes == np.unique(codes)[1:, None]).astype(float)
    return rows


def _within(rows: FloatArray, person: FloatArray) -> tuple[FloatArray, int]:
    """Each row (n,) less the participant's mean, and the number of participants."""
    names, group = np.unique(person, return_inverse=True)
    sizes = np.maximum(np.bincount(group), 1)
    means = [np.bincount(group, row) / sizes for row in rows]
    return np.array([row - mean[group] for row, mean in zip(rows, means, strict=True)]).reshape(
        rows.shape
    ), names.size


def _fitted(rows: FloatArray, y: FloatArray) -> FloatArray:
    """The least-squares fit of y by the rows."""
    if not rows.size:
        return np.zeros_like(y)
    weights = np.linalg.lstsq(rows @ rows.T, rows @ y, rcond=None)[0]
    fitted: FloatArray = weights @ rows
    return fitted


def _rank(rows: FloatArray) -> int:
    return int(np.linalg.matrix_rank(rows @ rows.T)) if rows.size else 0
