"""Counts and proportions against R 4.2.2."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from analysis.statistics.binomial import binomial
from analysis.statistics.clopper_pearson import clopper_pearson
from analysis.statistics.fisher import fisher
from analysis.statistics.mcnemar import mcnemar, mcnemar_counts
from analysis.statistics.newcombe import newcombe, paired_difference
from analysis.statistics.t_test import Alternative
from analysis.statistics.wilson import wilson

EXACT = 1e-12


@pytest.mark.parametrize(
    ("k", "null", "alternative", "p"),
    [  # R: binom.test(k, 34, null, alternative)$p.value
        (19, 1 / 2, "greater", 0.30379568063653994),
        (19, 1 / 2, "less", 0.80423584743402909),
        (19, 1 / 2, "two-sided", 0.60759136127307989),
        (9, 1 / 6, "greater", 0.10047301442168148),
        (9, 1 / 6, "less", 0.95408561950475024),
        (9, 1 / 6, "two-sided", 0.16190851782087318),
    ],
)
def test_binomial_agrees_with_r(k: int, null: float, alternative: Alternative, p: float) -> None:
    assert binomial(k, 34, null, alternative).p == pytest.approx(p, rel=1e-11)


def test_intervals_of_a_proportion_agree_with_r() -> None:
    # R: binom.test(27, 34)$conf.int; prop.test(27, 34, correct = FALSE)$conf.int; and of 34, 0
    assert clopper_pearson(27, 34) == pytest.approx((0.62102225146031675, 0.91297869454187297), rel=EXACT)
    assert clopper_pearson(34, 34) == (pytest.approx(0.89718207574098741, rel=EXACT), 1.0)
    assert clopper_pearson(0, 34) == (0.0, pytest.approx(0.10281792425901259, rel=EXACT))
    assert wilson(27, 34) == pytest.approx((0.63201611948836400, 0.89650473100968076), rel=EXACT)
    assert wilson(34, 34) == (pytest.approx(0.89848544584667633, rel=EXACT), 1.0)


@pytest.mark.parametrize(
    ("table", "alternative", "p"),
    [  # R: fisher.test(matrix(c(k1, n1 - k1, k2, n2 - k2), 2), alternative = …)$p.value
        ((19, 34, 10, 34), "greater", 0.024478441856301693),
        ((19, 34, 10, 34), "less", 0.99321988717001375),
        ((19, 34, 10, 34), "two-sided", 0.048956883712603393),
        ((3, 7, 9, 12), "two-sided", 0.32608954512979266),
        ((34, 34, 0, 34), "greater", 3.5145627607867045e-20),
        ((32, 34, 0, 34), "greater", 2.2141745392956110e-17),
        ((27, 34, 9, 34), "greater", 1.2162051867403831e-05),
        ((32, 34, 1, 34), "greater", 6.9131449504673958e-16),
    ],
)
def test_fisher_agrees_with_r(table: tuple[int, int, int, int], alternative: Alternative, p: float) -> None:
    assert fisher(*table, alternative).p == pytest.approx(p, rel=1e-11)


def test_newcombe_combines_two_wilson_intervals() -> None:
    # R: i <- prop.test(k1, 34, correct = FALSE)$conf.int; j <- …; d - sqrt((p1-i[1])^2 + (j[2]-p2)^2), …
    follow, time = newcombe(19, 34, 10, 34), newcombe(34, 34, 0, 34)
    assert follow.ci95 == pytest.approx((0.03003675315, 0.46225690819), abs=1e-10)
    assert time.ci95 == (pytest.approx(0.8564367407, abs=1e-10), 1.0)


def test_mcnemar_agrees_with_r() -> None:
    # R: binom.test(14, 19, .5, "greater"); binom.test(14, 19);
    #    2 * (pbinom(5, 19, .5) - .5 * dbinom(5, 19, .5));
    #    b <- binom.test(14, 19)$conf.int; b / (1 - b)
    result = mcnemar_counts(14, 5, both=5, neither=10)
    assert result.p_one_sided == pytest.approx(0.031784057617187493, rel=EXACT)
    assert result.p_two_sided == pytest.approx(0.063568115234374986, rel=EXACT)
    assert result.p_mid == pytest.approx(0.041389465332031236, rel=EXACT)
    assert result.odds_ratio_ci95 == pytest.approx((0.95301306280503484, 9.93305000344649436), rel=1e-11)


def test_mcnemar_pairs_participants_and_leaves_out_the_incomplete() -> None:
    result = mcnemar([1, 1, 0, 1, np.nan, 0], [0, 1, 1, np.nan, 0, 0])
    assert (result.n, result.b, result.c, result.both, result.neither) == (4, 1, 1, 1, 1)


def test_every_pair_discordant_the_same_way_has_an_exact_p_and_an_unbounded_ratio() -> None:
    result = mcnemar(np.ones(34), np.zeros(34))
    assert result.p_one_sided == pytest.approx(2.0**-34)
    assert (result.odds_ratio, result.odds_ratio_ci95[1]) == (None, None)
    assert result.reason == "odds ratio unbounded: no pair in the other direction"


def test_no_answers_are_undefined() -> None:
    assert binomial(0, 0).reason == "undefined: no answers"
    assert fisher(0, 0, 1, 2).reason == "undefined: a group without answers"
    assert newcombe(0, 0, 1, 2).reason == "undefined: a group without answers"
    assert mcnemar([], []).reason == "undefined: no complete pairs"


@given(st.integers(1, 60), st.integers(0, 60))
def test_intervals_mirror_when_yes_and_no_are_swapped(n: int, k: int) -> None:
    k = min(k, n)
    for interval in (wilson, clopper_pearson):
        low, high = interval(k, n)
        assert interval(n - k, n) == pytest.approx((1 - high, 1 - low))
        assert low <= k / n <= high


@given(st.integers(0, 20), st.integers(0, 20), st.integers(0, 20), st.integers(1, 20))
def test_the_paired_difference_lies_in_its_interval(b: int, c: int, both: int, neither: int) -> None:
    difference = paired_difference(both, b, c, neither)
    low, high = difference.ci95
    assert -1 <= low <= difference.estimate <= high <= 1
