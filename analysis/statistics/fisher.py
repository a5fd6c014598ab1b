"""Do two independent groups differ in the share of yes, exactly?"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.special import gammaln

from analysis.statistics.asked import refuse_impossible_count
from analysis.statistics.t_test import SMALLEST, Alternative, refuse_other_sides


@dataclass(frozen=True)
class Fisher:
    """Fisher's exact test of a 2 × 2 table."""

    n: tuple[int, int]
    p: float | None
    alternative: Alternative
    odds_ratio: float | None  # the sample's; None where a cell makes it 0/0 or unbounded
    reason: str | None = None


def fisher(k1: int, n1: int, k2: int, n2: int, alternative: Alternative = "two-sided") -> Fisher:
    """Exact test of k1 of n1 against k2 of n2; "greater" means the first share is larger.

    Sums the hypergeometric probabilities, two-sided of every table no likelier than the observed one.
    Agrees with R `fisher.test(matrix(c(k1, n1 - k1, k2, n2 - k2), 2), alternative = )$p.value`. Fisher
    (1935).

    >>> round(fisher(19, 34, 10, 34, "greater").p, 4)
    0.0245
    """
    refuse_impossible_count(k1, n1)
    refuse_impossible_count(k2, n2)
    refuse_other_sides(alternative)
    if n1 == 0 or n2 == 0:
        return Fisher((n1, n2), None, alternative, None, reason="undefined: a group without answers")
    k = np.arange(max(0, k1 + k2 - n2), min(n1, k1 + k2) + 1)  # the first group's yes, given the margins
    log_probability = _log_choose(n1, k) + _log_choose(n2, k1 + k2 - k)
    probability = np.exp(log_probability - _log_choose(n1 + n2, np.array(k1 + k2)))
    observed = probability[k == k1][0]
    if alternative == "greater":
        p = probability[k >= k1].sum()
    elif alternative == "less":
        p = probability[k <= k1].sum()
    else:
        p = probability[probability <= observed * (1 + 1e-7)].sum()
    against = (n1 - k1) * k2
    return Fisher(
        n=(n1, n2),
        p=min(1.0, max(float(p), SMALLEST)),
        alternative=alternative,
        odds_ratio=k1 * (n2 - k2) / against if against else None,
        reason=None if against else "odds ratio unbounded or undefined: an empty cell",
    )


def _log_choose(
    n: int, k: np.ndarray[tuple[int, ...], np.dtype[np.int64]]
) -> np.ndarray[tuple[int, ...], np.dtype[np.float64]]:
    logarithm: np.ndarray[tuple[int, ...], np.dtype[np.float64]] = (
        gammaln(n + 1) - gammaln(k + 1) - gammaln(n - k + 1)
    )
    return logarithm
