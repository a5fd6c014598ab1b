"""A confidence interval of a mean rating without a distribution."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike
from scipy.special import ndtr, ndtri

from analysis.statistics.samples import observed
from analysis.statistics.t_test import Interval


def bootstrap_mean(
    values: ArrayLike, rng: np.random.Generator, *, resamples: int = 9999, level: float = 0.95
) -> Interval | None:
    """BCa interval of the mean; None where the values do not vary.

    A resample of ratings is a draw of how often each value occurs, so its cost does not grow with n.
    Efron (1987), JASA 82.

    >>> import numpy as np
    >>> low, high = bootstrap_mean([4, 5, 3, 4, 5, 2], np.random.default_rng(0))
    >>> round(low, 2), round(high, 2)
    (2.83, 4.5)
    """
    x = observed(values)
    if x.size < 2 or np.ptp(x) == 0:
        return None
    support, counts = np.unique(x, return_counts=True)
    n = int(x.size)
    means = rng.multinomial(n, counts / n, size=resamples) @ support / n
    below = float(np.mean(means < x.mean()) + np.mean(means == x.mean()) / 2)
    bias = float(ndtri(below))
    left_out = x.mean() - (n * x.mean() - support) / (n - 1)  # jackknife influence of each value
    acceleration = float((counts * left_out**3).sum() / (6 * (counts * left_out**2).sum() ** 1.5))
    z = ndtri(np.array([(1 - level) / 2, (1 + level) / 2]))
    low, high = np.quantile(means, ndtr(bias + (bias + z) / (1 - acceleration * (bias + z))))
    return float(low), float(high)
