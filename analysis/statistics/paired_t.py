"""Do the same participants differ in mean between two conditions?"""

from __future__ import annotations

from dataclasses import replace

from numpy.typing import ArrayLike

from analysis.statistics.one_sample_t import one_sample_t
from analysis.statistics.samples import moments, observed_pairs
from analysis.statistics.t_test import Alternative, Method, TTest, root_mean_square

METHOD = Method(
    "paired t-test",
    standardiser="standard deviation of the differences (d_z)",
    reference="Student (1908), Biometrika 6",
)


def paired_t(first: ArrayLike, second: ArrayLike, alternative: Alternative = "two-sided") -> TTest:
    """Paired t-test of the mean of first − second, position i of both being one participant; d is d_z.

    Agrees with R `t.test(x, y, paired = TRUE)` and `effectsize::cohens_d(x, y, paired = TRUE)`.

    >>> result = paired_t([4, 5, 3, 4, 5, 2], [2, 3, 3, 1, 2, 2])
    >>> round(result.t, 3), result.df, round(result.p, 4)
    (2.988, 5, 0.0305)
    """
    a, b = observed_pairs(first, second)
    result = one_sample_t(a - b, null=0.0, alternative=alternative)
    reason = result.reason
    if reason is not None and len(a) > 1:
        reason = f"undefined: zero variance of the differences, every difference is {a[0] - b[0]:g}"
    return replace(
        result,
        method=METHOD,
        reason=reason,
    )


def d_av(first: ArrayLike, second: ArrayLike) -> float | None:
    """Cohen's d_av: the mean difference in units of the root mean square of both standard deviations.

    Unlike d_z it does not grow with the correlation of the conditions. Cumming (2012).
    """
    a, b = observed_pairs(first, second)
    x, y = moments(a), moments(b)
    if x.mean is None or y.mean is None or x.sd is None or y.sd is None or x.sd == y.sd == 0:
        return None
    return (x.mean - y.mean) / root_mean_square(x.sd, y.sd)
