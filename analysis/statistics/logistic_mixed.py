"""Choices with a participant effect: the logistic mixed model with a random intercept."""

from __future__ import annotations

from dataclasses import dataclass
from math import erfc, sqrt

import numpy as np
from numpy.typing import ArrayLike, NDArray

from analysis.statistics.curvature import standard_error

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]
NODES = 25  # of the quadrature
WIDEST = 10.0  # SD of participants, in log odds; beyond, the likelihood has no maximum to speak of


@dataclass(frozen=True)
class LogisticMixed:
    """logit P(chosen) = intercept + effect · x + participant, participants normal with mean 0."""

    n: int
    participants: int
    intercept: float | None
    effect: float | None  # log odds ratio per unit of x, for one and the same participant
    se: float | None
    p: float | None  # two-sided, Wald
    participant_sd: float | None
    log_likelihood: float | None
    reason: str | None = None


def logistic_mixed(chosen: ArrayLike, x: ArrayLike, participants: ArrayLike) -> LogisticMixed:
    """Fit by adaptive Gauss–Hermite quadrature, one covariate, rows (n,) of 0/1 answers in any order.

    Agrees with R `lme4::glmer(chosen ~ x + (1 | participant), family = binomial, nAGQ = 25)`. Pinheiro &
    Bates (1995), J. Comput. Graph. Stat. 4.

    >>> chosen = [1, 0, 1, 1, 0, 0, 1, 0, 0, 1, 1, 0]
    >>> high = [1, 0] * 6
    >>> people = [person for person in "abcdef" for _ in range(2)]
    >>> result = logistic_mixed(chosen, high, people)
    >>> round(result.effect, 2), round(result.se, 2)
    (1.39, 1.22)
    """
    from scipy.optimize import minimize

    y, covariate = np.asarray(chosen, dtype=float), np.asarray(x, dtype=float)
    _, group = np.unique(np.asarray(participants), return_inverse=True)
    count = int(group.max()) + 1 if group.size else 0

    def undefined(reason: str) -> LogisticMixed:
        return LogisticMixed(y.size, count, None, None, None, None, None, None, f"undefined: {reason}")

    if y.size == 0 or np.ptp(covariate) == 0:
        return undefined("one condition only")
    if any(np.ptp(y[covariate == level]) == 0 for level in np.unique(covariate)):
        return undefined("complete separation in a condition")
    if not _both_ways(y, covariate, group):
        return undefined("whoever answers differently does so in one direction")
    model = _Model(y, covariate, group, count)
    fit = minimize(model.negative, np.array([0.0, 0.0, 0.0]), method="BFGS", options={"gtol": 1e-6})
    intercept, effect, log_sd = (float(value) for value in fit.x)
    se = standard_error(model.negative, fit.x, of=1, log_sd=2)
    if se is None or abs(effect) > 20 or log_sd > np.log(WIDEST):
        return undefined("participants answer too consistently for a bounded effect")
    return LogisticMixed(
        n=y.size,
        participants=count,
        intercept=intercept,
        effect=effect,
        se=se,
        p=erfc(abs(effect / se) / sqrt(2)),
        participant_sd=float(np.exp(log_sd)),
        log_likelihood=-float(fit.fun),
    )


def _both_ways(y: FloatArray, x: FloatArray, group: IntArray) -> bool:
    """Whether some participants answer yes more often where x is higher and some less often, or none does."""
    within = x - (np.bincount(group, x) / np.bincount(group))[group]
    slopes = np.bincount(group, within * y)
    return bool((slopes > 1e-12).any() == (slopes < -1e-12).any())


class _Model:
    """The negative log-likelihood with participants integrated out around their modes."""

    def __init__(self, y: FloatArray, x: FloatArray, group: IntArray, groups: int) -> None:
        self.sign, self.x, self.group, self.groups = 2 * y - 1, x, group, groups
        self.nodes, weights = np.polynomial.hermite.hermgauss(NODES)
        self.log_weights = np.log(weights) + self.nodes**2
        self.mode = np.zeros(groups)  # kept from call to call: the next search starts there

    def negative(self, parameters: FloatArray) -> float:
        """−log L at (intercept, effect, log of the participants' SD)."""
        intercept, effect, log_sd = parameters
        sd = float(np.exp(min(log_sd, 5.0)))
        fixed = intercept + effect * self.x
        u, curvature = self._modes(fixed, sd)
        self.mode = u
        spread = np.sqrt(2 / curvature)  # (groups,)
        at = u[:, None] + spread[:, None] * self.nodes  # (groups, nodes), in units of the SD
        logits = self.sign[:, None] * (fixed[:, None] + sd * at[self.group])
        log_joint = np.zeros_like(at)
        np.add.at(log_joint, self.group, -np.logaddexp(0, -logits))
        log_joint += self.log_weights - at**2 / 2
        peak = log_joint.max(axis=1)
        likelihood = peak + np.log(np.exp(log_joint - peak[:, None]).sum(axis=1))
        return -float((likelihood + np.log(spread) - np.log(2 * np.pi) / 2).sum())

    def _modes(self, fixed: FloatArray, sd: float) -> tuple[FloatArray, FloatArray]:
        """The likeliest effect of each participant, in SDs, and the curvature there."""
        u = self.mode
        for _ in range(50):
            chance = 1 / (1 + np.exp(-(fixed + sd * u[self.group])))
            pull = np.bincount(self.group, sd * ((self.sign + 1) / 2 - chance), self.groups) - u
            curvature = np.bincount(self.group, sd**2 * chance * (1 - chance), self.groups) + 1
            u = u + np.clip(pull / curvature, -2, 2)
            if np.max(np.abs(pull / curvature)) < 1e-10:
                break
        return u, np.asarray(curvature, dtype=float)
