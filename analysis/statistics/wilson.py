"""A confidence interval of a proportion that behaves near 0 and 1."""

from __future__ import annotations

from math import sqrt

from scipy.special import ndtri

from analysis.statistics.asked import refuse_impossible_count


def wilson(k: int, n: int, level: float = 0.95) -> tuple[float, float] | None:
    """Score interval of k of n without continuity correction; None for n = 0.

    Agrees with R `prop.test(k, n, correct = FALSE)$conf.int`. Wilson (1927), JASA 22.

    >>> [round(limit, 3) for limit in wilson(27, 34)]
    [0.632, 0.897]
    """
    refuse_impossible_count(k, n)
    if n == 0:
        return None
    z = float(ndtri((1 + level) / 2))
    share = k / n
    centre = (share + z**2 / (2 * n)) / (1 + z**2 / n)
    half = z * sqrt(share * (1 - share) / n + z**2 / (4 * n**2)) / (1 + z**2 / n)
    return (0.0 if k == 0 else centre - half), (1.0 if k == n else centre + half)
