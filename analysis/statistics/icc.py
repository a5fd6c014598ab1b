"""How much of the variance of ratings lies between what is rated: intraclass correlations."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike
from scipy.special import fdtri

from analysis.statistics.asked import as_table

ROUNDING = 1e-12  # a mean square below this share of all squares is zero but for rounding


@dataclass(frozen=True)
class Icc:
    """One intraclass correlation."""

    kind: str  # ICC1 … ICC3k, after Shrout & Fleiss
    estimate: float
    ci95: tuple[float, float]


def icc(ratings: ArrayLike) -> dict[str, Icc]:
    """All six correlations, ratings (subjects, raters); subjects with a missing rating are left out.

    ICC1: other raters for each subject; ICC2: raters drawn from many; ICC3: these raters and no others; k: of
    the raters' mean. Agrees with R `psych::ICC(x, lmer = FALSE)`. Shrout & Fleiss (1979), Psych. Bulletin 86;
    intervals after McGraw & Wong (1996). An empty result means that the correlations are undefined.

    >>> round(icc([[4, 5, 4], [2, 2, 3], [5, 4, 5], [3, 3, 2]])["ICC2"].estimate, 3)
    0.786
    """
    table = as_table(ratings, "(subjects, raters)")
    table = table[~np.isnan(table).any(axis=1)]
    n, k = table.shape
    if n < 2 or k < 2 or np.ptp(table) == 0:
        return {}
    grand = table.mean()
    between = k * float(((table.mean(axis=1) - grand) ** 2).sum()) / (n - 1)
    raters = n * float(((table.mean(axis=0) - grand) ** 2).sum()) / (k - 1)
    total = float(((table - grand) ** 2).sum())
    within = (total - (n - 1) * between) / (n * (k - 1))
    error = (total - (n - 1) * between - (k - 1) * raters) / ((n - 1) * (k - 1))
    if min(between, within, error) <= total * ROUNDING:
        return {}
    one = _of_ratio(between / within, n - 1, n * (k - 1), k)
    three = _of_ratio(between / error, n - 1, (n - 1) * (k - 1), k)
    two = _random_raters(between, raters, error, n, k)
    found = {}
    for kind, (estimate, low, high) in {"ICC1": one, "ICC2": two, "ICC3": three}.items():
        found[kind] = Icc(kind, estimate, (low, high))
        found[f"{kind}k"] = Icc(f"{kind}k", _of_mean(estimate, k), (_of_mean(low, k), _of_mean(high, k)))
    return found


def _of_ratio(ratio: float, df1: float, df2: float, k: int) -> tuple[float, float, float]:
    """(F − 1) / (F + k − 1) with its interval."""
    low, high = ratio / fdtri(df1, df2, 0.975), ratio * fdtri(df2, df1, 0.975)
    estimate, lower, upper = ((f - 1) / (f + k - 1) for f in (ratio, float(low), float(high)))
    return estimate, lower, upper


def _random_raters(between: float, raters: float, error: float, n: int, k: int) -> tuple[float, float, float]:
    """ICC2 with the Satterthwaite interval."""
    estimate = (between - error) / (between + (k - 1) * error + k * (raters - error) / n)
    ratio = raters / error
    rest = n * (1 + (k - 1) * estimate) - k * estimate
    df = (k - 1) * (n - 1) * (k * estimate * ratio + rest) ** 2
    df /= (n - 1) * k**2 * estimate**2 * ratio**2 + rest**2
    upper, lower = float(fdtri(n - 1, df, 0.975)), float(fdtri(df, n - 1, 0.975))
    noise = k * raters + (k * n - k - n) * error
    low = n * (between - upper * error) / (upper * noise + n * between)
    high = n * (lower * between - error) / (noise + n * lower * between)
    return estimate, low, high


def _of_mean(single: float, k: int) -> float:
    """The reliability of the mean of k raters (Spearman–Brown)."""
    return single * k / (1 + single * (k - 1))
