"""How much more likely the data are under an effect than under none."""

from __future__ import annotations

from dataclasses import dataclass
from math import exp, log, pi, sqrt

import numpy as np

from analysis.statistics.noncentral_t import log_density, quadrature
from analysis.statistics.t_test import Alternative, TTest


@dataclass(frozen=True)
class BayesFactor:
    """BF₁₀ of a t-test; its logarithm stays finite where the factor would not."""

    log_bf10: float | None
    bf10: float | None
    alternative: Alternative
    prior_scale: float  # r of the Cauchy prior on d
    reason: str | None = None


def jzs_bayes_factor(result: TTest, prior_scale: float = sqrt(2) / 2) -> BayesFactor:
    """JZS Bayes factor of a one-sample, paired or Student's t-test; one-sided as the test is.

    The noncentral t density is averaged over a Cauchy(0, r) prior on d, cut at 0 for one-sided tests. Agrees
    with R `BayesFactor::ttestBF`. Rouder et al. (2009), Psychonomic Bulletin & Review 16.

    >>> from analysis import one_sample_t
    >>> round(jzs_bayes_factor(one_sample_t([4, 5, 3, 4, 5, 2], 3, "greater")).bf10, 3)
    1.817
    """
    if result.t is None or result.df is None:
        return BayesFactor(None, None, result.alternative, prior_scale, result.reason)
    size = result.n[0] if len(result.n) == 1 else result.n[0] * result.n[1] / sum(result.n)
    root, t, df = sqrt(size), result.t, result.df
    low, high = t / root - 12 / root, t / root + 12 / root  # where the likelihood of d is
    low = max(0.0, low) if result.alternative == "greater" else low
    high = min(0.0, high) if result.alternative == "less" else high
    if low >= high:
        return BayesFactor(None, None, result.alternative, prior_scale, "effect far on the other side")
    nodes, weights = quadrature(20)
    d = (low + high) / 2 + (high - low) / 2 * nodes
    sides = 1 if result.alternative == "two-sided" else 2
    prior = sides / (pi * prior_scale * (1 + (d / prior_scale) ** 2))
    likelihood = log_density(t, df, d * root) - log_density(t, df, np.zeros(1))
    peak = float(likelihood.max())
    area = float(weights @ (prior * np.exp(likelihood - peak))) * (high - low) / 2
    logarithm = log(area) + peak
    return BayesFactor(
        logarithm, exp(logarithm) if logarithm < 700 else None, result.alternative, prior_scale
    )
