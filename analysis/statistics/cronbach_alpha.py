"""How consistently several items measure one thing."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike
from scipy.special import fdtri

from analysis.statistics.asked import as_table


@dataclass(frozen=True)
class CronbachAlpha:
    """Cronbach's alpha of k items."""

    n: int  # participants without a missing answer
    items: int
    estimate: float | None
    ci95: tuple[float, float] | None  # Feldt's
    reason: str | None = None


def cronbach_alpha(ratings: ArrayLike) -> CronbachAlpha:
    """Raw alpha, ratings (participants, items): k/(k−1) (1 − Σ item variances / variance of the sums).

    Agrees with R `psych::alpha(x)$total$raw_alpha` and its Feldt interval. Cronbach (1951), Psychometrika 16;
    Feldt et al. (1987), Applied Psychological Measurement 11.

    >>> round(cronbach_alpha([[4, 5, 4], [2, 2, 3], [5, 4, 5], [3, 3, 2]]).estimate, 3)
    0.892
    """
    table = as_table(ratings, "(participants, items)")
    table = table[~np.isnan(table).any(axis=1)]
    n, k = table.shape
    if n < 2 or k < 2:
        return CronbachAlpha(n, k, None, None, f"undefined: {n} complete participants, {k} items")
    of_sums = float(table.sum(axis=1).var(ddof=1))
    if of_sums == 0:
        return CronbachAlpha(n, k, None, None, "undefined: the sums do not vary")
    estimate = k / (k - 1) * (1 - float(table.var(axis=0, ddof=1).sum()) / of_sums)
    df1, df2 = n - 1, (n - 1) * (k - 1)
    low, high = (1 - (1 - estimate) * float(quantile) for quantile in (
        fdtri(df1, df2, 0.975), 1 / fdtri(df2, df1, 0.975)
    ))  # fmt: skip
    return CronbachAlpha(n, k, estimate, (low, high))
