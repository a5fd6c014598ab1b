"""Would the target be rated so high if item labels were shuffled within each participant's ratings?"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from analysis.statistics.samples import numbers

WIDEST = 1000  # points of a scale


@dataclass(frozen=True)
class LabelPermutation:
    """Exact permutation test of the target's sum of ratings."""

    n: int  # participants who rated all items
    estimate: float | None  # mean of the target minus mean of all items
    p: float | None  # one-sided
    reason: str | None = None


def label_permutation(ratings: ArrayLike, target: int) -> LabelPermutation:
    """Test that the target is rated above the items it could be confused with, ratings (participants, items).

    Under the null a participant's target rating is any of that participant's ratings with equal chance; the
    distribution of the sum is a convolution, so no permutation is drawn. Ratings must be whole numbers.

    >>> round(label_permutation([[5, 2, 1], [4, 4, 2], [5, 1, 3]], target=0).p, 4)
    0.0741
    """
    table = numbers(ratings)
    table = table[~np.isnan(table).any(axis=1)]
    n, k = table.shape
    if n == 0:
        return LabelPermutation(0, None, None, "undefined: no participant rated all items")
    lowest = table.min(axis=1, keepdims=True)
    steps = np.round(table - lowest).astype(int)
    if np.any(steps != table - lowest) or steps.max() > WIDEST:
        return LabelPermutation(
            n, None, None, f"not computed: needs whole numbers within {WIDEST} of each other"
        )
    chances = np.ones(1)
    for row in steps:
        chances = np.convolve(chances, np.bincount(row) / k)
    p = float(chances[int(steps[:, target].sum()) :].sum())
    return LabelPermutation(n, float(table[:, target].mean() - table.mean()), min(1.0, p))
