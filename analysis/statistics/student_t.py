"""Do two independent groups of equal variance differ in mean?"""

from __future__ import annotations

from functools import partial
from math import sqrt

from numpy.typing import ArrayLike

from analysis.statistics.samples import Moments, moments
from analysis.statistics.t_test import Alternative, Contrast, Method, TTest, t_test

METHOD = Method(
    "Student's t-test, independent groups",
    standardiser="pooled standard deviation",
    reference="Student (1908), Biometrika 6",
)


def student_t(first: ArrayLike, second: ArrayLike, alternative: Alternative = "two-sided") -> TTest:
    """Student's t-test of mean(first) − mean(second); d is in pooled standard deviations.

    Agrees with R `t.test(x, y, var.equal = TRUE)` and `effectsize::cohens_d(x, y)`. Student (1908),
    Biometrika 6.

    >>> result = student_t([4, 5, 3, 4, 5, 2], [2, 3, 3, 1, 2, 2], "greater")
    >>> round(result.t, 3), result.df, round(result.p, 4)
    (2.936, 10, 0.0074)
    >>> student_t([1, 1, 1], [0, 0, 0]).reason
    'undefined: zero variance in both groups'
    """
    return student_t_of(moments(first), moments(second), alternative)


def student_t_of(a: Moments, b: Moments, alternative: Alternative = "two-sided") -> TTest:
    """The same from the number, mean and standard deviation of both groups."""
    n = (a.n, b.n)
    undefined = partial(TTest, METHOD, n=n, null=0.0, alternative=alternative)
    if a.mean is None or b.mean is None or a.n + b.n < 3:
        return undefined(reason=f"undefined: n = {a.n} and {b.n}, too few for a t-test")
    df = a.n + b.n - 2
    estimate = a.mean - b.mean
    pooled = sqrt(((a.n - 1) * (a.sd or 0) ** 2 + (b.n - 1) * (b.sd or 0) ** 2) / df)
    if pooled == 0:
        return undefined(reason="undefined: zero variance in both groups", estimate=estimate, df=df)
    contrast = Contrast(estimate=estimate, se=pooled * sqrt(1 / a.n + 1 / b.n), df=df, sd=pooled, n=n)
    return t_test(METHOD, contrast, 0.0, alternative)
