"""Do two levels of the same principle, or two modulations, look different: high against low."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from analysis.answers import Answers
from analysis.statistics.binomial import Binomial, binomial
from analysis.statistics.fisher import Fisher, fisher
from analysis.statistics.mcnemar import McNemar, mcnemar
from analysis.statistics.newcombe import Difference, newcombe
from analysis.statistics.paired_t import d_av, paired_t
from analysis.statistics.samples import Moments, moments, observed, observed_pairs
from analysis.statistics.sign_flip import SignFlip, sign_flip
from analysis.statistics.student_t import student_t
from analysis.statistics.t_test import Alternative, TTest
from analysis.statistics.welch_t import welch_t
from analysis.statistics.wilcoxon import Wilcoxon, wilcoxon
from analysis.target import Judging, Verdict, judge

FloatArray = NDArray[np.float64]


PAIRED = frozenset({"paired t", "wilcoxon", "exact sign flip", "McNemar's exact"})  # tests of the differences


@dataclass(frozen=True)
class Choices:
    """Counts and the tests they allow, where the outcome is one of two answers."""

    counts: Mapping[str, tuple[int, int]]  # level → (outcome, other)
    mcnemar: McNemar
    fisher: Fisher
    difference: Difference
    binomial: Mapping[str, Binomial]  # level → is its own answer chosen more often than ½?


@dataclass(frozen=True)
class Compared:
    """One principle with two of its levels compared."""

    name: str
    levels: tuple[str, str]
    summaries: Mapping[str, Moments]
    student: TTest
    welch: TTest
    paired: TTest
    d_av: float | None
    wilcoxon: Wilcoxon
    sign_flip: SignFlip
    choices: Choices | None
    verdict: Verdict

    @property
    def deciding_t(self) -> TTest:
        """The t-test to report: the paired one where pairs are what was tested, else Student's."""
        return self.paired if self.verdict.test in PAIRED else self.student


@dataclass(frozen=True)
class Comparison:
    """Which stimuli are compared, on what."""

    levels: tuple[str, str]  # the first is expected to be higher
    pairs: Mapping[str, tuple[str, str]]  # name → stimuli of the two levels
    item: str  # or a series of items, scored by their mean
    outcome: str | None  # the answer that counts as 1; None where answers are numbers
    other: str | None = None  # the opposite answer


def comparisons(answers: Answers, comparison: Comparison, judging: Judging) -> dict[str, Compared]:
    """Compare the levels of every principle; the family is the principles."""
    values = answers.on(comparison.item, comparison.outcome)
    of = {stimulus: values[:, place] for place, stimulus in enumerate(answers.stimuli)}
    tested = {
        name: _Tests(of[first], of[second], comparison, judging)
        for name, (first, second) in comparison.pairs.items()
    }
    verdicts = judge(judging, {name: tests.deciding(judging.test) for name, tests in tested.items()})
    return {name: tests.result(name, verdicts[name]) for name, tests in tested.items()}


class _Tests:
    """Every test of one pair of samples."""

    def __init__(
        self, first: FloatArray, second: FloatArray, comparison: Comparison, judging: Judging
    ) -> None:
        self.comparison = comparison
        self.samples = dict(zip(comparison.levels, (first, second), strict=True))
        alternative = judging.alternative
        a, b = observed_pairs(first, second)
        self.student = student_t(first, second, alternative)
        self.welch = welch_t(first, second, alternative)
        self.paired = paired_t(first, second, alternative)
        self.d_av = d_av(first, second)
        self.wilcoxon = wilcoxon(a - b, 0.0, alternative)
        self.sign_flip = sign_flip(a - b, 0.0, alternative)
        self.choices = None if comparison.outcome is None else self._choices(first, second, judging)

    def _choices(self, first: FloatArray, second: FloatArray, judging: Judging) -> Choices:
        high, low = self.comparison.levels
        x, y = observed(first), observed(second)
        k1, n1, k2, n2 = int(x.sum()), x.size, int(y.sum()), y.size
        than_half: Alternative = "two-sided" if judging.alternative == "two-sided" else "greater"
        return Choices(
            counts={high: (k1, n1 - k1), low: (k2, n2 - k2)},
            mcnemar=mcnemar(first, second),
            fisher=fisher(k1, n1, k2, n2, judging.alternative),
            difference=newcombe(k1, n1, k2, n2),
            binomial={
                high: binomial(k1, n1, 0.5, than_half),
                low: binomial(n2 - k2, n2, 0.5, than_half),
            },
        )

    def deciding(self, test: str) -> tuple[str, float | None, str | None]:
        """The declared test's name and p, or the exact one where that is undefined, and why."""
        testing = {
            "independent t": (self.student.p, self.student.reason),
            "paired t": (self.paired.p, self.paired.reason),
            "wilcoxon": (self.wilcoxon.p_decisive, self.wilcoxon.reason),
        }
        if test not in testing:
            return self._exact_paired()
        p, reason = testing[test]
        if p is not None:
            return test, p, None
        if test == "independent t":
            return "Fisher's exact", self._fisher().p, reason
        name, p, _ = self._exact_paired()
        return name, p, reason

    def _fisher(self) -> Fisher:
        """Of choices; of ratings that vary in neither group, whether they are the higher of the two."""
        if self.choices is not None:
            return self.choices.fisher
        x, y = (observed(sample) for sample in self.samples.values())
        highest = np.concatenate([x, y]).max(initial=-np.inf)
        k1, k2 = (int((sample == highest).sum()) for sample in (x, y))
        return fisher(k1, x.size, k2, y.size, self.student.alternative)

    def _exact_paired(self) -> tuple[str, float | None, str | None]:
        if self.choices is None:
            return "exact sign flip", self.sign_flip.p, self.sign_flip.reason
        exact = self.choices.mcnemar
        p = exact.p(self.sign_flip.alternative)
        return "McNemar's exact", p, exact.reason if p is None else None

    def result(self, name: str, verdict: Verdict) -> Compared:
        """The tests as a value."""
        return Compared(
            name=name,
            levels=self.comparison.levels,
            summaries={level: moments(sample) for level, sample in self.samples.items()},
            student=self.student,
            welch=self.welch,
            paired=self.paired,
            d_av=self.d_av,
            wilcoxon=self.wilcoxon,
            sign_flip=self.sign_flip,
            choices=self.choices,
            verdict=verdict,
        )
