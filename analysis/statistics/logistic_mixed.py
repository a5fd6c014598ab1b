"""Choices with a participant effect: the logistic mixed model with a random intercept."""

from __future__ import annotations

from dataclasses import dataclass
from math import erfc, sqrt

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.special import expit

from analysis.statistics.alike import alike
from analysis.statistics.asked import refuse_other_than_yes_and_no
from analysis.statistics.likelihood import LARGEST, REACHES, WIDEST, minimum, standard_error
from analysis.statistics.samples import observed_rows

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]
NODES = 25  # of the quadrature


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
    y, covariate, (group,) = observed_rows(chosen, x, participants)
    refuse_other_than_yes_and_no(y)
    count = int(group.max()) + 1 if group.size else 0

    def undefined(reason: str) -> LogisticMixed:
        return LogisticMixed(y.size, count, None, None, None, None, None, None, f"undefined: {reason}")

    if y.size == 0 or np.ptp(covariate) == 0:
        return undefined("one condition only")
    if any(np.ptp(y[covariate == level]) == 0 for level in np.unique(covariate)):
        return undefined("complete separation in a condition")
    if not _both_ways(y, covariate, group):
        return undefined("whoever answers differently does so in one direction")
    model = _Model(y, covariate, group)
    parameters = minimum(model.negative, np.zeros(3))
    intercept, effect, log_sd = (float(value) for value in parameters)
    se = standard_error(model.negative, parameters, of=1, log_sd=2)
    if se is None or abs(effect) > LARGEST or log_sd > np.log(WIDEST):
        return undefined("participants answer too consistently for a bounded effect")
    return LogisticMixed(
        n=y.size,
        participants=count,
        intercept=intercept,
        effect=effect,
        se=se,
        p=erfc(abs(effect / se) / sqrt(2)),
        participant_sd=float(np.exp(log_sd)),
        log_likelihood=-float(model.negative(parameters[None])[0]),
    )


def _both_ways(y: FloatArray, x: FloatArray, group: IntArray) -> bool:
    """Whether some participants answer yes more often where x is higher and some less often, or none does."""
    within = x - (np.bincount(group, x) / np.bincount(group))[group]
    slopes = np.bincount(group, within * y)
    return bool((slopes > 1e-12).any() == (slopes < -1e-12).any())


class _Model:
    """The negative log-likelihood with participants integrated out around their modes, each kind once."""

    def __init__(self, y: FloatArray, x: FloatArray, group: IntArray) -> None:
        self.alike = alike(group, x, y)
        self.y, self.x = y[self.alike.rows], x[self.alike.rows]
        self.nodes, weights = np.polynomial.hermite.hermgauss(NODES)
        self.log_weights = np.log(weights) + self.nodes**2

    def negative(self, parameters: FloatArray) -> FloatArray:
        """−log L at (intercept, effect, log of the participants' SD), (k, 3) → (k,)."""
        intercept, effect, log_sd = parameters.T[..., None]
        sd = np.exp(np.minimum(log_sd, 5.0))
        fixed = intercept + effect * self.x  # (k, rows)
        u, curvature = self._modes(fixed, sd)
        spread = np.sqrt(2 / curvature)  # (k, groups)
        at = u[..., None] + spread[..., None] * self.nodes  # (k, groups, nodes), in units of the SD
        logits = fixed[..., None] + sd[..., None] * at[:, self.alike.kind]
        log_joint = self._sums(-np.logaddexp(0, (1 - 2 * self.y)[:, None] * logits))
        log_joint += self.log_weights - at**2 / 2
        peak = log_joint.max(axis=2)
        likelihood = peak + np.log(np.exp(log_joint - peak[..., None]).sum(axis=2))
        found: FloatArray = -(likelihood + np.log(spread) - np.log(2 * np.pi) / 2) @ self.alike.participants
        return found

    def _modes(self, fixed: FloatArray, sd: FloatArray) -> tuple[FloatArray, FloatArray]:
        """The likeliest effect of each participant, in SDs, and the curvature there, (k, groups)."""
        u = np.zeros((len(fixed), self.alike.starts.size))
        for reach in REACHES:
            chance = expit(fixed + sd * u[:, self.alike.kind])
            pull = sd * self._sums(self.y - chance) - u
            curvature = sd**2 * self._sums(chance * (1 - chance)) + 1
            if np.max(np.abs(pull / curvature)) < 1e-10:
                break
            u = u + np.clip(pull / curvature, -reach, reach)
        return u, curvature

    def _sums(self, values: FloatArray) -> FloatArray:
        """Of each participant's rows, (k, rows, …) → (k, groups, …)."""
        return np.add.reduceat(values, self.alike.starts, axis=1)
