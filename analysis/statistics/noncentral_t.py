"""The noncentrality parameters under which an observed t is neither too large nor too small."""

from __future__ import annotations

from math import exp, isnan, lgamma, log

from scipy.special import nctdtr


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
    """The noncentrality at which P(T ≤ t) is `probability`, by bisection (the function falls with ncp)."""
    reach = 3.5 + 0.2 * abs(t)  # a bracket that starts wide meets NaN in the far tail
    low, high = t - reach, t + reach
    for _ in range(100):
        middle = (low + high) / 2
        value = float(nctdtr(df, middle, t))
        if isnan(value):
            return None
        low, high = (middle, high) if value > probability else (low, middle)
        if high - low <= 1e-13 * max(1.0, abs(high)):
            break
    at_edge = min(abs(middle - (t - reach)), abs(middle - (t + reach))) < 1e-9 * reach
    return None if at_edge else middle


def hedges_factor(df: float) -> float:
    """The exact factor J(df) = Γ(df/2) / (√(df/2) Γ((df − 1)/2)) that makes g = J d unbiased.

    Hedges (1981), Journal of Educational Statistics 6.
    """
    return exp(lgamma(df / 2) - 0.5 * log(df / 2) - lgamma((df - 1) / 2)) if df > 1 else 0.0
