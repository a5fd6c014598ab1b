"""Models, equivalence and Bayes factors against R 4.2.2 (ordinal, geepack, BayesFactor)."""

from __future__ import annotations

import csv
from itertools import product
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.stats import nct

from analysis.statistics.bayes_factor import jzs_bayes_factor
from analysis.statistics.bootstrap import bootstrap_mean
from analysis.statistics.cumulative_link_mixed import cumulative_link_mixed
from analysis.statistics.equivalence import equivalence
from analysis.statistics.gee_logistic import gee_logistic
from analysis.statistics.label_permutation import label_permutation
from analysis.statistics.linear_mixed import linear_mixed
from analysis.statistics.logistic_mixed import logistic_mixed
from analysis.statistics.noncentral_t import log_density
from analysis.statistics.one_sample_t import one_sample_t
from analysis.statistics.order_effects import carry_over, position_effect
from analysis.statistics.student_t import student_t
from tests.analysis.statistics.test_agreement import W
from tests.analysis.statistics.test_t_tests import X


@pytest.fixture(scope="module")
def ordinal() -> dict[str, np.ndarray]:
    with (Path(__file__).parent / "data" / "ordinal.csv").open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    return {name: np.array([int(row[name]) for row in rows]) for name in rows[0]}


@pytest.fixture(scope="module")
def holes(ordinal: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
    """The same without every seventh row, by participant."""
    order = np.argsort(ordinal["participant"], kind="stable")
    kept = np.arange(1, order.size + 1) % 7 != 0
    return {name: column[order][kept] for name, column in ordinal.items()}


def test_the_cumulative_link_mixed_model_agrees_with_r(ordinal: dict[str, np.ndarray]) -> None:
    # R: ordinal::clmm(factor(rating) ~ condition + (1 | participant), data = d)
    fit = cumulative_link_mixed(ordinal["rating"], ordinal["condition"], ordinal["participant"])
    assert fit.effect == pytest.approx(0.7365227414495072, abs=5e-3)
    assert fit.log_likelihood == pytest.approx(-358.1551625162096, abs=1e-3)
    assert fit.se == pytest.approx(0.244167304577707, abs=1e-3)
    assert fit.thresholds == pytest.approx((-1.3781252, -0.0483042, 0.8599363, 2.1205095), abs=1e-3)
    assert fit.participant_sd == pytest.approx(1.3278458786438521, abs=1e-3)


def test_twice_the_participants_give_the_same_effect_and_twice_the_log_likelihood(
    ordinal: dict[str, np.ndarray],
) -> None:
    x, people = ordinal["condition"], ordinal["participant"]
    again = np.tile(x, 2), np.concatenate([people, people + people.max() + 1])
    chosen = (ordinal["rating"] > 3).astype(float)
    for fit, answers in ((cumulative_link_mixed, ordinal["rating"]), (logistic_mixed, chosen)):
        once, twice = fit(answers, x, people), fit(np.tile(answers, 2), *again)
        assert twice.participants == 2 * once.participants
        assert twice.effect == pytest.approx(once.effect, abs=1e-5)
        assert twice.log_likelihood == pytest.approx(2 * once.log_likelihood, abs=1e-6)


def test_the_mixed_model_does_not_care_about_the_order_of_rows(ordinal: dict[str, np.ndarray]) -> None:
    shuffled = np.random.default_rng(0).permutation(ordinal["rating"].size)
    columns = [ordinal[name] for name in ("rating", "condition", "participant")]
    one, other = (
        cumulative_link_mixed(*rows) for rows in (columns, [column[shuffled] for column in columns])
    )
    assert other.effect == pytest.approx(one.effect, abs=1e-5)


def test_separated_or_constant_ratings_have_no_model() -> None:
    assert cumulative_link_mixed([3, 3], [0, 1], ["a", "b"]).reason == "undefined: one rating only"
    assert cumulative_link_mixed([3, 4], [1, 1], ["a", "b"]).reason == "undefined: one condition only"


def test_gee_agrees_with_r(ordinal: dict[str, np.ndarray]) -> None:
    # R: geepack::geeglm(rating >= 4 ~ condition, participant, family = binomial, corstr = "exchangeable")
    chosen = ordinal["rating"] >= 4
    fit = gee_logistic(chosen, ordinal["condition"], ordinal["participant"], bias_reduced=False)
    assert (fit.effect, fit.se) == pytest.approx((0.276424917927147, 0.261688872351838), rel=1e-9)
    separated = gee_logistic([1, 1, 0, 1], [1, 1, 0, 0], [1, 2, 1, 2])
    assert separated.reason == "undefined: complete separation in a condition"


def test_gee_agrees_with_r_where_answers_are_missing(holes: dict[str, np.ndarray]) -> None:
    # R: geeglm(…, data = d[seq_len(nrow(d)) %% 7 != 0, ], control = geese.control(epsilon = 1e-13))
    fit = gee_logistic(holes["rating"] >= 4, holes["condition"], holes["participant"], bias_reduced=False)
    assert (fit.effect, fit.se) == pytest.approx((0.3146347704368489, 0.2860731510764124), rel=1e-9)
    assert fit.p == pytest.approx(0.27140172501742088, rel=1e-9)
    reduced = gee_logistic(holes["rating"] >= 4, holes["condition"], holes["participant"])
    assert reduced.effect == fit.effect and reduced.se > fit.se  # fewer than 40 participants


def test_the_logistic_mixed_model_agrees_with_r(
    ordinal: dict[str, np.ndarray], holes: dict[str, np.ndarray]
) -> None:
    # R: lme4::glmer(rating >= 4 ~ condition + (1 | participant), d, binomial, nAGQ = 25)
    fit = logistic_mixed(ordinal["rating"] >= 4, ordinal["condition"], ordinal["participant"])
    assert (fit.intercept, fit.effect) == pytest.approx((-0.641066475977365, 0.3612988439573291), abs=1e-4)
    assert fit.se == pytest.approx(0.3021130194272402, abs=1e-5)
    assert fit.participant_sd == pytest.approx(1.222038166702902, abs=1e-4)
    fit = logistic_mixed(holes["rating"] >= 4, holes["condition"], holes["participant"])
    assert (fit.effect, fit.se) == pytest.approx((0.3952121819814631, 0.3236410612738055), abs=1e-4)


@pytest.mark.parametrize(
    ("values", "participants", "stimuli", "reason"),
    [
        ([1, 2, 3], ["a", "a", "a"], [1, 2, 3], "one participant only"),
        ([1, 2, 3], ["a", "b", "c"], [1, 1, 1], "one stimulus only"),
        ([1, 2, 3], ["a", "b", "c"], [1, 1, 2], "one answer per participant or stimulus"),
        ([3, 3, 3, 3], ["a", "a", "b", "b"], [1, 2, 1, 2], "zero variance"),
        ([1, 2, 2, 3], ["a", "a", "b", "b"], [1, 2, 1, 2], "participants and stimuli explain every answer"),
    ],
)
def test_a_linear_mixed_model_that_cannot_be_says_why(
    values: list[float], participants: list[str], stimuli: list[int], reason: str
) -> None:
    fit = linear_mixed(values, participants, stimuli)
    assert fit.estimate is None and fit.reason == f"undefined: {reason}"


def test_a_linear_mixed_model_of_nobodys_own_ways_is_a_t_test() -> None:
    rng = np.random.default_rng(4)
    values = rng.normal(3, 1, (20, 5))
    alike = values - values.mean(axis=0) - values.mean(axis=1, keepdims=True) + 2 * values.mean()
    people, clips = np.indices(values.shape)
    fit = linear_mixed(alike.ravel(), people.ravel(), clips.ravel())
    t = one_sample_t(alike.ravel(), 0)
    assert (fit.participant_sd, fit.stimulus_sd) == (0, 0)
    assert (fit.t, fit.df, fit.p) == pytest.approx((t.t, t.df, t.p), rel=1e-4)


@pytest.mark.parametrize(
    ("chosen", "x", "reason"),
    [
        ([], [], "undefined: one condition only"),
        ([1, 0], [1, 1], "undefined: one condition only"),
        ([1, 1, 0, 1], [1, 1, 0, 0], "undefined: complete separation in a condition"),
        ([1, 0, 1, 0] * 3, [1, 1, 0, 0] * 3, None),
    ],
)
def test_a_logistic_mixed_model_without_a_maximum_says_so(
    chosen: list[int], x: list[int], reason: str | None
) -> None:
    fit = logistic_mixed(chosen, x, [i % 4 for i in range(len(chosen))])
    assert fit.reason == reason or (reason is None and fit.reason and fit.effect is None)


# a Latin square of four clips, twice; ratings by participant and clip
PLACES = np.argsort([[0, 1, 3, 2], [1, 2, 0, 3], [2, 3, 1, 0], [3, 0, 2, 1]] * 2, axis=1) + 1
SCORES = np.array([[4, 2, 5, 3], [3, 3, 4, 2], [5, 1, 4, 4], [2, 2, 3, 3], [4, 3, 5, 1], [3, 2, 4, 2],
                   [5, 3, 3, 4], [4, 1, 5, 2]])  # fmt: skip


def test_order_effects_agree_with_r() -> None:
    # R: summary(lm(y ~ factor(p) + factor(s) + t))$coefficients["t", ]
    place = position_effect(SCORES, PLACES)
    assert (place.estimate, place.se) == pytest.approx((0.0125, 0.1587057024810388), rel=1e-9)
    assert (place.t, place.df, place.p) == (
        pytest.approx(0.07876213522632, rel=1e-9), 20, pytest.approx(0.93800453926, rel=1e-9)
    )  # fmt: skip
    # R: anova(lm(y ~ factor(p) + factor(s) + t), lm(y ~ … + factor(previous))) without first answers
    before = carry_over(SCORES, PLACES)
    assert before.df == (3, 9)
    assert (before.f, before.p) == pytest.approx((0.5571428571428594, 0.6563670840186), rel=1e-9)


def test_a_part_in_one_fixed_order_cannot_tell_place_from_clip() -> None:
    found = position_effect(SCORES, np.tile([1, 2, 3, 4], (8, 1)))
    assert found.reason == "undefined: places and stimuli go together"
    assert carry_over(SCORES, np.tile([1, 2, 3, 4], (8, 1))).p is None


@given(st.floats(-4, 20), st.floats(1, 80), st.floats(-4, 4))
def test_the_noncentral_density_is_scipys(t: float, df: float, away: float) -> None:
    found = log_density(t, df, np.array([t + away]))[0]
    assert found == pytest.approx(nct.logpdf(t, df, t + away), abs=1e-6)


def test_equivalence_agrees_with_r() -> None:
    # R: t.test(x, mu = 3.2, alternative = "greater"); t.test(x, mu = 4.4, alternative = "less")
    result = equivalence(X, (3.2, 4.4))
    assert result.above_lower.p == pytest.approx(0.000808057621450246, rel=1e-11)
    assert result.below_upper.p == pytest.approx(0.000671589784707497, rel=1e-11)
    assert result.p == result.above_lower.p


def test_bayes_factors_agree_with_r() -> None:
    # R: BayesFactor::ttestBF(x, mu = 3); (…, nullInterval = c(0, Inf)); ttestBF(x, w)
    assert jzs_bayes_factor(one_sample_t(X, 3)).bf10 == pytest.approx(395.181390307343, rel=1e-6)
    assert jzs_bayes_factor(one_sample_t(X, 3, "greater")).bf10 == pytest.approx(
        790.322594632705545, rel=1e-6
    )
    assert jzs_bayes_factor(one_sample_t(X, 3, "less")).bf10 == pytest.approx(0.040184940748826, rel=1e-5)
    assert jzs_bayes_factor(student_t(X, W)).bf10 == pytest.approx(215.136904328656, rel=1e-6)
    assert jzs_bayes_factor(one_sample_t([5, 5], 3)).reason == "undefined: zero variance, every value is 5"


def test_the_bootstrap_interval_shrinks_with_n_and_holds_the_mean() -> None:
    rng = np.random.default_rng(1)
    small, large = bootstrap_mean(X, rng), bootstrap_mean(np.tile(X, 100), rng)
    assert small[0] < np.mean(X) < small[1]
    assert (large[1] - large[0]) == pytest.approx((small[1] - small[0]) / 10, rel=0.1)
    assert bootstrap_mean([4, 4, 4], rng) is None


@given(st.lists(st.tuples(*[st.integers(1, 5)] * 3), min_size=1, max_size=5))
def test_label_permutation_counts_every_way_to_name_the_target(rows: list[tuple[int, int, int]]) -> None:
    observed = sum(row[0] for row in rows)
    share = np.mean([sum(ways) >= observed for ways in product(*rows)])
    assert label_permutation(rows, target=0).p == pytest.approx(share)


def test_a_logistic_mixed_model_that_nobody_contradicts_is_unbounded() -> None:
    fit = logistic_mixed([1, 0, 1, 0, 1, 1, 0, 0], [1, 0] * 4, [1, 1, 2, 2, 3, 3, 4, 4])
    assert fit.reason == "undefined: whoever answers differently does so in one direction"


def test_without_differences_among_participants_the_error_is_that_of_a_plain_logistic_model() -> None:
    # 30 and 13 of 36 yes, as paired as chance would have it or less: the SD of participants is 0
    high, low = np.repeat([1, 0], [30, 6]), np.resize([1, 0, 0], 36)
    rows = np.concatenate([high, low]), np.repeat([1, 0], 36), np.tile(np.arange(36), 2)
    fit = logistic_mixed(*rows)
    assert fit.participant_sd is not None and fit.participant_sd < 0.05
    yes = low.sum()
    assert fit.se == pytest.approx(np.sqrt(1 / 30 + 1 / 6 + 1 / yes + 1 / (36 - yes)), rel=1e-3)
    ordinal = cumulative_link_mixed(*rows)
    assert (ordinal.effect, ordinal.se) == pytest.approx((fit.effect, fit.se), rel=1e-3)


def test_ratings_that_the_condition_decides_have_no_model() -> None:
    target = np.tile([1, 0], 8)
    fit = cumulative_link_mixed(3 + target, target, np.repeat(np.arange(8), 2))
    assert fit.reason == "undefined: the conditions or the participants separate the ratings"


def test_the_ratings_model_of_two_ratings_is_the_choices_model() -> None:
    # of so many answers each that Laplace's approximation is close to the quadrature
    rng = np.random.default_rng(3)
    x, people = np.tile([1, 0], 400), np.repeat(np.arange(20), 40)
    chosen = rng.random(800) < 1 / (1 + np.exp(-(x - 0.5 + 2 * rng.normal(size=20)[people])))
    ordinal, choices = (model(chosen, x, people) for model in (cumulative_link_mixed, logistic_mixed))
    assert (ordinal.effect, ordinal.se) == pytest.approx((choices.effect, choices.se), rel=1e-2)
    assert ordinal.participant_sd == pytest.approx(choices.participant_sd, rel=2e-2)


def test_participants_who_differ_widely_are_integrated_out_exactly() -> None:
    # 10 say yes twice, 10 no twice, 3 change one way and 2 the other: Newton's steps could circle a mode
    pairs = np.repeat([[1, 1], [0, 0], [1, 0], [0, 1]], [10, 10, 3, 2], axis=0)
    fit = logistic_mixed(pairs.ravel(), np.tile([1, 0], 25), np.repeat(np.arange(25), 2))
    assert fit.participant_sd is not None and fit.participant_sd > 3
    u = np.linspace(-9, 9, 20_001)
    logits = fit.intercept + fit.effect * np.array([[1], [0]]) + fit.participant_sd * u
    yes = 1 / (1 + np.exp(-logits))
    joint = np.where(pairs[..., None], yes, 1 - yes).prod(axis=1) * np.exp(-(u**2) / 2) / np.sqrt(2 * np.pi)
    assert fit.log_likelihood == pytest.approx(np.log(np.trapezoid(joint, u)).sum(), abs=1e-2)
