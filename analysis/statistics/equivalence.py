"""Is a mean close enough to a value: two one-sided t-tests."""

from __future__ import annotations

from dataclasses import dataclass

from numpy.typing import ArrayLike

from analysis.statistics.one_sample_t import one_sample_t
from analysis.statistics.t_test import TTest


@dataclass(frozen=True)
class Equivalence:
    """Two one-sided tests; p is the larger of theirs."""

    bounds: tuple[float, float]
    above_lower: TTest
    below_upper: TTest
    p: float | None
    reason: str | None = None


def equivalence(values: ArrayLike, bounds: tuple[float, float]) -> Equivalence:
    """Test that the mean lies within bounds, given in the unit of the values.

    For paired data pass the differences. Agrees with R `t.test(x, mu = low, alternative = "greater")` and
    `t.test(x, mu = high, alternative = "less")`. Schuirmann (1987), J. Pharmacokinet. Biopharm. 15.

    >>> round(equivalence([3, 3, 4, 2, 3, 3, 4, 3], (2, 4)).p, 5)
    0.0031
    """
    low, high = bounds
    if not low < high:
        raise ValueError(f"bounds {low:g} and {high:g}: the first is the lower one")
    above = one_sample_t(values, low, "greater")
    below = one_sample_t(values, high, "less")
    p = None if above.p is None or below.p is None else max(above.p, below.p)
    return Equivalence(bounds, above, below, p, above.reason or below.reason)
