"""How small an effect the planned participants can find.

Each hypothesis is taken at the smallest level its correction can leave a single test: alpha / m. That is what
Holm's and Benjamini and Hochberg's leave to an effect that is the only one of its family; more effects make
each easier to find. Ratings: the effect is d, the difference in standard deviations. Choices between two
levels: the effect is the share h of participants who choose the outcome for the first level when 1 - h choose
it for the second, answers given independently; the test counted is McNemar's exact one, whatever test the
hypothesis names. Pairs: the share of participants who prefer the first, by the exact binomial test.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Literal

import numpy as np
from numpy.typing import NDArray
from scipy import stats

from study.protocol import Hypothesis, Protocol

AIM = 0.8
MAX_PARTICIPANTS = 2000
Effect = Literal["d", "share"]


@dataclass(frozen=True)
class Power:
    """What one hypothesis can find with n participants."""

    hypothesis: str
    n: int
    tests: int  # in its family
    correction: str  # for their number
    alpha: float  # of the hardest test of the family
    effect: Effect
    smallest: float | None  # effect found with a power of 80 %; None where none can be
    needed: dict[float, int | None]  # assumed effect → participants for a power of 80 %
    basis: str = ""  # what the effect is of and by which test, where that is not the hypothesis's own

    def __str__(self) -> str:
        if self.smallest is None:
            who = "1 participant" if self.n == 1 else f"{self.n} participants"
            return f"{who} cannot reach a power of {AIM:.0%} at alpha {self.alpha:.3g}"
        name = "d" if self.effect == "d" else "a share"
        found = f"{name} ≥ {math.ceil(100 * self.smallest) / 100:.2f}"  # rounded up, or it would not be found
        return f"{self.n} participants find {found} with a power of {AIM:.0%}"

    @property
    def level(self) -> str:
        """At which level of significance, and by which test."""
        which = "each" if self.correction == "none" else "the strictest"
        alone = ", the only one to find something" if self.correction == "benjamini-hochberg" else ""
        of = f"in {which} of {self.tests} tests{alone}, " if self.tests > 1 else ""
        return f"{of}at alpha = {self.alpha:.4g}{self.basis}"

    @property
    def planning(self) -> str:
        """How many participants other effects need."""
        name = "d" if self.effect == "d" else "a share"
        needs = (f"{size:g} needs {n or f'over {MAX_PARTICIPANTS}'}" for size, n in self.needed.items())
        return f"{name} of {', '.join(needs)}"


def power(protocol: Protocol) -> list[Power]:
    """What each hypothesis of a protocol can find with the planned participants."""
    return [
        _power(protocol, name, hypothesis)
        for name, hypothesis in protocol.analysis.hypotheses.items()
        if hypothesis.mirrors is None
    ]


def t_power(n: int, d: float, alpha: float, *, two_sided: bool = False, groups: int = 1) -> float:
    """Power of a one-sample (or paired) t-test, or of a two-sample one with n in each of two groups.

    Noncentral t; of a two-sided test both tails count. Agrees with R `power.t.test(strict = TRUE)` and
    statsmodels (tests/study/test_power.py).
    """
    df = groups * (n - 1)
    shift = d * np.sqrt(n / groups)
    if not two_sided:
        return float(stats.nct.sf(stats.t.isf(alpha, df), df, shift))
    critical = stats.t.isf(alpha / 2, df)
    other_tail = np.nan_to_num(stats.nct.cdf(-critical, df, shift))  # SciPy: nan where it vanishes
    return float(stats.nct.sf(critical, df, shift) + other_tail)


def mcnemar_power(n: int, first: float, second: float, alpha: float, *, two_sided: bool = False) -> float:
    """Exact power of McNemar's exact test where the levels get the outcome with these probabilities."""
    gained, lost = first * (1 - second), second * (1 - first)
    changed = gained + lost
    if changed == 0:
        return 0.0
    one_sided = alpha / 2 if two_sided else alpha
    pairs = np.arange(n + 1)  # participants who answer differently for the two levels
    rejected = _rejected(pairs, gained / changed, one_sided)
    return float(stats.binom.pmf(pairs, n, changed) @ rejected)


def preference_power(n: int, share: float, alpha: float, *, two_sided: bool = False) -> float:
    """Exact power of the binomial test against one half; of a two-sided one both tails count."""
    if not two_sided:
        return float(_rejected(np.array(n), share, alpha))
    both = (_rejected(np.array(n), first, alpha / 2) for first in (share, 1 - share))
    return float(sum(both))


def _rejected(m: NDArray[np.int_], gained: float, alpha: float) -> NDArray[np.float64]:
    """The chance that m pairs reject the null of equal halves, in favour of more gains."""
    too_few = stats.binom.isf(alpha, m, 0.5)  # gains that are not yet significant
    rejected: NDArray[np.float64] = stats.binom.sf(too_few, m, gained)
    return rejected


def family_size(protocol: Protocol, hypothesis: Hypothesis) -> int:
    """How many tests a hypothesis is decided by: one per target, gesture, principle or pair."""
    if hypothesis.compare is None:
        part = protocol.written_parts[hypothesis.part]
        items = {item for question in part.ask for item in question.items}
        return sum(stimulus.name in items for stimulus in protocol.stimuli_of(hypothesis.part))
    if pairs := protocol.pairs_of(hypothesis.part):
        return sum(pair.of(hypothesis.compare) is not None for pair in pairs)
    stimuli = protocol.stimuli_of(hypothesis.part)
    return sum(stimulus.condition == hypothesis.compare[0] for stimulus in stimuli)


def _power(protocol: Protocol, name: str, hypothesis: Hypothesis) -> Power:
    n, part = protocol.participants.planned, protocol.written_parts[hypothesis.part]
    judged, tests = protocol.judged_in(hypothesis.part), family_size(protocol, hypothesis)
    alpha = protocol.analysis.alpha / (1 if hypothesis.correction == "none" else tests)
    two_sided = hypothesis.alternative == "two-sided"
    effect: Effect = "d" if hypothesis.outcome is None and part.pairs is None else "share"

    split = len(judged) // part.order.shown(judged)  # each participant is in one of so many groups

    def at(participants: int, size: float) -> float:
        if part.pairs is not None:
            return preference_power(participants // split, size, alpha, two_sided=two_sided)
        if effect == "share":
            return mcnemar_power(participants, size, 1 - size, alpha, two_sided=two_sided)
        groups = 2 if hypothesis.test == "independent t" else 1
        return t_power(participants // split, size, alpha, two_sided=two_sided, groups=groups)

    largest, assumed = (5.0, (0.2, 0.5, 0.8)) if effect == "d" else (1.0, (0.6, 0.7, 0.8))
    least = 0.0 if effect == "d" else 0.5
    basis = ""
    if effect == "share" and part.pairs is None:
        basis = (
            f", by McNemar's exact test, if so many answer “{hypothesis.outcome}” to one and not to the other"
        )
    elif effect == "d" and hypothesis.test in {"wilcoxon", "binomial"}:
        basis = ", reckoned as for a t-test"
    elif hypothesis.test == "paired t" and effect == "d":
        basis = ", in standard deviations of the differences"
    return Power(
        hypothesis=name,
        n=n,
        tests=tests,
        correction=hypothesis.correction,
        alpha=alpha,
        effect=effect,
        smallest=smallest_effect(lambda size: at(n, size), least, largest) if n // split > 1 else None,
        needed={size: participants_needed(partial(at, size=size)) for size in assumed},
        basis=basis,
    )


def smallest_effect(at: Callable[[float], float], low: float = 0.0, high: float = 5.0) -> float | None:
    """The smallest effect with enough power, by bisection to a millionth."""
    if at(high) < AIM:
        return None
    while high - low > 1e-6:
        middle = (low + high) / 2
        low, high = (low, middle) if at(middle) >= AIM else (middle, high)
    return high


def participants_needed(at: Callable[[int], float]) -> int | None:
    """The number of participants from which on the power suffices; None beyond 2000.

    The power of exact tests goes up and down a little with every participant: after the number that bisection
    finds, the last that does not suffice is looked for.
    """
    low, high = 2, MAX_PARTICIPANTS
    if at(high) < AIM:
        return None
    while low < high:
        middle = (low + high) // 2
        low, high = (low, middle) if at(middle) >= AIM else (middle + 1, high)
    too_few = [n for n in range(high, high + high // 4 + 20) if at(n) < AIM]
    return too_few[-1] + 1 if too_few else high
