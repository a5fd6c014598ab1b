"""Do the same participants rank several conditions differently?"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike
from scipy.special import chdtrc

from analysis.statistics.asked import as_table
from analysis.statistics.wilcoxon import middle_ranks


@dataclass(frozen=True)
class Friedman:
    """Friedman's rank test of n participants under k conditions."""

    n: int  # participants without a missing rating
    conditions: int
    chi2: float | None
    df: int
    p: float | None
    kendall_w: float | None  # 0 no agreement of ranks, 1 complete agreement
    reason: str | None = None


def friedman(ratings: ArrayLike) -> Friedman:
    """Friedman's test, ratings (participants, conditions), ties corrected; W is Kendall's effect size.

    Agrees with R `friedman.test`. Friedman (1937), JASA 32.

    >>> result = friedman([[4, 2, 1], [5, 3, 3], [3, 2, 2], [4, 1, 2]])
    >>> round(result.chi2, 3), result.df, round(result.p, 4), round(result.kendall_w, 3)
    (6.857, 2, 0.0324, 0.857)
    """
    table = as_table(ratings, "(participants, conditions)")
    table = table[~np.isnan(table).any(axis=1)]
    n, k = table.shape
    ranks = np.array([middle_ranks(row) for row in table]).reshape(n, k)
    spread = float(((ranks - (k + 1) / 2) ** 2).sum())
    if n < 2 or spread == 0:
        reason = (
            f"undefined: {n} complete participants" if n < 2 else "undefined: nobody rated conditions apart"
        )
        return Friedman(n, k, None, k - 1, None, None, reason)
    between = float(((ranks.sum(axis=0) - n * (k + 1) / 2) ** 2).sum())
    chi2 = (k - 1) * between / spread
    return Friedman(n, k, chi2, k - 1, float(chdtrc(k - 1, chi2)), chi2 / (n * (k - 1)))
