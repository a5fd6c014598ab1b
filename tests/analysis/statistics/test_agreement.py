"""Agreement, consistency and rank tests against R 4.2.2 (stats, psych 2.2) and worked examples."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from analysis.statistics.cronbach_alpha import cronbach_alpha
from analysis.statistics.friedman import friedman
from analysis.statistics.icc import icc
from analysis.statistics.krippendorff import Metric, krippendorff_alpha
from analysis.statistics.recognition_rate import confusion, unbiased_hit_rates
from tests.analysis.statistics.test_t_tests import X, Y

W = [2, 4, 2, 3, 1, 4, 3, 2, 3, 4, 2, 1, 3, 4, 2, 4, 3, 1, 3, 3, 2, 2, 4, 3, 3, 2, 5, 1, 2, 3, 2, 4, 3, 4]
THREE = np.column_stack([X, Y, W]).astype(float)
nan = np.nan


def test_friedman_agrees_with_r() -> None:
    # R: friedman.test(cbind(x, y, w))
    result = friedman(THREE)
    assert (result.chi2, result.df) == (pytest.approx(36.9333333333333, rel=1e-12), 2)
    assert result.p == pytest.approx(9.55055406683903e-09, rel=1e-11)
    assert result.kendall_w == pytest.approx(0.543137254901961, rel=1e-12)
    assert friedman([[3, 3], [2, 2]]).reason == "undefined: nobody rated conditions apart"
    assert friedman([[3, nan], [2, 2]]).reason == "undefined: 1 complete participants"


def test_cronbach_alpha_agrees_with_r() -> None:
    # R: psych::alpha(data.frame(x, y, w))$total$raw_alpha, $feldt
    result = cronbach_alpha(np.vstack([THREE, [nan, 3, 3]]))
    assert result.estimate == pytest.approx(0.904581392830066, rel=1e-12)
    assert result.ci95 == pytest.approx((0.831418115068699, 0.949153714038696), rel=1e-9)
    assert cronbach_alpha([[1, 5], [5, 1]]).reason == "undefined: the sums do not vary"


@pytest.mark.parametrize(
    ("kind", "estimate", "low", "high"),
    [  # R: psych::ICC(cbind(x, y, w), lmer = FALSE)
        ("ICC1", 0.587856413479, 0.399941245009, 0.747600084334),
        ("ICC2", 0.614162806089, 0.247345166392, 0.810764298495),
        ("ICC3", 0.759618008186, 0.621777327361, 0.861541357570),
        ("ICC1k", 0.810570778728, 0.666612260345, 0.898845824541),
        ("ICC2k", 0.826848826849, 0.496447647316, 0.927814748341),
        ("ICC3k", 0.904581392830, 0.831418115069, 0.949153714039),
    ],
)
def test_intraclass_correlations_agree_with_r(kind: str, estimate: float, low: float, high: float) -> None:
    result = icc(THREE)[kind]
    assert (result.estimate, *result.ci95) == pytest.approx((estimate, low, high), abs=1e-10)


@pytest.mark.parametrize(("metric", "alpha"), [("nominal", 0.743), ("ordinal", 0.815), ("interval", 0.849)])
def test_krippendorff_alpha_reproduces_his_worked_example(metric: Metric, alpha: float) -> None:
    # Krippendorff (2011), Computing Krippendorff's Alpha-Reliability, example C: four observers, twelve units
    observers = [
        [1, 2, 3, 3, 2, 1, 4, 1, 2, nan, nan, nan],
        [1, 2, 3, 3, 2, 2, 4, 1, 2, 5, nan, 3],
        [nan, 3, 3, 3, 2, 3, 4, 2, 2, 5, 1, nan],
        [1, 2, 3, 3, 2, 4, 4, 1, 2, 5, 1, nan],
    ]
    assert krippendorff_alpha(observers, metric) == pytest.approx(alpha, abs=5e-4)
    assert krippendorff_alpha([[3, 3], [3, 3]], metric) is None


@given(st.integers(2, 6), st.integers(2, 8))
def test_raters_who_say_the_same_agree_completely(raters: int, units: int) -> None:
    ratings = np.tile(np.arange(units) % 5, (raters, 1))
    assert krippendorff_alpha(ratings) == pytest.approx(1)


def test_ties_for_the_highest_are_shared_or_missed() -> None:
    ratings = np.array([[[5, 1, 1], [2, 4, 4]], [[3, 3, 3], [1, 5, 2]], [[nan, 1, 2], [1, 1, 3]]])
    assert confusion(ratings, "miss").tolist() == [[1, 0, 0], [0, 1, 1]]
    assert np.allclose(confusion(ratings, "share"), [[4 / 3, 1 / 3, 1 / 3], [0, 1.5, 1.5]])


def test_hu_is_one_for_perfect_recognition_and_low_for_a_favourite_answer() -> None:
    perfect = unbiased_hit_rates(np.eye(3) * 10, [0, 1, 2])
    assert [rate.hu for rate in perfect] == [1, 1, 1]
    favourite = unbiased_hit_rates([[10, 0, 0], [10, 0, 0], [10, 0, 0]], [0, 1, 2])
    assert (favourite[0].hit_rate, favourite[0].hu, favourite[1].hu) == (1, pytest.approx(1 / 3), None)
