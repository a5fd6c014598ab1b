"""Do the same participants answer yes more often in one condition than in the other?"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from analysis.statistics.asked import refuse_other_than_yes_and_no
from analysis.statistics.binomial import at_least, outcome_probabilities
from analysis.statistics.clopper_pearson import clopper_pearson
from analysis.statistics.newcombe import Difference, paired_difference
from analysis.statistics.samples import observed_pairs
from analysis.statistics.t_test import Alternative


@dataclass(frozen=True)
class McNemar:
    """McNemar's test on n pairs: only the b + c discordant ones speak."""

    n: int
    b: int  # yes in the first condition only
    c: int  # yes in the second condition only
    both: int
    neither: int
    p_one_sided: float | None  # first > second
    p_two_sided: float | None
    p_mid: float | None  # two-sided mid-p
    p_mid_one_sided: float | None
    odds_ratio: float | None  # b/c
    odds_ratio_ci95: tuple[float, float | None] | None  # exact; an upper limit of None is unbounded
    difference: Difference
    reason: str | None = None

    def p(self, alternative: Alternative) -> float | None:
        """The exact p-value; "greater" means more yes in the first condition, "less" in the second."""
        if alternative == "two-sided" or self.p_two_sided is None:
            return self.p_two_sided
        expected = self.b if alternative == "greater" else self.c
        return at_least(expected, self.b + self.c, 0.5)


def mcnemar(first: ArrayLike, second: ArrayLike) -> McNemar:
    """Exact McNemar test of paired 0/1 answers (position i of both is one participant).

    b | b + c is binomial(½) when the conditions do not differ. Mid-p halves the weight of the observed
    outcome (Fagerland et al. 2013, BMC Med Res Methodol 13). Agrees with R `binom.test(b, b + c)`.
    McNemar (1947), Psychometrika 12.

    >>> result = mcnemar([1, 1, 1, 0, 1, 1], [0, 0, 1, 0, 1, 0])
    >>> result.b, result.c, result.p_one_sided, round(result.p_mid, 4)
    (3, 0, 0.125, 0.125)
    """
    x, y = observed_pairs(first, second)
    refuse_other_than_yes_and_no(x)
    refuse_other_than_yes_and_no(y)
    b, c = int(np.sum((x == 1) & (y == 0))), int(np.sum((x == 0) & (y == 1)))
    both, neither = int(np.sum((x == 1) & (y == 1))), int(np.sum((x == 0) & (y == 0)))
    return mcnemar_counts(b, c, both=both, neither=neither)


def mcnemar_counts(b: int, c: int, *, both: int = 0, neither: int = 0) -> McNemar:
    """The same from counts."""
    n, discordant = b + c + both + neither, b + c
    difference = paired_difference(both, b, c, neither)
    if n == 0:
        return McNemar(0, b, c, both, neither, None, None, None, None, None, None, difference,
                       reason="undefined: no complete pairs")  # fmt: skip
    if discordant == 0:
        return McNemar(n, b, c, both, neither, 1.0, 1.0, 1.0, 0.5, None, None, difference,
                       reason="no discordant pairs: odds ratio undefined")  # fmt: skip
    one_sided = at_least(b, discordant, 0.5)
    mid_one_sided = one_sided - 0.5 * float(outcome_probabilities(b, discordant, 0.5))
    share = clopper_pearson(b, discordant)
    assert share is not None
    return McNemar(
        n=n,
        b=b,
        c=c,
        both=both,
        neither=neither,
        p_one_sided=one_sided,
        p_two_sided=min(1.0, 2 * at_least(max(b, c), discordant, 0.5)),
        p_mid=2 * min(mid_one_sided, 1 - mid_one_sided),
        p_mid_one_sided=mid_one_sided,
        odds_ratio=b / c if c else None,
        odds_ratio_ci95=(share[0] / (1 - share[0]), share[1] / (1 - share[1]) if share[1] < 1 else None),
        difference=difference,
        reason=None if c else "odds ratio unbounded: no pair in the other direction",
    )
