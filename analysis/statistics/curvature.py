"""Standard errors from how sharply a likelihood bends at its maximum."""

from __future__ import annotations

from collections.abc import Callable
from math import sqrt

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
NONE = -10.0  # logarithm of an SD that is 0 for all purposes
FLAT = 1e-4  # of log-likelihood


def standard_error(
    negative: Callable[[FloatArray], float], at: FloatArray, *, of: int, log_sd: int
) -> float | None:
    """The error of parameter `of` at the minimum of −log L; None where it does not bend.

    `log_sd` is the place of the logarithm of the participants' SD. Where an SD of 0 is as likely, the
    likelihood is flat in that logarithm, so it is held there.
    """
    none = at.copy()
    none[log_sd] = NONE
    held = negative(none) - negative(at) < FLAT
    free = [place for place in range(at.size) if place != log_sd or not held]

    def of_free(parameters: FloatArray) -> float:
        whole = none.copy() if held else at.copy()
        whole[free] = parameters
        return negative(whole)

    variance = np.linalg.pinv(hessian(of_free, at[free]))[free.index(of), free.index(of)]
    return sqrt(variance) if np.isfinite(variance) and variance > 0 else None


def hessian(function: Callable[[FloatArray], float], at: FloatArray, step: float = 1e-4) -> FloatArray:
    """Second derivatives by central differences."""
    steps = np.eye(at.size) * step
    result = np.empty((at.size, at.size))
    for i, e in enumerate(steps):
        for j, f in enumerate(steps[: i + 1]):
            corners = (
                function(at + e + f) - function(at + e - f) - function(at - e + f) + function(at - e - f)
            )
            result[i, j] = result[j, i] = corners / (4 * step**2)
    return result
