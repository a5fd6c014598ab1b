"""Is a sample symmetric about a value? The exact test that needs no distribution and no variance."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from analysis.statistics.binomial import binomial_probability
from analysis.statistics.samples import observed
from analysis.statistics.t_test import SMALLEST, Alternative, refuse_other_sides


@dataclass(frozen=True)
class SignFlip:
    """The share of all 2ⁿ sign assignments whose sum is at least as extreme as the observed."""

    n: int
    estimate: float | None  # mean difference from the null value
    p: float | None
    alternative: Alternative
    reason: str | None = None


def sign_flip(values: ArrayLike, null: float = 0.0, alternative: Alternative = "two-sided") -> SignFlip:
    """Exact permutation test of symmetry about `null`, ties and zeros included.

    Differences are counted on their common grid (halves, thirds, … up to 1/1000), so the distribution of
    the sum is a convolution of two-point ones. Agrees with R `exactRankTests::perm.test(x, paired)`.
    Fisher (1935); Pagano & Tritchler (1983), JASA 78.

    >>> round(sign_flip([4, 5, 3, 4, 5, 2], 3, "greater").p, 4)
    0.125
    """
    refuse_other_sides(alternative)
    differences = observed(values) - null
    n = differences.size
    if n == 0:
        return SignFlip(0, None, None, alternative, reason="undefined: no values")
    if n > EXACT_UP_TO and np.ptp(np.abs(differences)) > 0:
        reason = f"not computed: exact only up to {EXACT_UP_TO} values"
        return SignFlip(n, float(differences.mean()), None, alternative, reason=reason)
    steps = on_grid(differences)
    if steps is None:
        return SignFlip(
            n, float(differences.mean()), None, alternative, reason="differences have no common grid"
        )
    if np.ptp(np.abs(steps)) == 0 and steps[0] != 0:  # all of one size: the sign test
        p = max(binomial_probability(int((steps > 0).sum()), n, 0.5, alternative), SMALLEST)
    else:
        p = flip_probability(np.abs(steps), int(steps[steps > 0].sum()), alternative)
    return SignFlip(n, float(differences.mean()), p, alternative)


EXACT_UP_TO = 500  # the distribution takes n² steps of the grid


def flip_probability(
    magnitudes: np.ndarray[tuple[int], np.dtype[np.int64]], positive_sum: int, alternative: Alternative
) -> float:
    """P-value of the sum of those integer magnitudes that got a plus, each with probability ½."""
    step = max(1, int(np.gcd.reduce(magnitudes)))  # a coarser grid has the same sums in fewer places
    chances, positive_sum = positive_sum_distribution(magnitudes // step), positive_sum // step
    at_least, at_most = float(chances[positive_sum:].sum()), float(chances[: positive_sum + 1].sum())
    if alternative == "greater":
        return min(1.0, at_least)
    if alternative == "less":
        return min(1.0, at_most)
    return min(1.0, 2 * min(at_least, at_most))


def positive_sum_distribution(
    magnitudes: np.ndarray[tuple[int], np.dtype[np.int64]],
) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
    """P(sum = 0), P(sum = 1), … of independently kept or dropped magnitudes."""
    chances = np.zeros(int(magnitudes.sum()) + 1)
    chances[0] = 1.0
    reached = 0
    for magnitude in magnitudes[magnitudes > 0]:
        half = chances[: reached + 1] / 2
        chances[: reached + 1] = half
        chances[magnitude : magnitude + reached + 1] += half
        reached += int(magnitude)
    return chances


def on_grid(
    differences: np.ndarray[tuple[int, ...], np.dtype[np.float64]],
) -> np.ndarray[tuple[int], np.dtype[np.int64]] | None:
    """The differences as whole numbers of the coarsest step (1, 1/2, …, 1/1000) that fits all, if any."""
    parts = np.arange(1, 1001)
    for difference in differences:
        scaled = difference * parts
        parts = parts[np.abs(scaled - np.round(scaled)) < 1e-9 * parts]
    return np.round(differences * parts[0]).astype(np.int64) if parts.size else None
