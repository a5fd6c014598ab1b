"""Ratings with effects of participant and stimulus, both drawn from many: the crossed linear mixed model."""

from __future__ import annotations

from dataclasses import dataclass
from math import log, pi

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.special import stdtrit

from analysis.statistics.likelihood import FLAT, NONE, derivatives, minimum
from analysis.statistics.samples import observed_rows
from analysis.statistics.t_test import Interval, t_probability

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.intp]
LEAST = -8.0  # logarithm of a residual SD, the values' being 1, that is rounding


@dataclass(frozen=True)
class LinearMixed:
    """value = intercept + effect · x + participant + stimulus + residual, the last three normal."""

    n: int
    participants: int
    stimuli: int
    estimate: float | None = None  # the effect of x, or without x the intercept: the mean
    se: float | None = None
    t: float | None = None
    df: float | None = None  # Satterthwaite's
    p: float | None = None  # two-sided
    ci95: Interval | None = None
    participant_sd: float | None = None
    stimulus_sd: float | None = None
    residual_sd: float | None = None
    log_likelihood: float | None = None  # restricted
    reason: str | None = None


def linear_mixed(
    values: ArrayLike, participants: ArrayLike, stimuli: ArrayLike, x: ArrayLike | None = None
) -> LinearMixed:
    """Fit by restricted maximum likelihood, rows (n,) in any order; without x, the mean is judged.

    With both crossed, the result holds for other participants and for other stimuli like these (Judd,
    Westfall & Kenny 2012). Agrees with R `lmerTest::lmer(value ~ x + (1 | participant) + (1 | stimulus))`,
    Satterthwaite's degrees of freedom too (Kuznetsova, Brockhoff & Christensen 2017).

    >>> ratings = [4, 2, 5, 5, 3, 4, 4, 2, 5, 3, 2, 4]
    >>> clips = ["wave", "nod", "bow"] * 4
    >>> people = [person for person in "abcd" for _ in range(3)]
    >>> round(linear_mixed(ratings, people, clips).df, 1)
    2.1
    """
    covariate = np.zeros(np.shape(np.asarray(values))) if x is None else x
    y, fixed, (person, stimulus) = observed_rows(values, covariate, participants, stimuli)
    columns = [np.ones(y.size)] if x is None else [np.ones(y.size), fixed]
    sizes = y.size, np.unique(person).size, np.unique(stimulus).size
    if reason := _undefined(*sizes, y, None if x is None else fixed):
        return LinearMixed(*sizes, reason=reason)
    centre, unit = float(y.mean()), float(np.std(y))
    model = _Model((y - centre) / unit, np.column_stack(columns), person, stimulus)
    fitted, free = _fit(model)
    if fitted[2] <= LEAST:
        return LinearMixed(*sizes, reason="undefined: participants and stimuli explain every answer")
    effect, variance = (float(found[0]) for found in model.effect(fitted[None]))
    _, bend = derivatives(lambda some: model.negative(_among(fitted, free, some)), fitted[free])
    slope, _ = derivatives(lambda some: model.effect(_among(fitted, free, some))[1], fitted[free])
    uncertain = float(slope @ np.linalg.pinv(bend) @ slope)
    if not 0 < uncertain <= 2 * variance**2:  # less than one degree of freedom
        return LinearMixed(*sizes, reason="undefined: too few answers to tell the variances apart")
    df = 2 * variance**2 / uncertain
    estimate = effect * unit + (centre if x is None else 0.0)
    se = variance**0.5 * unit
    half = float(stdtrit(df, 0.975)) * se
    participant_sd, stimulus_sd, residual_sd = np.exp(fitted) * unit * (fitted > NONE)
    return LinearMixed(
        *sizes,
        estimate=estimate,
        se=se,
        t=estimate / se,
        df=df,
        p=t_probability(estimate / se, df, "two-sided"),
        ci95=(estimate - half, estimate + half),
        participant_sd=float(participant_sd),
        stimulus_sd=float(stimulus_sd),
        residual_sd=float(residual_sd),
        log_likelihood=-float(model.negative(fitted[None])[0]) - model.spare * log(unit),
    )


def _undefined(n: int, participants: int, stimuli: int, y: FloatArray, x: FloatArray | None) -> str | None:
    if participants < 2 or stimuli < 2:
        return f"undefined: one {'participant' if participants < 2 else 'stimulus'} only"
    if n in {participants, stimuli}:
        return "undefined: one answer per participant or stimulus"
    if np.ptp(y) == 0:
        return "undefined: zero variance"
    return "undefined: one condition only" if x is not None and np.ptp(x) == 0 else None


def _fit(model: _Model) -> tuple[FloatArray, IntArray]:
    """The logarithms of the three SDs (3,), and the places of those that are not held at 0."""
    free, at = np.arange(3), minimum(model.negative, np.full(3, -0.5))
    for effect in (0, 1):
        without = at.copy()
        without[effect] = NONE
        none, some = model.negative(np.array([without, at]))
        if none - some < FLAT:
            free, at = free[free != effect], without
    rest = minimum(lambda some: model.negative(_among(at, free, some)), at[free])
    return _among(at, free, rest), free


def _among(parameters: FloatArray, free: IntArray, some: FloatArray) -> FloatArray:
    """All parameters with new values for the free: (3,) and (…, free) → (…, 3)."""
    found = np.broadcast_to(parameters, (*some.shape[:-1], 3)).copy()
    found[..., free] = some
    return found


class _Model:
    """The restricted likelihood from sums over the rows, at several logarithms of the SDs (k, 3) at once.

    With both effects in units of the residual SD their matrix is [[P, B], [Bᵀ, S]], P and S diagonal (Bates
    et al. 2015, section 3): participants are eliminated first, and what is left is as small as there are
    stimuli.
    """

    def __init__(self, y: FloatArray, x: FloatArray, person: IntArray, stimulus: IntArray) -> None:
        told = np.column_stack([x, y])
        self.together = np.zeros((person.max() + 1, stimulus.max() + 1))  # rows of each with each
        self.of_persons = np.zeros((self.together.shape[0], told.shape[1]))
        self.of_stimuli = np.zeros((self.together.shape[1], told.shape[1]))
        np.add.at(self.together, (person, stimulus), 1.0)
        np.add.at(self.of_persons, person, told)
        np.add.at(self.of_stimuli, stimulus, told)
        self.products = told.T @ told
        self.spare = y.size - x.shape[1]

    def negative(self, parameters: FloatArray) -> FloatArray:
        """−log of the restricted likelihood, (k,)."""
        left, log_determinant = self._eliminated(parameters)
        fixed, both, own = left[:, :-1, :-1], left[:, :-1, -1:], left[:, -1, -1]
        log_sd = np.maximum(parameters[:, 2], LEAST)
        rest = own - (both.transpose(0, 2, 1) @ np.linalg.solve(fixed, both))[:, 0, 0]
        spread = self.spare * (log(2 * pi) + 2 * log_sd) + rest * np.exp(-2 * log_sd)
        found: FloatArray = (log_determinant + np.linalg.slogdet(fixed)[1] + spread) / 2
        return found

    def effect(self, parameters: FloatArray) -> tuple[FloatArray, FloatArray]:
        """The last fixed effect and its variance, each (k,)."""
        left, _ = self._eliminated(parameters)
        inverse: FloatArray = np.linalg.inv(left[:, :-1, :-1]).astype(float)
        effects: FloatArray = (inverse @ left[:, :-1, -1:])[:, -1, 0]
        return effects, inverse[:, -1, -1] * np.exp(2 * parameters[:, 2])

    def _eliminated(self, parameters: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Products of x and y without what the random effects explain, (k, m, m), and a log determinant."""
        relative = parameters[:, :2] - np.maximum(parameters[:, 2:], LEAST)
        variances = np.exp(2 * np.minimum(relative, -LEAST))  # in units of the residual's
        person, stimulus = variances.T[..., None]  # (k, 1)
        p = 1 + person * self.together.sum(axis=1)  # (k, persons)
        s = 1 + stimulus * self.together.sum(axis=0)

        def by_person(some: FloatArray, others: FloatArray) -> FloatArray:
            return np.asarray(np.einsum("pi,kp,pj->kij", some, person / p, others, optimize=True))

        overlap = stimulus[..., None] * by_person(self.together, self.together)
        kept = self.of_stimuli - by_person(self.together, self.of_persons)  # (k, stimuli, m)
        small = np.eye(s.shape[1]) * s[:, None] - overlap
        explained = stimulus[..., None] * (kept.transpose(0, 2, 1) @ np.linalg.solve(small, kept))
        left = self.products - by_person(self.of_persons, self.of_persons) - explained
        return left, np.log(p).sum(axis=1) + np.linalg.slogdet(small)[1]
