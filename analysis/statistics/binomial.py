"""Is a share other than chance would have it?"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.special import betainc, gammaln, xlog1py, xlogy

from analysis.statistics.asked import refuse_impossible_count
from analysis.statistics.clopper_pearson import clopper_pearson
from analysis.statistics.t_test import SMALLEST, Alternative, Interval, refuse_other_sides
from analysis.statistics.wilson import wilson


@dataclass(frozen=True)
class Binomial:
    """An exact binomial test of k of n against a fixed share."""

    k: int
    n: int
    estimate: float | None
    null: float
    p: float | None
    alternative: Alternative
    ci95: Interval | None  # Clopper–Pearson
    wilson_ci95: Interval | None
    reason: str | None = None


def binomial(k: int, n: int, null: float = 0.5, alternative: Alternative = "two-sided") -> Binomial:
    """Exact binomial test; two-sided adds up every outcome no likelier than the one observed.

    Agrees with R `binom.test(k, n, p, alternative)`. With null ½ it is the sign test.

    >>> round(binomial(19, 34, 0.5, "greater").p, 4)
    0.3038
    """
    refuse_impossible_count(k, n)
    refuse_other_sides(alternative)
    if not 0 <= null <= 1:
        raise ValueError(f"null {null:g} is no share, which lies between 0 and 1")
    if n == 0:
        return Binomial(k, n, None, null, None, alternative, None, None, reason="undefined: no answers")
    return Binomial(
        k=k,
        n=n,
        estimate=k / n,
        null=null,
        p=binomial_probability(k, n, null, alternative),
        alternative=alternative,
        ci95=clopper_pearson(k, n),
        wilson_ci95=wilson(k, n),
    )


def binomial_probability(k: int, n: int, null: float, alternative: Alternative) -> float:
    """P-value of k successes in n."""
    if alternative == "greater":
        return at_least(k, n, null)
    if alternative == "less":
        return at_least(n - k, n, 1 - null)
    chances = outcome_probabilities(np.arange(n + 1), n, null)
    return float(min(1.0, max(SMALLEST, chances[chances <= chances[k] * (1 + 1e-7)].sum())))


def at_least(k: int, n: int, share: float) -> float:
    """P(X ≥ k) for X binomial, through the incomplete beta function, so the tail keeps its digits."""
    return 1.0 if k <= 0 else max(float(betainc(k, n - k + 1, share)), SMALLEST)


def outcome_probabilities(k: ArrayLike, n: int, share: float) -> NDArray[np.float64]:
    """P(X = k) of each k for X binomial."""
    yes = np.asarray(k)
    ways = gammaln(n + 1) - gammaln(yes + 1) - gammaln(n - yes + 1)
    probabilities: NDArray[np.float64] = np.exp(ways + xlogy(yes, share) + xlog1py(n - yes, -share))
    return probabilities
