"""Is what a stimulus was meant to express seen in it: its target item against chance."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import isclose

from analysis.answers import Answers
from analysis.chance import Definition, Scores, Target, applicable
from analysis.statistics.adjustment import Correction, adjust
from analysis.statistics.binomial import Binomial, binomial
from analysis.statistics.one_sample_t import METHOD, one_sample_t
from analysis.statistics.samples import ROUNDING, Moments, moments, observed
from analysis.statistics.sign_flip import SignFlip, sign_flip
from analysis.statistics.t_test import Alternative, TTest
from analysis.statistics.wilcoxon import Wilcoxon, wilcoxon
from study.protocol.plan import TEST_NAMES, Test


@dataclass(frozen=True)
class Verdict:
    """The p-value a decision rests on."""

    test: str
    p: float | None
    p_adjusted: float | None  # for the family of the hypothesis
    significant: bool | None
    note: str | None = None  # when another test than the declared one decides

    @property
    def by(self) -> str:
        """The test that decided, where it was none of t; else empty."""
        return "" if self.test.endswith(" t") else TEST_NAMES.get(self.test, self.test).removesuffix(" test")


@dataclass(frozen=True)
class AgainstChance:
    """One stimulus under one definition of chance."""

    definition: Definition
    null: float
    estimated: bool
    test: TTest | Binomial
    exact: SignFlip | Binomial

    @property
    def p(self) -> float | None:
        """The test's p, or the exact one where the test is undefined."""
        return self.exact.p if self.test.p is None else self.test.p

    @property
    def t_test(self) -> TTest:
        """The t-test; undefined where hits are counted."""
        if isinstance(self.test, TTest):
            return self.test
        reason = "no t-test of hits: exact binomial test"
        return TTest(METHOD, (self.test.n,), self.test.null, self.test.alternative, reason=reason)


@dataclass(frozen=True)
class Recognised:
    """One stimulus with everything tested about its target."""

    stimulus: str
    item: str
    summary: Moments
    against: AgainstChance
    wilcoxon: Wilcoxon
    verdict: Verdict
    sensitivity: Mapping[str, AgainstChance]  # by name of the definition
    sensitivity_verdicts: Mapping[str, Verdict]

    @property
    def depends_on_definition(self) -> bool:
        """Whether another definition of chance leads to another decision."""
        return any(
            verdict.significant != self.verdict.significant for verdict in self.sensitivity_verdicts.values()
        )


@dataclass(frozen=True)
class Judging:
    """How a family of tests is judged."""

    test: Test
    alternative: Alternative
    correction: Correction
    alpha: float

    @property
    def named(self) -> str:
        """The declared test as it is called."""
        return TEST_NAMES[self.test]

    @property
    def sides(self) -> str:
        """One-sided or two-sided."""
        return "two-sided" if self.alternative == "two-sided" else "one-sided"

    @property
    def adjustment(self) -> str:
        """How p-values are adjusted, as an adjective."""
        return "unadjusted" if self.correction == "none" else f"{self.correction.title()}-adjusted"


def recognition(
    answers: Answers, targets: Mapping[str, str], definition: Definition, judging: Judging
) -> dict[str, Recognised]:
    """Test each stimulus's target item against chance; `targets` maps stimuli to items."""
    places = {
        stimulus: Target(answers, answers.stimuli.index(stimulus), answers.items.index(item))
        for stimulus, item in targets.items()
    }
    main = {s: against_chance(definition, target, judging.alternative) for s, target in places.items()}
    ranks = {s: _wilcoxon(main[s], target) for s, target in places.items()}
    sensitivity = {
        name: {s: against_chance(other, target, judging.alternative) for s, target in places.items()}
        for name, other in applicable(len(answers.stimuli), len(answers.items)).items()
    }
    verdicts = judge(judging, {s: _deciding(judging.test, main[s], ranks[s]) for s in targets})
    other_verdicts = {
        name: judge(judging, {s: _alike(judging.test, result, places[s]) for s, result in results.items()})
        for name, results in sensitivity.items()
    }
    return {
        stimulus: Recognised(
            stimulus=stimulus,
            item=item,
            summary=moments(places[stimulus].on_target),
            against=main[stimulus],
            wilcoxon=ranks[stimulus],
            verdict=verdicts[stimulus],
            sensitivity={name: results[stimulus] for name, results in sensitivity.items()},
            sensitivity_verdicts={name: results[stimulus] for name, results in other_verdicts.items()},
        )
        for stimulus, item in targets.items()
    }


def against_chance(definition: Definition, target: Target, alternative: Alternative) -> AgainstChance:
    """Test one stimulus under one definition: t and exact sign flip, or for hits the binomial test."""
    scores = definition.scores(target)
    if scores.hits:
        test = _hits(scores, alternative)
        return AgainstChance(definition, scores.null, scores.estimated, test, test)
    return AgainstChance(
        definition,
        scores.null,
        scores.estimated,
        one_sample_t(scores.values, scores.null, alternative),
        sign_flip(scores.values, scores.null, alternative),
    )


def _hits(scores: Scores, alternative: Alternative) -> Binomial:
    hits = observed(scores.values)
    return binomial(int(hits.sum()), hits.size, scores.null, alternative)


def _wilcoxon(result: AgainstChance, target: Target) -> Wilcoxon:
    scores = result.definition.scores(target)
    return wilcoxon(scores.values, scores.null, result.exact.alternative)


def _name(result: AgainstChance) -> str:
    return "binomial" if isinstance(result.test, Binomial) else "one-sample t"


def _deciding(test: str, result: AgainstChance, ranks: Wilcoxon) -> tuple[str, float | None, str | None]:
    """The declared test's name and p, or the exact test where the declared one is undefined, and why."""
    if test == "wilcoxon" and ranks.p is not None:
        return test, ranks.p_decisive, None
    if result.test.p is not None:
        return _name(result), result.test.p, None
    return "exact sign flip", result.exact.p, result.test.reason


def _alike(test: str, result: AgainstChance, target: Target) -> tuple[str, float | None, str | None]:
    """The same under another definition, so that decisions differ by that alone."""
    if test == "wilcoxon" and not isinstance(result.test, Binomial):
        return _deciding(test, result, _wilcoxon(result, target))
    return _name(result), result.p, None


def judge(judging: Judging, family: Mapping[str, tuple[str, float | None, str | None]]) -> dict[str, Verdict]:
    """Adjust the p-values of a family and decide at alpha."""
    adjusted = adjust({name: p for name, (_, p, _) in family.items()}, judging.correction)
    return {
        name: Verdict(test, p, corrected, _below(corrected, judging.alpha), note)
        for name, (test, p, note) in family.items()
        for corrected in [adjusted[name]]
    }


def _below(p: float | None, alpha: float) -> bool | None:
    """Whether p < α beyond the rounding of sums: exact tests of few participants can give α itself."""
    return None if p is None else p < alpha and not isclose(p, alpha, rel_tol=ROUNDING)
