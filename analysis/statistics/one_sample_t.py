"""Does the mean of one sample differ from a fixed value?"""

from __future__ import annotations

from functools import partial

from numpy.typing import ArrayLike

from analysis.statistics.samples import moments
from analysis.statistics.t_test import Alternative, Contrast, Method, TTest, t_test

METHOD = Method(
    "one-sample t-test", standardiser="sample standard deviation", reference="Student (1908), Biometrika 6"
)


def one_sample_t(values: ArrayLike, null: float, alternative: Alternative = "two-sided") -> TTest:
    """One-sample t-test of the mean against `null`; d is in sample standard deviations.

    Agrees with R `t.test(x, mu = )` and `effectsize::cohens_d(x, mu = )`. Student (1908), Biometrika 6.

    >>> result = one_sample_t([4, 5, 3, 4, 5, 2], 3, "greater")
    >>> round(result.t, 3), result.df, round(result.p, 4), round(result.d, 3)
    (1.746, 5, 0.0706, 0.713)
    """
    sample = moments(values)
    undefined = partial(
        TTest, METHOD, n=(sample.n,), estimate=sample.mean, null=null, alternative=alternative
    )
    if sample.mean is None or sample.sd is None or sample.se is None:
        return undefined(reason=f"undefined: n = {sample.n}, a t-test needs 2 values")
    if sample.sd == 0:
        return undefined(reason=f"undefined: zero variance, every value is {sample.mean:g}", df=sample.n - 1)
    contrast = Contrast(estimate=sample.mean, se=sample.se, df=sample.n - 1, sd=sample.sd, n=(sample.n,))
    return t_test(METHOD, contrast, null, alternative)
