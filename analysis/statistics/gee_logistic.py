"""Choices of the same participants under two conditions: logistic regression with clustered errors."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike


@dataclass(frozen=True)
class GeeLogistic:
    """Population-averaged log odds ratio."""

    n: int
    participants: int
    effect: float | None  # log odds ratio per unit of x
    se: float | None  # robust; bias-reduced below 40 participants
    p: float | None  # two-sided, Wald
    reason: str | None = None


def gee_logistic(
    chosen: ArrayLike, x: ArrayLike, participants: ArrayLike, *, bias_reduced: bool | None = None
) -> GeeLogistic:
    """Generalised estimating equations, exchangeable working correlation, rows (n,) of 0/1 answers.

    Below 40 participants errors are bias-reduced (Mancl & DeRouen 2001) unless told otherwise. Agrees with R
    `geepack::geeglm(corstr = "exchangeable")`. Liang & Zeger (1986), Biometrika 73.
    """
    y, covariate = np.asarray(chosen, dtype=float), np.asarray(x, dtype=float)
    _, group = np.unique(np.asarray(participants), return_inverse=True)
    n, count = y.size, int(group.max()) + 1 if group.size else 0
    for level in np.unique(covariate):
        if np.ptp(y[covariate == level]) == 0:
            return GeeLogistic(n, count, None, None, None, "undefined: complete separation in a condition")
    if n == 0 or np.ptp(covariate) == 0:
        return GeeLogistic(n, count, None, None, None, "undefined: one condition only")
    import statsmodels.api as sm

    order = np.argsort(group, kind="stable")
    design = np.column_stack([np.ones(n), covariate])[order]
    model = sm.GEE(
        y[order], design, group[order], family=sm.families.Binomial(), cov_struct=sm.cov_struct.Exchangeable()
    )
    reduce = count < 40 if bias_reduced is None else bias_reduced
    fit = model.fit(cov_type="bias_reduced" if reduce else "robust")
    return GeeLogistic(n, count, float(fit.params[1]), float(fit.bse[1]), float(fit.pvalues[1]))
