"""Ordinal ratings with a participant effect: the proportional-odds mixed model."""

from __future__ import annotations

from dataclasses import dataclass
from math import erfc, sqrt

import numpy as np
from numpy.typing import ArrayLike, NDArray

from analysis.statistics.curvature import standard_error

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
    from scipy.optimize import minimize

    values, y = np.unique(np.asarray(ratings), return_inverse=True)
    covariate = np.asarray(x, dtype=float)
    names, group = np.unique(np.asarray(participants), return_inverse=True)
    levels = values.size
    if levels < 2 or np.ptp(covariate) == 0:
        reason = "undefined: one rating only" if levels < 2 else "undefined: one condition only"
        return CumulativeLinkMixed(y.size, names.size, None, None, None, None, (), None, None, reason)
    shares = np.cumsum(np.bincount(y))[:-1] / y.size
    cuts = np.log(shares / (1 - shares))
    start = np.concatenate([cuts[:1], np.log(np.maximum(np.diff(cuts), 1e-3)), [0.0, 0.0]])
    model = _Model(y, covariate, group, levels, names.size)
    fit = minimize(model.negative, start, method="BFGS", options={"gtol": 1e-5})
    parameters = fit.x
    effect = float(parameters[levels - 1])
    se = standard_error(model.negative, parameters, of=levels - 1, log_sd=levels)
    if se is None or abs(effect) > 20:
        reason = "undefined: the conditions separate the ratings"
        return CumulativeLinkMixed(y.size, names.size, None, None, None, None, (), None, None, reason)
    return CumulativeLinkMixed(
        n=y.size,
        participants=names.size,
        effect=effect,
        se=se,
        z=effect / se,
        p=erfc(abs(effect / se) / sqrt(2)),
        thresholds=tuple(float(cut) for cut in _cuts(parameters, levels)),
        participant_sd=float(np.exp(parameters[levels])),
        log_likelihood=-float(fit.fun),
    )


class _Model:
    """The negative log-likelihood with each participant's effect integrated out at its mode."""

    def __init__(self, y: IntArray, x: FloatArray, group: IntArray, levels: int, groups: int) -> None:
        self.y, self.x, self.group, self.levels, self.groups = y, x, group, levels, groups
        self.mode = np.zeros(groups)  # kept from call to call: the next search starts there

    def negative(self, parameters: FloatArray) -> float:
        cuts = np.concatenate([[-np.inf], _cuts(parameters, self.levels), [np.inf]])
        effect, sd = parameters[self.levels - 1], np.exp(parameters[self.levels])
        upper = cuts[self.y + 1] - effect * self.x
        lower = cuts[self.y] - effect * self.x
        u = self.mode
        for _ in range(50):
            step, curvature, _ = self._derivatives(upper, lower, sd, u)
            u = u - np.clip(step / curvature, -2, 2)
            if np.max(np.abs(step / curvature)) < 1e-10:
                break
        _, curvature, value = self._derivatives(upper, lower, sd, u)
        self.mode = u
        return float((value + 0.5 * np.log(curvature)).sum())

    def _derivatives(
        self, upper: FloatArray, lower: FloatArray, sd: float, u: FloatArray
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Slope, curvature and value of −log(likelihood · standard normal density) in u, (participants,)."""
        a, b = _logistic(upper - sd * u[self.group]), _logistic(lower - sd * u[self.group])
        p = np.maximum(a - b, 1e-300)
        # with F' = F (1 − F): the log of F(upper) − F(lower) has slope −sd (1 − a − b) in u
        slope = sd * (1 - a - b)
        bend = sd**2 * (a * (1 - a) + b * (1 - b))
        sums: list[FloatArray] = [
            np.bincount(self.group, values, self.groups).astype(float) for values in (slope, bend, -np.log(p))
        ]
        return sums[0] + u, sums[1] + 1, sums[2] + u**2 / 2


def _cuts(parameters: FloatArray, levels: int) -> FloatArray:
    """Increasing thresholds from the first one and the logarithms of the steps."""
    return np.cumsum(np.concatenate([parameters[:1], np.exp(parameters[1 : levels - 1])]))


def _logistic(x: FloatArray) -> FloatArray:
    from scipy.special import expit

    y: FloatArray = expit(x)
    return y
