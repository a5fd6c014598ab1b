"""What every t-test shares: from an estimate and its standard error to t, p, confidence and effect size."""

from __future__ import annotations

from dataclasses import dataclass
from math import sqrt
from typing import Literal, get_args

from scipy.special import stdtr, stdtrit

from analysis.statistics.noncentral_t import hedges_factor, ncp_interval
from stimuli.errors import nearest

Alternative = Literal["greater", "less", "two-sided"]
Interval = tuple[float, float]
SMALLEST = 5e-324  # a probability below the smallest positive number is not 0


@dataclass(frozen=True)
class Method:
    """Which t-test: its name, what its effect size is measured in, and where it comes from."""

    name: str
    standardiser: str
    reference: str


@dataclass(frozen=True)
class TTest:
    """A t-test. Confidence intervals are two-sided at 95% whatever the alternative."""

    method: Method
    n: tuple[int, ...]  # per group
    null: float
    alternative: Alternative
    estimate: float | None = None  # the mean, or the difference of means
    ci95: Interval | None = None  # of the estimate
    t: float | None = None
    df: float | None = None
    p: float | None = None
    d: float | None = None  # (estimate − null) / standardiser
    d_ci95: Interval | None = None
    g: float | None = None  # d without its small-sample bias
    g_ci95: Interval | None = None
    reason: str | None = None  # why t is undefined


@dataclass(frozen=True)
class Contrast:
    """An estimate with what a t-test needs to judge it."""

    n: tuple[int, ...]
    estimate: float
    se: float
    df: float
    sd: float  # what the effect size is measured in


def t_test(method: Method, contrast: Contrast, null: float, alternative: Alternative) -> TTest:
    """Judge a contrast: t = (estimate − null) / se on df degrees of freedom.

    The interval of d is that of the noncentrality parameter times se/sd, and g = J(df) d (both exact).
    """
    t = (contrast.estimate - null) / contrast.se
    half = float(stdtrit(contrast.df, 0.975)) * contrast.se
    scale = contrast.se / contrast.sd
    ncp = ncp_interval(t, contrast.df)
    d_ci95 = None if ncp is None else (ncp[0] * scale, ncp[1] * scale)
    j = hedges_factor(contrast.df)
    return TTest(
        method=method,
        n=contrast.n,
        null=null,
        alternative=alternative,
        estimate=contrast.estimate,
        ci95=(contrast.estimate - half, contrast.estimate + half),
        t=t,
        df=contrast.df,
        p=t_probability(t, contrast.df, alternative),
        d=t * scale,
        d_ci95=d_ci95,
        g=j * t * scale,
        g_ci95=None if d_ci95 is None else (j * d_ci95[0], j * d_ci95[1]),
    )


def t_probability(t: float, df: float, alternative: Alternative) -> float:
    """P-value of t on df degrees of freedom; the tail is computed directly, so it keeps its digits near 0."""
    refuse_other_sides(alternative)
    if alternative == "greater":
        return max(float(stdtr(df, -t)), SMALLEST)
    if alternative == "less":
        return max(float(stdtr(df, t)), SMALLEST)
    return max(float(2 * stdtr(df, -abs(t))), SMALLEST)


def refuse_other_sides(alternative: str) -> None:
    """Raise ValueError unless the alternative is one of the known."""
    if alternative not in (known := get_args(Alternative)):
        raise ValueError(f"alternative {alternative!r}: {nearest(alternative, known)}")


def root_mean_square(*values: float) -> float:
    """√ of the mean of the squares."""
    return sqrt(sum(value * value for value in values) / len(values))
