"""A confidence interval of a proportion that never covers less than it says."""

from __future__ import annotations

from scipy.special import betaincinv

from analysis.statistics.asked import refuse_impossible_count


def clopper_pearson(k: int, n: int, level: float = 0.95) -> tuple[float, float] | None:
    """Exact interval of k of n, by inverting two binomial tests; None for n = 0.

    Agrees with R `binom.test(k, n)$conf.int`. Clopper & Pearson (1934), Biometrika 26.

    >>> [round(limit, 3) for limit in clopper_pearson(27, 34)]
    [0.621, 0.913]
    """
    refuse_impossible_count(k, n)
    if n == 0:
        return None
    tail = (1 - level) / 2
    low = 0.0 if k == 0 else float(betaincinv(k, n - k + 1, tail))
    high = 1.0 if k == n else float(betaincinv(k + 1, n - k, 1 - tail))
    return low, high
