"""Choices of the same participants under two conditions: logistic regression with clustered errors."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from math import erfc, sqrt

import numpy as np
from numpy.typing import ArrayLike, NDArray

from analysis.statistics.alike import alike
from analysis.statistics.asked import refuse_other_than_yes_and_no
from analysis.statistics.samples import observed_rows

FloatArray = NDArray[np.float64]
Cluster = tuple[FloatArray, FloatArray, float]  # design (m, 2), answers (m,), and who gave them: how many
FEW = 40  # participants below which robust errors are too small


@dataclass(frozen=True)
class GeeLogistic:
    """Population-averaged log odds ratio."""

    n: int
    participants: int
    effect: float | None  # log odds ratio per unit of x
    se: float | None  # robust; bias-reduced below 40 participants
    p: float | None  # two-sided, Wald
    reason: str | None = None


def gee_logistic(
    chosen: ArrayLike, x: ArrayLike, participants: ArrayLike, *, bias_reduced: bool | None = None
) -> GeeLogistic:
    """Generalised estimating equations, exchangeable working correlation, rows (n,) of 0/1 answers.

    Below 40 participants errors are bias-reduced (Mancl & DeRouen 2001, Biometrics 57) unless told otherwise.
    Agrees with R `geepack::geeglm(corstr = "exchangeable")`; bias-reduced, with their matrices as R works
    them out from its fit. Liang & Zeger (1986), Biometrika 73.

    >>> chosen, high = [1, 0, 1, 1, 0, 0, 1, 0], [1, 0, 1, 0, 1, 0, 1, 0]
    >>> people = ["a", "a", "b", "b", "c", "c", "d", "d"]
    >>> result = gee_logistic(chosen, high, people)
    >>> round(result.effect, 3), round(result.se, 3)
    (2.197, 1.778)
    """
    y, covariate, (group,) = observed_rows(chosen, x, participants)
    refuse_other_than_yes_and_no(y)
    n, count = y.size, int(group.max()) + 1 if group.size else 0
    for level in np.unique(covariate):
        if np.ptp(y[covariate == level]) == 0:
            return GeeLogistic(n, count, None, None, None, "undefined: complete separation in a condition")
    if n == 0 or np.ptp(covariate) == 0:
        return GeeLogistic(n, count, None, None, None, "undefined: one condition only")
    design = np.column_stack([np.ones(n), covariate])
    same = alike(group, covariate, y)
    kinds = np.split(same.rows, same.starts[1:])
    clusters = [(design[own], y[own], times) for own, times in zip(kinds, same.participants, strict=True)]
    reduce = count < FEW if bias_reduced is None else bias_reduced
    try:
        beta, correlation = _estimate(clusters, design, y)
        effect, se = float(beta[1]), _robust_se(clusters, beta, correlation, bias_reduced=reduce)
    except np.linalg.LinAlgError:
        return GeeLogistic(
            n, count, None, None, None, "undefined: one answer of a participant tells the other"
        )
    if se < 1e-9:
        return GeeLogistic(n, count, None, None, None, "undefined: no variance is left")
    return GeeLogistic(n, count, effect, se, erfc(abs(effect / se) / sqrt(2)))


def _estimate(clusters: list[Cluster], design: FloatArray, y: FloatArray) -> tuple[FloatArray, float]:
    """Coefficients and the correlation within participants, in turn until neither changes."""
    beta, correlation = np.zeros(2), 0.0
    for _ in range(200):
        slope = sum(
            (times * weighted.T @ error for _, weighted, error, times in _terms(clusters, beta, correlation)),
            np.zeros(2),
        )
        step = np.linalg.solve(_bread(clusters, beta, correlation), slope)
        before = correlation
        beta = beta + step
        correlation = _correlation(clusters, design, y, beta)
        largest = max(answers.size for _, answers, _ in clusters)
        if correlation * max(1, largest - 1) < 1e-9 - 1 or correlation > 1 - 1e-9:
            raise np.linalg.LinAlgError("the working correlation is singular")
        if np.abs(step).max() < 1e-12 and abs(correlation - before) < 1e-12:
            break
    return beta, correlation


def _correlation(clusters: list[Cluster], design: FloatArray, y: FloatArray, beta: FloatArray) -> float:
    """Mean product of two standardised residuals of a participant, over their mean square."""
    scale = float((_standardised(design, y, beta) ** 2).mean())
    products, pairs = 0.0, 0.0
    for part, answers, times in clusters:
        residuals = _standardised(part, answers, beta)
        products += times * (residuals.sum() ** 2 - (residuals**2).sum()) / 2
        pairs += times * (residuals.size * (residuals.size - 1) // 2)
    return products / pairs / scale if pairs else 0.0


def _standardised(design: FloatArray, y: FloatArray, beta: FloatArray) -> FloatArray:
    mean = _mean(design, beta)
    residuals: FloatArray = (y - mean) / np.sqrt(mean * (1 - mean))
    return residuals


def _mean(design: FloatArray, beta: FloatArray) -> FloatArray:
    mean: FloatArray = 1 / (1 + np.exp(-design @ beta))
    return mean


def _terms(
    clusters: list[Cluster], beta: FloatArray, correlation: float
) -> Iterator[tuple[FloatArray, FloatArray, FloatArray, float]]:
    """Derivative D (m, 2) of the means, V⁻¹ D (m, 2), errors (m,), and how many participants have them."""
    for design, y, times in clusters:
        mean = _mean(design, beta)
        variance = mean * (1 - mean)
        derivative = variance[:, None] * design
        standardised = derivative / np.sqrt(variance)[:, None]
        shared = correlation / (1 + (y.size - 1) * correlation) * standardised.sum(axis=0)
        weighted = (standardised - shared) / (1 - correlation) / np.sqrt(variance)[:, None]
        yield derivative, weighted, y - mean, times


def _bread(clusters: list[Cluster], beta: FloatArray, correlation: float) -> FloatArray:
    return sum(
        (
            times * derivative.T @ weighted
            for derivative, weighted, _, times in _terms(clusters, beta, correlation)
        ),
        np.zeros((2, 2)),
    )


def _robust_se(clusters: list[Cluster], beta: FloatArray, correlation: float, *, bias_reduced: bool) -> float:
    """Sandwich standard error of the effect; bias-reduced: without each participant's pull on the fit."""
    bread = np.linalg.inv(_bread(clusters, beta, correlation))
    filling = np.zeros((2, 2))
    for derivative, weighted, error, times in _terms(clusters, beta, correlation):
        leverage = derivative @ bread @ weighted.T
        own = np.linalg.solve(np.eye(error.size) - leverage, error) if bias_reduced else error
        filling += times * np.outer(weighted.T @ own, weighted.T @ own)
    return float(np.sqrt((bread @ filling @ bread)[1, 1]))
