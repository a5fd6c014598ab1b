"""The noncentral t: which noncentralities an observed t leaves open, and how likely each makes it."""

from __future__ import annotations

from functools import cache
from math import exp, inf, isnan, lgamma, log, pi, sqrt

import numpy as np
from numpy.typing import NDArray
from scipy.special import chdtri, nctdtr, ndtri

FAR = 1e4  # of t, beyond which its noncentral distribution takes seconds


@cache
def ncp_interval(t: float, df: float, level: float = 0.95) -> tuple[float, float] | None:
    """Two-sided confidence interval of the noncentrality parameter, given t(df); None where not computable.

    Steiger & Fouladi (1997): the limits put t at the upper and lower (1 − level)/2 quantile.
    """
    tail = (1 - level) / 2
    if t < 0:  # the distribution of −t is that of t mirrored, and nctdtr is accurate for t ≥ 0
        mirrored = ncp_interval(-t, df, level)
        return None if mirrored is None else (-mirrored[1], -mirrored[0])
    low, high = _ncp_at(t, df, 1 - tail), _ncp_at(t, df, tail)
    return None if low is None or high is None else (low, high)


def _ncp_at(t: float, df: float, probability: float) -> float | None:
    """The noncentrality at which P(T ≤ t) is `probability`: secants, or halves where one would lead astray.

    With T = (Z + ncp) / S this is P(tS − Z ≥ ncp), so half of either tail for S and for Z brackets it. Far
    out Z no longer counts: leaving it out changes ncp by a share of about 10 / t².
    """

    def exceeded(tail: float) -> float:
        return t * sqrt(float(chdtri(df, tail)) / df)

    def excess(ncp: float) -> float:
        return float(nctdtr(df, ncp, t)) - probability

    if t > FAR:
        return exceeded(probability)
    rest = 1 - probability
    low = exceeded(1 - rest / 2) + float(ndtri(rest / 2))
    high = exceeded(probability / 2) - float(ndtri(probability / 2))
    last, at = low, high
    last_excess, at_excess = excess(low), excess(high)
    enough = 1e-13 * max(1.0, abs(high))
    for _ in range(100):
        if at_excess == 0 or abs(at - last) <= enough:
            break
        slope = (at_excess - last_excess) / (at - last)
        guess = at - at_excess / slope if slope < 0 else inf
        if not low - enough <= guess <= high + enough:
            guess = (low + high) / 2
        last, last_excess, at, at_excess = at, at_excess, guess, excess(guess)
        if isnan(at_excess):
            return None
        low, high = (at, high) if at_excess > 0 else (low, at)
    return at


@cache
def quadrature(panels: int) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Nodes and weights on [−1, 1]: twenty Gauss–Legendre nodes in each of some equal panels."""
    nodes, weights = np.polynomial.legendre.leggauss(20)
    middles = (2 * np.arange(panels) + 1) / panels - 1
    return (middles[:, None] + nodes / panels).ravel(), np.tile(weights / panels, panels)


def hedges_factor(df: float) -> float:
    """The exact factor J(df) = Γ(df/2) / (√(df/2) Γ((df − 1)/2)) that makes g = J d unbiased.

    Hedges (1981), Journal of Educational Statistics 6.
    """
    return exp(lgamma(df / 2) - 0.5 * log(df / 2) - lgamma((df - 1) / 2)) if df > 1 else 0.0


def log_density(t: float, df: float, ncp: NDArray[np.float64]) -> NDArray[np.float64]:
    """Logarithm of the density of t(df) at each noncentrality, (k,) → (k,).

    T = (Z + ncp) / S with S² a χ² over its df, so the density is the integral over S of a log-concave
    function; Gauss–Legendre around its mode keeps ten digits however far out t is.
    """
    a = t * t + df
    mode = (t * ncp + np.sqrt((t * ncp) ** 2 + 4 * df * a)) / (2 * a)
    width = 1 / np.sqrt(a + df / mode**2)
    low, high = np.maximum(mode - 12 * width, 0), mode + 12 * width
    nodes, weights = quadrature(4)
    s = (low + high)[:, None] / 2 + (high - low)[:, None] / 2 * nodes
    log_chi = log(2) + df / 2 * log(df / 2) - lgamma(df / 2)  # of the density of S, without its powers
    values = df * np.log(s) - df * s**2 / 2 - (t * s - ncp[:, None]) ** 2 / 2
    peak = values.max(axis=1)
    area = (np.exp(values - peak[:, None]) * weights).sum(axis=1) * (high - low) / 2
    density: NDArray[np.float64] = np.log(area) + peak + log_chi - log(2 * pi) / 2
    return density
