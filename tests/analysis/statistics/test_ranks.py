"""Rank and sign-flip tests against R 4.2.2 (coin 1.4, exactRankTests 0.8)."""

from __future__ import annotations

from itertools import product

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from analysis.statistics.adjustment import ADJUSTMENTS, adjust
from analysis.statistics.sign_flip import sign_flip
from analysis.statistics.t_test import Alternative
from analysis.statistics.wilcoxon import middle_ranks, wilcoxon
from tests.analysis.statistics.test_t_tests import X, Y


@pytest.mark.parametrize(
    ("zeros", "alternative", "z", "p", "exact"),
    [  # R: coin::wilcoxsign_test(x ~ rep(3, 34), zero.method = …, alternative = …, distribution = …)
        ("pratt", "greater", 3.67118922980002349, 0.00012071225309551181, 0.00006033480167388916),
        ("pratt", "less", 3.67118922980002349, 0.99987928774690449, 0.99997215345501900),
        ("pratt", "two-sided", 3.67118922980002349, 0.00024142450619102362, 0.00012066960334777832),
        ("wilcoxon", "greater", 3.54060100108709319, 0.00019960840113864009, 0.00010110437870025635),
        ("wilcoxon", "two-sided", 3.54060100108709319, 0.00039921680227728018, 0.00020220875740051270),
    ],
)
def test_wilcoxon_agrees_with_r(
    zeros: str, alternative: Alternative, z: float, p: float, exact: float
) -> None:
    result = wilcoxon(X, null=3, alternative=alternative, zeros=zeros)  # type: ignore[arg-type]
    assert (result.z, result.p, result.p_exact) == pytest.approx((z, p, exact), rel=1e-11)


def test_sign_flip_agrees_with_r() -> None:
    # R: exactRankTests::perm.test(x, rep(3, 34), paired = TRUE, exact = TRUE, alternative = …)
    assert sign_flip(X, 3, "greater").p == pytest.approx(0.0001036524772644043, rel=1e-12)
    assert sign_flip(X, 3, "less").p == pytest.approx(0.99997470155358315, rel=1e-12)
    assert sign_flip(X, 3).p == pytest.approx(0.00020730495452880859, rel=1e-12)
    assert sign_flip(np.subtract(X, Y), 0, "greater").p == pytest.approx(0.00014972686767578125, rel=1e-12)


@given(st.lists(st.sampled_from([-1.5, -1, -0.5, 0, 0.5, 1, 2]), min_size=1, max_size=9))
def test_sign_flip_counts_the_assignments_of_signs(differences: list[float]) -> None:
    sums = [np.dot(signs, np.abs(differences)) for signs in product([-1, 1], repeat=len(differences))]
    share = np.mean(np.array(sums) >= np.sum(differences) - 1e-9)
    assert sign_flip(differences, 0, "greater").p == pytest.approx(share)


def test_large_samples_have_an_exact_probability_where_it_is_cheap() -> None:
    assert sign_flip([5] * 20_000, 3, "greater").p > 0
    assert sign_flip([4, 2, 5] * 1000, 3).reason == "not computed: exact only up to 500 values"


def test_constant_ratings_have_an_exact_probability_and_no_rank_test_at_the_null() -> None:
    assert sign_flip([5] * 34, 3, "greater").p == pytest.approx(2.0**-34)
    assert wilcoxon([3, 3, 3], null=3).reason == "undefined: every value is 3"
    assert wilcoxon([], null=3).reason == "undefined: no values"
    assert wilcoxon([5] * 10, null=3).rank_biserial == 1


def test_ties_share_the_middle_rank() -> None:
    assert middle_ranks(np.array([3.0, 1, 3, 2])).tolist() == [3.5, 1, 3.5, 2]


def test_adjustments_agree_with_r() -> None:
    # R: p.adjust(c(.01, .04, .03, .005, .5), "holm" | "BH" | "bonferroni", n = 5 | 7)
    p = {"a": 0.01, "b": 0.04, "c": 0.03, "d": 0.005, "e": 0.5}
    assert list(adjust(p, "holm").values()) == pytest.approx([0.04, 0.09, 0.09, 0.025, 0.5])
    assert list(adjust(p, "benjamini-hochberg").values()) == pytest.approx([0.025, 0.05, 0.05, 0.025, 0.5])
    assert list(adjust(p, "bonferroni").values()) == pytest.approx([0.05, 0.2, 0.15, 0.025, 1])
    larger = {**p, "undefined": None, "also": None}
    assert list(adjust(larger, "holm").values()) == [
        *map(pytest.approx, [0.06, 0.16, 0.15, 0.035, 1]),
        None,
        None,
    ]
    assert list(adjust(larger, "benjamini-hochberg").values())[:5] == pytest.approx(
        [0.035, 0.07, 0.07, 0.035, 0.7]
    )


@given(st.lists(st.floats(0, 1), min_size=1, max_size=8), st.sampled_from(sorted(ADJUSTMENTS)))
def test_adjusting_never_lowers_a_probability_nor_changes_their_order(
    p: list[float], correction: str
) -> None:
    adjusted = list(adjust({str(i): value for i, value in enumerate(p)}, correction).values())  # type: ignore[arg-type]
    assert all(after >= before * (1 - 1e-12) for before, after in zip(p, adjusted, strict=True))
    assert np.all(np.diff(np.array(adjusted)[np.argsort(p, kind="stable")]) >= -1e-12)


def test_rounding_breaks_no_tie_of_differences() -> None:
    first, second = np.array([3, 2, 4, 5, 1, 2]), np.array([2, 1, 3, 3, 2, 2])  # 0.6 − 0.4 is not 0.4 − 0.2
    assert wilcoxon(first / 5 - second / 5) == wilcoxon(first - second)
    assert wilcoxon([0.1 + 0.2, 0.3], 0.3).zeros == 2
