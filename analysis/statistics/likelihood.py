"""Where a likelihood is largest, and standard errors from how sharply it bends there.

A likelihood is given as −log L of several parameter vectors at once, (k, m) → (k,).
"""

from __future__ import annotations

from collections.abc import Callable
from math import sqrt

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
Negative = Callable[[FloatArray], FloatArray]
NONE = -10.0  # logarithm of an SD that is 0 for all purposes
FLAT = 1e-4  # of log-likelihood
LARGEST = 15.0  # effect, in log odds; beyond, the likelihood has no maximum to speak of
WIDEST = 10.0  # SD of participants, likewise
REACHES = 4 * 0.8 ** np.arange(50)  # of the steps to a participant's mode; shrinking, they cannot circle it
LENGTHS = np.array([0, *2.0 ** np.arange(3, -9, -1)])[:, None]  # of the steps tried


def minimum(negative: Negative, start: FloatArray) -> FloatArray:
    """The minimum of −log L, (m,), by Newton's method with the best of several step lengths."""
    at = start
    for _ in range(100):
        slope, bend = derivatives(negative, at)
        if np.abs(slope).max() < 1e-6:
            break
        bends, directions = np.linalg.eigh(bend)
        step = -directions @ ((slope @ directions) / np.maximum(np.abs(bends), 1e-6))
        tried = at + LENGTHS * step / max(1.0, np.abs(step).max())
        best = int(np.argmin(negative(tried)))
        if LENGTHS[best] == 0:
            break
        at = tried[best]
    return at


def standard_error(negative: Negative, at: FloatArray, *, of: int, log_sd: int) -> float | None:
    """The error of parameter `of` at the minimum of −log L; None where it does not bend.

    `log_sd` is the place, after `of`, of the logarithm of the participants' SD. Where an SD of 0 is as
    likely, the likelihood is flat in that logarithm, so it is held there.
    """
    none = at.copy()
    none[log_sd] = NONE
    without, fitted = negative(np.array([none, at]))
    if without - fitted < FLAT:
        _, bend = derivatives(negative, none)
        bend = np.delete(np.delete(bend, log_sd, axis=0), log_sd, axis=1)
    else:
        _, bend = derivatives(negative, at)
    variance = np.linalg.pinv(bend)[of, of]
    return sqrt(variance) if np.isfinite(variance) and variance > 0 else None


def derivatives(negative: Negative, at: FloatArray, step: float = 1e-4) -> tuple[FloatArray, FloatArray]:
    """First and second derivatives, (m,) and (m, m), by central differences."""
    steps = np.eye(at.size) * step
    i, j = np.tril_indices(at.size, -1)
    pairs = steps[i] + steps[j]
    found = negative(np.concatenate([[at], at + steps, at - steps, at + pairs, at - pairs]))
    here, up, down, both, neither = np.split(found, np.cumsum([1, at.size, at.size, i.size]))
    bend = np.diag((up - 2 * here + down) / step**2)
    bend[i, j] = (both - up[i] - up[j] + 2 * here - down[i] - down[j] + neither) / (2 * step**2)
    bend[j, i] = bend[i, j]
    return (up - down) / (2 * step), bend
