"""Models, equivalence and Bayes factors against R 4.2.2 (ordinal, geepack, BayesFactor)."""

from __future__ import annotations

import csv
from itertools import product
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from analysis.statistics.bayes_factor import jzs_bayes_factor
from analysis.statistics.bootstrap import bootstrap_mean
from analysis.statistics.cumulative_link_mixed import cumulative_link_mixed
from analysis.statistics.equivalence import equivalence
from analysis.statistics.gee_logistic import gee_logistic
from analysis.statistics.label_permutation import label_permutation
from analysis.statistics.one_sample_t import one_sample_t
from analysis.statistics.student_t import student_t
from tests.analysis.statistics.test_agreement import W
from tests.analysis.statistics.test_t_tests import X


@pytest.fixture(scope="module")
def ordinal() -> dict[str, np.ndarray]:
    with (Path(__file__).parent / "data" / "ordinal.csv").open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    return {name: np.array([int(row[name]) for row in rows]) for name in rows[0]}


def test_the_cumulative_link_mixed_model_agrees_with_r(ordinal: dict[str, np.ndarray]) -> None:
    # R: ordinal::clmm(factor(rating) ~ condition + (1 | participant), data = d)
    fit = cumulative_link_mixed(ordinal["rating"], ordinal["condition"], ordinal["participant"])
    assert fit.effect == pytest.approx(0.7365227414495072, abs=5e-3)
    assert fit.log_likelihood == pytest.approx(-358.1551625162096, abs=1e-3)
    assert fit.se == pytest.approx(0.244167304577707, abs=1e-3)
    assert fit.thresholds == pytest.approx((-1.3781252, -0.0483042, 0.8599363, 2.1205095), abs=1e-3)
    assert fit.participant_sd == pytest.approx(1.3278458786438521, abs=1e-3)


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
