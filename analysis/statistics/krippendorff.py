"""How far raters agree beyond chance, with missing ratings."""

from __future__ import annotations

from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from analysis.statistics.asked import as_table

Metric = Literal["nominal", "ordinal", "interval"]


def krippendorff_alpha(ratings: ArrayLike, metric: Metric = "ordinal") -> float | None:
    """Krippendorff's alpha, ratings (raters, units), NaN where missing; None where nothing varies.

    1 − observed / expected disagreement over all pairs of ratings of the same unit. Reproduces the worked
    example of Krippendorff (2011), Computing Krippendorff's Alpha-Reliability.

    >>> round(krippendorff_alpha([[4, 2, 5, 3], [5, 2, 4, 3], [4, 3, 5, 2]]), 3)
    0.756
    """
    table = as_table(ratings, "(raters, units)")
    values = np.unique(table[~np.isnan(table)])
    counts = (table[:, :, None] == values).sum(axis=0).astype(float)  # (units, values)
    counts = counts[counts.sum(axis=1) >= 2]
    per_unit = counts.sum(axis=1)
    if per_unit.size == 0:
        return None
    pairs = np.einsum("ua,ub,u->ab", counts, counts, 1 / (per_unit - 1))
    pairs -= np.diag((counts / (per_unit - 1)[:, None]).sum(axis=0))  # a rating is no pair with itself
    totals = pairs.sum(axis=1)
    distance = _distance(values, totals, metric)
    expected = float((np.outer(totals, totals) * distance).sum() / (totals.sum() - 1))
    return None if expected == 0 else 1 - float((pairs * distance).sum()) / expected


def _distance(
    values: NDArray[np.float64], totals: NDArray[np.float64], metric: Metric
) -> NDArray[np.float64]:
    """Squared difference of every two values, (values, values)."""
    if metric == "nominal":
        return 1 - np.eye(values.size)
    position = values if metric == "interval" else np.cumsum(totals) - totals / 2
    squared: NDArray[np.float64] = np.subtract.outer(position, position) ** 2
    return squared
