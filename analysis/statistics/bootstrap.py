"""A confidence interval of a mean rating without a distribution."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.special import ndtr, ndtri

from analysis.statistics.samples import observed
from analysis.statistics.t_test import Interval

FloatArray = NDArray[np.float64]


def bootstrap_mean(
    values: ArrayLike, rng: np.random.Generator, *, resamples: int = 9999, level: float = 0.95
) -> Interval | None:
    """BCa interval of the mean; None where the values do not vary.

    A resample of ratings is a draw of how often each value occurs, so its cost does not grow with n.
    Efron (1987), JASA 82.

    >>> import numpy as np
    >>> low, high = bootstrap_mean([4, 5, 3, 4, 5, 2], np.random.default_rng(0))
    >>> round(low, 1), round(high, 1)
    (2.8, 4.5)
    """
    x = observed(values)
    if x.size < 2 or np.ptp(x) == 0:
        return None
    support, counts = np.unique(x, return_counts=True)
    means = rng.multinomial(x.size, counts / x.size, size=resamples) @ support / x.size
    return bca(means, float(x.mean()), acceleration_of_mean(x), level)


def bca(replicates: FloatArray, estimate: float, acceleration: float, level: float = 0.95) -> Interval:
    """Bias-corrected and accelerated limits among bootstrap replicates of an estimate.

    Replicates equal to the estimate count half as below it. Agrees with R
    `boot.ci(b, level, type = "bca", L = empinf(type = "jack"))` on the same replicates.
    """
    below = np.mean(replicates < estimate) + np.mean(replicates == estimate) / 2
    bias = float(ndtri(np.clip(below, 1 / (replicates.size + 1), replicates.size / (replicates.size + 1))))
    z = bias + ndtri(np.array([(1 - level) / 2, (1 + level) / 2]))
    low, high = _quantiles(replicates, ndtr(bias + z / (1 - acceleration * z)))
    return float(low), float(high)


def acceleration_of_mean(x: FloatArray) -> float:
    """How fast the standard error changes with the mean, by the jackknife: Σ L³ / 6 (Σ L²)^1.5."""
    influence = (x - x.mean()) * x.size / (x.size - 1)
    return float((influence**3).sum() / (6 * (influence**2).sum() ** 1.5))


def _quantiles(replicates: FloatArray, probabilities: FloatArray) -> FloatArray:
    """Quantiles interpolated on the scale of normal quantiles (Davison & Hinkley 1997, eq. 5.8)."""
    ordered, size = np.sort(replicates), replicates.size
    rank = np.clip(probabilities * (size + 1), 1, size)
    below = np.minimum(np.floor(rank).astype(int), size - 1)
    left, right = ndtri(below / (size + 1)), ndtri((below + 1) / (size + 1))
    weight = (ndtri(rank / (size + 1)) - left) / (right - left)
    found: FloatArray = ordered[below - 1] + weight * (ordered[below] - ordered[below - 1])
    return found
