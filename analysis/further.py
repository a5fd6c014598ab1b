"""What a strict reviewer asks for beside the declared tests: other models, evidence, agreement and order."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from analysis.answers import Answers, FloatArray
from analysis.dataset import Responses
from analysis.order import Order, order_of
from analysis.plan import Findings, Levels, Outcome, Targets, decide_all
from analysis.statistics.bayes_factor import BayesFactor, jzs_bayes_factor
from analysis.statistics.bootstrap import bootstrap_mean
from analysis.statistics.cronbach_alpha import CronbachAlpha, cronbach_alpha
from analysis.statistics.cumulative_link_mixed import CumulativeLinkMixed, cumulative_link_mixed
from analysis.statistics.equivalence import Equivalence, equivalence
from analysis.statistics.friedman import Friedman, friedman
from analysis.statistics.gee_logistic import GeeLogistic, gee_logistic
from analysis.statistics.icc import Icc, icc
from analysis.statistics.krippendorff import krippendorff_alpha
from analysis.statistics.label_permutation import LabelPermutation, label_permutation
from analysis.statistics.linear_mixed import LinearMixed, linear_mixed
from analysis.statistics.logistic_mixed import LogisticMixed, logistic_mixed
from analysis.statistics.recognition_rate import UnbiasedHitRate, confusion, unbiased_hit_rates
from analysis.statistics.t_test import Interval
from analysis.target import Recognised
from study.protocol import Protocol

SEED = 0  # of the bootstrap
CLOSE = 0.5  # points of the scale within which a mean is practically at chance, or of a finer scale
CLOSE_SHARE = 0.05  # of its length
MOST = 2000  # participants for whom mixed models are fitted; beyond, they take minutes and tell nothing new


@dataclass(frozen=True)
class OfTarget:
    """Beside the test of one stimulus's target."""

    mean_ci95: Interval | None  # BCa bootstrap
    friedman: Friedman  # are the items of this stimulus rated differently?
    permutation: LabelPermutation
    ordinal: CumulativeLinkMixed | None  # is the target rated higher than the other items?
    bayes: BayesFactor
    equivalence: Equivalence | None  # is the mean practically at chance?
    hits: UnbiasedHitRate


@dataclass(frozen=True)
class OfLevels:
    """Beside the test of one principle's levels."""

    bayes: BayesFactor
    gee: GeeLogistic | None  # of choices
    mixed: LogisticMixed | None  # of choices
    ordinal: CumulativeLinkMixed | None  # of ratings


@dataclass(frozen=True)
class Agreement:
    """How far participants agree about what they saw; subjects are every item of every stimulus."""

    krippendorff: float | None
    icc: Mapping[str, Icc]


@dataclass(frozen=True)
class Further:
    """All further checks of a study, by hypothesis."""

    targets: Mapping[str, Mapping[str, OfTarget]]
    levels: Mapping[str, Mapping[str, OfLevels]]
    confusions: Mapping[str, Mapping[str, NDArray[np.float64]]]  # by rule for ties: counts (stimuli, items)
    crossed: Mapping[
        str, LinearMixed | None
    ]  # how far targets are rated above the other items of their clips
    agreement: Mapping[str, Agreement]
    order: Mapping[str, Order]
    scales: Mapping[str, CronbachAlpha]  # by "part: series"
    before: Mapping[str, Outcome]  # the declared tests without exclusions; empty where nobody was left out

    def changed(self, findings: Findings) -> Iterator[tuple[str, str]]:
        """Hypothesis and test of every decision that exclusions changed."""
        for name, outcome in self.before.items():
            after = findings.outcomes[name].results
            for key, one in outcome.results.items():
                if one.verdict.significant != after[key].verdict.significant:
                    yield name, key


def look_further(findings: Findings, responses: Responses, protocol: Protocol) -> Further:
    """All further checks; `responses` are those of everybody, `findings` those of who was kept."""
    counted = {name: one for name, one in findings.outcomes.items() if not _mirrors(one)}
    targets = {name: one for name, one in counted.items() if isinstance(one, Targets)}
    levels = {name: one for name, one in counted.items() if isinstance(one, Levels)}
    shown = findings.responses.trials
    orders = {name: order_of(one, shown[one.part]) for name, one in counted.items() if one.part in shown}
    return Further(
        targets={name: _of_targets(one) for name, one in targets.items()},
        levels={name: {key: _of_levels(one, key) for key in one.results} for name, one in levels.items()},
        confusions={
            name: {ties: confusion(one.answers.ratings, ties) for ties in ("share", "miss")}
            for name, one in targets.items()
        },
        crossed={name: _crossed(one) for name, one in targets.items()},
        agreement={name: _agreement(one.answers) for name, one in targets.items()},
        order={name: order for name, order in orders.items() if order is not None},
        scales=dict(_scales(findings.responses)),
        before=decide_all(responses, protocol) if findings.flow.excluded else {},
    )


def _mirrors(outcome: Outcome) -> bool:
    return isinstance(outcome, Levels) and outcome.mirrors is not None


def _of_targets(outcome: Targets) -> dict[str, OfTarget]:
    answers = outcome.answers
    stimuli = [answers.stimuli.index(stimulus) for stimulus in outcome.results]
    items = [answers.items.index(one.item) for one in outcome.results.values()]
    counts = confusion(answers.ratings)[stimuli]
    hits = unbiased_hit_rates(counts, items)
    return {
        stimulus: _of_target(outcome, one, answers.ratings[:, s], i, hit)
        for (stimulus, one), s, i, hit in zip(outcome.results.items(), stimuli, items, hits, strict=True)
    }


def _of_target(
    outcome: Targets, one: Recognised, ratings: FloatArray, item: int, hits: UnbiasedHitRate
) -> OfTarget:
    on_target, null, (low, high) = ratings[:, item], one.against.null, outcome.answers.scale or (0, 0)
    close = max(CLOSE, CLOSE_SHARE * (high - low))
    scores_are_ratings = outcome.chance in {"midpoint", "grand mean", "fixed"}
    return OfTarget(
        mean_ci95=bootstrap_mean(on_target, np.random.default_rng(SEED)),
        friedman=friedman(ratings),
        permutation=label_permutation(ratings, item),
        ordinal=_ordinal(ratings, np.arange(ratings.shape[1]) == item),
        bayes=jzs_bayes_factor(one.against.t_test),
        equivalence=equivalence(on_target, (null - close, null + close)) if scores_are_ratings else None,
        hits=hits,
    )


def _crossed(outcome: Targets) -> LinearMixed | None:
    """Each clip's target above the mean of its other items, participants and clips drawn from many."""
    answers, results = outcome.answers, outcome.results
    if len(answers.participants) > MOST:
        return None
    if len(answers.items) == 1:
        return LinearMixed(0, len(answers.participants), len(results), reason="undefined: one item only")
    stimuli = [answers.stimuli.index(stimulus) for stimulus in results]
    items = [answers.items.index(one.item) for one in results.values()]
    ratings = answers.ratings[:, stimuli]  # (participants, clips, items)
    target = ratings[:, np.arange(len(stimuli)), items]
    above = target - (ratings.sum(axis=2) - target) / (ratings.shape[2] - 1)
    person, clip = np.indices(above.shape)
    return linear_mixed(above.ravel(), person.ravel(), clip.ravel())


def _of_levels(outcome: Levels, principle: str) -> OfLevels:
    one, answers = outcome.results[principle], outcome.answers
    stimuli = [answers.stimuli.index(stimulus) for stimulus in outcome.comparison.pairs[principle]]
    bayes = jzs_bayes_factor(one.student if one.paired.t is None else one.paired)
    values = answers.on(outcome.comparison.item, outcome.comparison.outcome)[:, stimuli]
    if outcome.comparison.outcome is None:
        ordinal = _ordinal(values, np.array([True, False])) if outcome.within else None
        return OfLevels(bayes, None, None, ordinal)
    if len(answers.participants) > MOST:
        return OfLevels(bayes, None, None, None)
    rows = _rows(values, np.array([1.0, 0.0]))
    return OfLevels(bayes, gee_logistic(*rows), logistic_mixed(*rows), None)


def _ordinal(ratings: FloatArray, first: NDArray[np.bool_]) -> CumulativeLinkMixed | None:
    if len(ratings) > MOST:
        return None
    return cumulative_link_mixed(*_rows(ratings, first.astype(float)))


def _rows(values: FloatArray, x: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Answers (participants, columns) as rows of value, x of the column, and participant."""
    there = ~np.isnan(values)
    person, column = np.nonzero(there)
    return values[there], x[column], person.astype(float)


def _agreement(answers: Answers) -> Agreement:
    ratings = answers.ratings
    units = ratings.reshape(len(ratings), ratings.shape[1] * ratings.shape[2])  # participants are the raters
    correlations = icc(units.T) if len(answers.participants) <= MOST else {}
    return Agreement(krippendorff_alpha(units), correlations)


def _scales(responses: Responses) -> Iterator[tuple[str, CronbachAlpha]]:
    """Cronbach's alpha of each series of items, over every clip a participant judged."""
    for answers in responses.questions:
        for series, names in answers.series.items():
            items = [answers.items.index(name) for name in names if name in answers.items]
            if len(items) > 1:
                judged = answers.ratings[:, :, items].reshape(-1, len(items))
                yield f"{answers.part}: {series}", cronbach_alpha(judged)
