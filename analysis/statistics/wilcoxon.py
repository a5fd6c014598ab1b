"""Do values lie above a fixed one, judged by their ranks?"""

from __future__ import annotations

from dataclasses import dataclass
from math import sqrt
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike
from scipy.special import ndtr

from analysis.statistics.samples import FloatArray, observed
from analysis.statistics.sign_flip import flip_probability
from analysis.statistics.t_test import Alternative, refuse_other_sides
from stimuli.errors import nearest


@dataclass(frozen=True)
class Wilcoxon:
    """Wilcoxon's signed-rank test."""

    n: int  # observed values
    zeros: int  # of them equal to the null value
    w: float | None  # sum of the ranks above the null value
    z: float | None
    p: float | None  # normal approximation with the tie correction, no continuity correction
    p_exact: float | None  # over all sign assignments of the tied ranks
    alternative: Alternative
    rank_biserial: float | None  # (W₊ − W₋) / (W₊ + W₋), from −1 to 1
    zero_rule: str
    reason: str | None = None

    @property
    def p_decisive(self) -> float | None:
        """The exact p; of more values than it is computed for, the approximate one."""
        return self.p if self.p_exact is None else self.p_exact


def wilcoxon(
    values: ArrayLike,
    null: float = 0.0,
    alternative: Alternative = "two-sided",
    *,
    zeros: Literal["pratt", "wilcoxon"] = "pratt",
) -> Wilcoxon:
    """Signed-rank test of symmetry about `null`.

    Values equal to `null` are ranked with the rest and then left out (Pratt), or dropped before (Wilcoxon).
    Agrees with R `coin::wilcoxsign_test(x ~ null, zero.method = "Pratt")`, asymptotic and exact. Wilcoxon
    (1945), Biometrics 1; Pratt (1959), JASA 54.

    >>> result = wilcoxon([4, 5, 3, 4, 5, 2], 3)
    >>> round(result.z, 3), round(result.p, 4)
    (1.497, 0.1345)
    """
    refuse_other_sides(alternative)
    if zeros not in (known := ("pratt", "wilcoxon")):
        raise ValueError(f"zeros {zeros!r}: {nearest(zeros, known)}")
    differences = _differences(observed(values), null)
    n, at_null = differences.size, int(np.sum(differences == 0))
    if n == at_null:
        reason = "undefined: no values" if n == 0 else f"undefined: every value is {null:g}"
        return Wilcoxon(n, at_null, None, None, None, None, alternative, None, zeros, reason)
    if zeros == "wilcoxon":
        differences = differences[differences != 0]
    ranks = middle_ranks(np.abs(differences))
    moving = differences != 0
    plus, minus = float(ranks[differences > 0].sum()), float(ranks[differences < 0].sum())
    z = (plus - minus) / sqrt(float((ranks[moving] ** 2).sum()))  # variance of W₊ − W₋ is Σ rank²
    tails = {"greater": float(ndtr(-z)), "less": float(ndtr(z)), "two-sided": 2 * float(ndtr(-abs(z)))}
    doubled = np.round(2 * ranks[moving]).astype(np.int64)  # mid-ranks are halves
    exact = flip_probability(doubled, round(2 * plus), alternative) if moving.sum() <= EXACT_UP_TO else None
    return Wilcoxon(
        n=n,
        zeros=at_null,
        w=plus,
        z=z,
        p=tails[alternative],
        p_exact=exact,
        alternative=alternative,
        rank_biserial=(plus - minus) / (plus + minus),
        zero_rule=zeros,
    )


def _differences(values: FloatArray, null: float) -> FloatArray:
    """Values − null, in units of the largest so that rounding breaks no tie: 0.6 − 0.4 is 0.4 − 0.2."""
    largest = max(float(np.abs(values).max(initial=0.0)), abs(null)) or 1.0
    differences: FloatArray = np.round((values - null) / largest, 12)
    return differences


EXACT_UP_TO = 500  # the exact distribution takes n³ steps


def middle_ranks(
    values: np.ndarray[tuple[int, ...], np.dtype[np.float64]],
) -> np.ndarray[tuple[int, ...], np.dtype[np.float64]]:
    """Ranks from 1, ties sharing the middle of theirs."""
    _, group, counts = np.unique(values, return_inverse=True, return_counts=True)
    last = np.cumsum(counts)
    middle: np.ndarray[tuple[int, ...], np.dtype[np.float64]] = (last - (counts - 1) / 2)[group]
    return middle
