"""Do two independent groups differ in mean, whatever their variances?"""

from __future__ import annotations

from functools import partial

import numpy as np
from numpy.typing import ArrayLike

from analysis.statistics.samples import moments
from analysis.statistics.t_test import Alternative, Contrast, Method, TTest, root_mean_square, t_test

METHOD = Method(
    "Welch's t-test, independent groups",
    standardiser="root mean square of both standard deviations",
    reference="Welch (1947), Biometrika 34",
)


def welch_t(first: ArrayLike, second: ArrayLike, alternative: Alternative = "two-sided") -> TTest:
    """Welch's t-test of mean(first) − mean(second); d is in root-mean-square standard deviations.

    Degrees of freedom after Welch and Satterthwaite. Agrees with R `t.test(x, y)` and
    `effectsize::cohens_d(x, y, pooled_sd = FALSE)`. Welch (1947), Biometrika 34.

    >>> result = welch_t([4, 5, 3, 4, 5, 2], [2, 3, 3, 1, 2, 2])
    >>> round(result.t, 3), round(result.df, 2), round(result.p, 4)
    (2.936, 8.54, 0.0175)
    """
    a, b = moments(first), moments(second)
    n = (a.n, b.n)
    undefined = partial(TTest, METHOD, n=n, null=0.0, alternative=alternative)
    if a.mean is None or b.mean is None or a.sd is None or b.sd is None or a.se is None or b.se is None:
        return undefined(reason=f"undefined: n = {a.n} and {b.n}, Welch's test needs 2 values in each group")
    estimate = a.mean - b.mean
    if a.sd == b.sd == 0:
        return undefined(reason="undefined: zero variance in both groups", estimate=estimate)
    variance = a.se**2 + b.se**2
    df = variance**2 / (a.se**4 / (a.n - 1) + b.se**4 / (b.n - 1))
    contrast = Contrast(
        estimate=estimate, se=float(np.sqrt(variance)), df=df, sd=root_mean_square(a.sd, b.sd), n=n
    )
    return t_test(METHOD, contrast, 0.0, alternative)
