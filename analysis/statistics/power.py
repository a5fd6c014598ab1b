"""How likely a study finds an effect, and how many participants that takes: before the first of them."""

from __future__ import annotations

from math import sqrt
from typing import Literal

import numpy as np
from scipy.special import nctdtr, stdtrit

from analysis.statistics.binomial import binomial_probability, outcome_probabilities
from analysis.statistics.mcnemar import mcnemar_counts
from analysis.statistics.t_test import Alternative

Design = Literal["one sample", "independent"]
MOST = 1_000_000  # participants; no study has more


def t_power(
    d: float, n: int, *, alpha: float = 0.05, one_sided: bool = True, design: Design = "one sample"
) -> float:
    """Power of a t-test for a true standardised effect d; n per group. Paired: one sample with d_z.

    Agrees with R `power.t.test(n, delta = d, strict = TRUE)`.
    """
    df = n - 1 if design == "one sample" else 2 * n - 2
    ncp = d * sqrt(n if design == "one sample" else n / 2)
    critical = float(stdtrit(df, 1 - alpha if one_sided else 1 - alpha / 2))
    power = 1 - float(nctdtr(df, ncp, critical))
    return power if one_sided else power + float(nctdtr(df, ncp, -critical))


def t_sample_size(
    d: float, power: float, *, alpha: float = 0.05, one_sided: bool = True, design: Design = "one sample"
) -> int:
    """The fewest participants (per group) that reach a power."""
    if d <= 0:
        raise ValueError(f"an effect of {d} is never found; give a d above 0")
    low, high = 1, 2
    while t_power(d, high, alpha=alpha, one_sided=one_sided, design=design) < power:
        low, high = high, high * 2
        if high > MOST:
            raise ValueError(f"more than {MOST} participants would be needed for d = {d}")
    while high - low > 1:
        middle = (low + high) // 2
        enough = t_power(d, middle, alpha=alpha, one_sided=one_sided, design=design) >= power
        low, high = (low, middle) if enough else (middle, high)
    return high


def smallest_effect(
    n: int, power: float = 0.8, *, alpha: float = 0.05, one_sided: bool = True, design: Design = "one sample"
) -> float:
    """The smallest d that n participants (per group) find with that power: the sensitivity of a study."""
    low, high = 0.0, 1.0
    while t_power(high, n, alpha=alpha, one_sided=one_sided, design=design) < power:
        low, high = high, high * 2
    for _ in range(60):
        middle = (low + high) / 2
        enough = t_power(middle, n, alpha=alpha, one_sided=one_sided, design=design) >= power
        low, high = (low, middle) if enough else (middle, high)
    return high


def binomial_power(
    share: float, n: int, *, null: float = 0.5, alpha: float = 0.05, alternative: Alternative = "greater"
) -> float:
    """Power of the exact binomial test when the true share is `share`."""
    rejects = [binomial_probability(k, n, null, alternative) <= alpha for k in range(n + 1)]
    return float(outcome_probabilities(n, share)[rejects].sum())


def mcnemar_power(first_only: float, second_only: float, n: int, *, alpha: float = 0.05) -> float:
    """Power of the exact one-sided McNemar test, given the chances of both kinds of discordant pairs.

    Sums over every number of discordant pairs and of those in the expected direction.
    """
    discordant = first_only + second_only
    if discordant == 0:
        return 0.0
    power = 0.0
    for m, chance in enumerate(outcome_probabilities(n, discordant)):
        p = np.array([mcnemar_counts(b, m - b, neither=n - m).p_one_sided or 0.0 for b in range(m + 1)])
        rejects = p <= alpha
        power += float(chance) * float(outcome_probabilities(m, first_only / discordant)[rejects].sum())
    return power
