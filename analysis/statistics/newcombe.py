"""The difference of two proportions with a confidence interval that holds near 0 and 1."""

from __future__ import annotations

from dataclasses import dataclass
from math import sqrt

from scipy.special import ndtri

from analysis.statistics.wilson import wilson


@dataclass(frozen=True)
class Difference:
    """A difference of proportions."""

    estimate: float | None
    ci95: tuple[float, float] | None
    method: str
    reason: str | None = None


def newcombe(k1: int, n1: int, k2: int, n2: int) -> Difference:
    """k1/n1 − k2/n2 for independent groups, interval from the two Wilson intervals (his method 10).

    Newcombe (1998), Statistics in Medicine 17, 873–890.

    >>> result = newcombe(32, 34, 1, 34)
    >>> round(result.estimate, 3), [round(limit, 3) for limit in result.ci95]
    (0.912, [0.733, 0.961])
    """
    method = "Newcombe hybrid score, independent proportions"
    first, second = wilson(k1, n1), wilson(k2, n2)
    if first is None or second is None:
        return Difference(
            estimate=None, ci95=None, method=method, reason="undefined: a group without answers"
        )
    p1, p2 = k1 / n1, k2 / n2
    below = sqrt((p1 - first[0]) ** 2 + (second[1] - p2) ** 2)
    above = sqrt((first[1] - p1) ** 2 + (p2 - second[0]) ** 2)
    return Difference(estimate=p1 - p2, ci95=(p1 - p2 - below, p1 - p2 + above), method=method)


def paired_difference(both: int, only_first: int, only_second: int, neither: int) -> Difference:
    """P(first) − P(second) of the same participants, by the Wald interval with Bonett & Price's adjustment.

    Half a count is added to each discordant cell and two to n, so the interval has width at 0 discordant
    pairs. Bonett & Price (2012), Psychological Methods 17.
    """
    method = "Bonett–Price adjusted Wald, paired proportions"
    n = both + only_first + only_second + neither
    if n == 0:
        return Difference(estimate=None, ci95=None, method=method, reason="undefined: no complete pairs")
    p1, p2 = (only_first + 1) / (n + 2), (only_second + 1) / (n + 2)
    half = float(ndtri(0.975)) * sqrt((p1 + p2 - (p1 - p2) ** 2) / (n + 2))
    ci95 = (max(-1.0, p1 - p2 - half), min(1.0, p1 - p2 + half))
    return Difference(estimate=(only_first - only_second) / n, ci95=ci95, method=method)
