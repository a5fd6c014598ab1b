"""How much more likely the data are under an effect than under none."""

from __future__ import annotations

from dataclasses import dataclass
from math import exp, log, pi, sqrt

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
    """
    if result.t is None or result.df is None:
        return BayesFactor(None, None, result.alternative, prior_scale, result.reason)
    from scipy.integrate import quad
    from scipy.stats import nct
    from scipy.stats import t as student

    size = result.n[0] if len(result.n) == 1 else result.n[0] * result.n[1] / sum(result.n)
    root, t, df = sqrt(size), result.t, result.df
    null = float(student.logpdf(t, df))

    def weighted(d: float) -> float:
        prior = 1 / (pi * prior_scale * (1 + (d / prior_scale) ** 2))
        return prior * exp(float(nct.logpdf(t, df, d * root)) - shift)

    peak = t / root
    shift = float(nct.logpdf(t, df, t))
    limits = {"greater": (0.0, None), "less": (None, 0.0), "two-sided": (None, None)}[result.alternative]
    reach = 12 / root
    low = peak - reach if limits[0] is None else max(limits[0], peak - reach)
    high = peak + reach if limits[1] is None else min(limits[1], peak + reach)
    if low >= high:
        return BayesFactor(None, None, result.alternative, prior_scale, "effect far on the other side")
    area = quad(weighted, low, high, epsabs=0, epsrel=1e-10, limit=200)[0]
    one_sided = 1 if result.alternative == "two-sided" else 2
    logarithm = log(area * one_sided) + shift - null
    return BayesFactor(
        logarithm, exp(logarithm) if logarithm < 700 else None, result.alternative, prior_scale
    )
