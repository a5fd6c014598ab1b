"""Ordinal ratings with a participant effect: the proportional-odds mixed model."""

from __future__ import annotations

from dataclasses import dataclass
from math import erfc, sqrt

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.special import expit

from analysis.statistics.alike import alike
from analysis.statistics.likelihood import LARGEST, REACHES, WIDEST, minimum, standard_error
from analysis.statistics.samples import observed_rows

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


@dataclass(frozen=True)
class CumulativeLinkMixed:
    """logit P(rating ≤ j) = threshold_j − effect · x − participant, participants normal with mean 0."""

    n: int
    participants: int
    effect: float | None  # log odds ratio of a higher rating per unit of x
    se: float | None
    z: float | None
    p: float | None  # two-sided, Wald
    thresholds: tuple[float, ...]
    participant_sd: float | None
    log_likelihood: float | None  # Laplace approximation
    reason: str | None = None


def cumulative_link_mixed(ratings: ArrayLike, x: ArrayLike, participants: ArrayLike) -> CumulativeLinkMixed:
    """Fit by the Laplace approximation, one covariate, rows (n,) in any order.

    Agrees with R `ordinal::clmm(rating ~ x + (1 | participant))`. Christensen (2019), ordinal package.

    >>> ratings = [4, 2, 5, 3, 3, 3, 4, 4, 2, 3, 5, 1]
    >>> target = [1, 0] * 6
    >>> people = [person for person in "abcdef" for _ in range(2)]
    >>> round(cumulative_link_mixed(ratings, target, people).effect, 1)
    2.0
    """
    answers, covariate, (group,) = observed_rows(ratings, x, participants)
    values, y = np.unique(answers, return_inverse=True)
    levels, count = values.size, np.unique(group).size
    if levels < 2 or np.ptp(covariate) == 0:
        reason = "undefined: one rating only" if levels < 2 else "undefined: one condition only"
        return CumulativeLinkMixed(y.size, count, None, None, None, None, (), None, None, reason)
    shares = np.cumsum(np.bincount(y))[:-1] / y.size
    cuts = np.log(shares / (1 - shares))
    start = np.concatenate([cuts[:1], np.log(np.maximum(np.diff(cuts), 1e-3)), [0.0, 0.0]])
    model = _Model(y, covariate, group, levels)
    parameters = minimum(model.negative, start)
    effect = float(parameters[levels - 1])
    se = standard_error(model.negative, parameters, of=levels - 1, log_sd=levels)
    if se is None or abs(effect) > LARGEST or parameters[levels] > np.log(WIDEST):
        reason = "undefined: the conditions or the participants separate the ratings"
        return CumulativeLinkMixed(y.size, count, None, None, None, None, (), None, None, reason)
    return CumulativeLinkMixed(
        n=y.size,
        participants=count,
        effect=effect,
        se=se,
        z=effect / se,
        p=erfc(abs(effect / se) / sqrt(2)),
        thresholds=tuple(float(cut) for cut in _cuts(parameters[None], levels)[0]),
        participant_sd=float(np.exp(parameters[levels])),
        log_likelihood=-float(model.negative(parameters[None])[0]),
    )


class _Model:
    """The negative log-likelihood with participants integrated out at their modes, each kind once."""

    def __init__(self, y: IntArray, x: FloatArray, group: IntArray, levels: int) -> None:
        self.alike = alike(group, x, y.astype(float))
        self.y, self.x, self.levels = y[self.alike.rows], x[self.alike.rows], levels

    def negative(self, parameters: FloatArray) -> FloatArray:
        """−log L of thresholds, effect and log of the participants' SD, (k, levels + 1) → (k,)."""
        cuts = np.pad(_cuts(parameters, self.levels), ((0, 0), (1, 1)), constant_values=(-np.inf, np.inf))
        explained = parameters[:, [self.levels - 1]] * self.x  # (k, rows)
        upper, lower = cuts[:, self.y + 1] - explained, cuts[:, self.y] - explained
        sd = np.exp(parameters[:, [self.levels]])
        u = np.zeros((len(parameters), self.alike.starts.size))
        for reach in REACHES:
            a, b = self._below(upper, sd, u), self._below(lower, sd, u)
            # with F' = F (1 − F): the log of F(upper) − F(lower) has slope −sd (1 − a − b) in u
            slope = sd * self._sums(1 - a - b) + u
            curvature = sd**2 * self._sums(a * (1 - a) + b * (1 - b)) + 1
            if np.max(np.abs(slope / curvature)) < 1e-10:
                break
            u = u - np.clip(slope / curvature, -reach, reach)
        value = self._sums(-np.log(np.maximum(a - b, 1e-300))) + u**2 / 2
        found: FloatArray = (value + 0.5 * np.log(curvature)) @ self.alike.participants
        return found

    def _below(self, cut: FloatArray, sd: FloatArray, u: FloatArray) -> FloatArray:
        chance: FloatArray = expit(cut - sd * u[:, self.alike.kind])
        return chance

    def _sums(self, values: FloatArray) -> FloatArray:
        """Of each participant's rows, (k, rows) → (k, participants)."""
        return np.add.reduceat(values, self.alike.starts, axis=1)


def _cuts(parameters: FloatArray, levels: int) -> FloatArray:
    """Increasing thresholds from the first one and the logarithms of the steps."""
    steps = np.exp(parameters[:, 1 : levels - 1])
    return np.cumsum(np.concatenate([parameters[:, :1], steps], axis=1), axis=1)
