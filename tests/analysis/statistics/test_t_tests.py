"""t-tests against R 4.2.2 (stats, effectsize 0.8.3), and the laws they obey."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.special import nctdtr

from analysis.statistics.noncentral_t import ncp_interval
from analysis.statistics.one_sample_t import one_sample_t
from analysis.statistics.paired_t import d_av, paired_t
from analysis.statistics.student_t import student_t
from analysis.statistics.welch_t import welch_t

X = [4, 5, 3, 4, 2, 5, 4, 4, 3, 5, 4, 1, 4, 5, 3, 4, 4, 2, 5, 4, 3, 4, 5, 4, 4, 3, 5, 2, 4, 4, 3, 5, 4, 4]
Y = [3, 4, 3, 2, 2, 4, 5, 3, 3, 3, 4, 1, 2, 5, 3, 3, 4, 1, 4, 4, 2, 3, 5, 3, 4, 2, 4, 2, 3, 4, 3, 4, 3, 5]
Z = [1, 2, 2, 1, 3, 1, 2]
ratings = st.lists(st.integers(1, 5), min_size=3, max_size=40).filter(lambda values: len(set(values)) > 1)


def choices(k: int, n: int = 34) -> np.ndarray:
    return np.repeat([1.0, 0.0], [k, n - k])


def test_one_sample_t_agrees_with_r() -> None:
    # R: t.test(x, mu = 3, alternative = "greater"); t.test(x, mu = 3)
    result = one_sample_t(X, null=3, alternative="greater")
    assert result.t == pytest.approx(4.5917465873209427, rel=1e-12)
    assert result.df == 33
    assert result.p == pytest.approx(3.0552062625687854e-05, rel=1e-12)
    assert result.ci95 == pytest.approx((3.4422592702536043, 4.1459760238640424), rel=1e-12)
    assert one_sample_t(X, null=3).p == pytest.approx(6.1104125251375708e-05, rel=1e-12)
    assert one_sample_t(X, null=3, alternative="less").p == pytest.approx(0.99996944793737430, rel=1e-12)
    # R: effectsize::cohens_d(x, mu = 3), hedges_g(x, mu = 3)
    assert result.d == pytest.approx(0.78747804305848523, rel=1e-12)
    assert result.g == pytest.approx(0.76942111178626238, rel=1e-12)
    assert result.g_ci95 == pytest.approx((0.38806995428787022, 1.14186073770835694), abs=1e-6)
    # R: uniroot(function(n) pt(t, 33, n) - p, …, tol = 1e-13)$root / sqrt(34)
    assert result.d_ci95 == pytest.approx((0.3971772656716861, 1.1686579804030723), abs=1e-9)


def test_student_t_agrees_with_r() -> None:
    # R: t.test(x, z, var.equal = TRUE); effectsize::cohens_d(x, z); hedges_g(x, z)
    result = student_t(X, Z)
    assert (result.t, result.df) == (pytest.approx(5.1455312860569773, rel=1e-12), 39)
    assert result.p == pytest.approx(7.9045470305673274e-06, rel=1e-12)
    assert result.ci95 == pytest.approx((1.2622570446323764, 2.8974068209138415), rel=1e-12)
    assert result.d == pytest.approx(2.13566766846232081, rel=1e-12)
    assert result.d_ci95 == pytest.approx((1.18464070530217658, 3.06603429244329995), abs=1e-6)
    assert result.g == pytest.approx(2.09428748146007671, rel=1e-12)
    assert result.g_ci95 == pytest.approx((1.16168738974668595, 3.00662754379502095), abs=1e-6)


def test_welch_t_agrees_with_r() -> None:
    # R: t.test(x, z); effectsize::cohens_d(x, z, pooled_sd = FALSE); hedges_g(x, z, pooled_sd = FALSE)
    result = welch_t(X, Z)
    assert result.t == pytest.approx(6.2274191486522872, rel=1e-12)
    assert result.df == pytest.approx(10.935305563771630, rel=1e-12)
    assert result.p == pytest.approx(6.6312665068280868e-05, rel=1e-12)
    assert result.ci95 == pytest.approx((1.3442165107673816, 2.8154473547788368), rel=1e-12)
    assert result.d == pytest.approx(2.33382566271426661, rel=1e-12)
    assert result.g == pytest.approx(2.16937053381164002, rel=1e-12)


def test_paired_t_agrees_with_r() -> None:
    # R: t.test(x, y, paired = TRUE); effectsize::cohens_d(x, y, paired = TRUE); hedges_g(x, y, paired = TRUE)
    result = paired_t(X, Y)
    assert (result.t, result.df) == (pytest.approx(4.3658676113689019, rel=1e-12), 33)
    assert result.p == pytest.approx(1.1781818990561459e-04, rel=1e-12)
    assert result.ci95 == pytest.approx((0.29840907795147786, 0.81923798087205169), rel=1e-12)
    assert result.d == pytest.approx(0.74874011826927134, rel=1e-12)
    assert result.d_ci95 == pytest.approx((0.36304547849440766, 1.12556643312184268), abs=1e-6)
    assert result.g == pytest.approx(0.73157145055145900, rel=1e-12)


# R: h <- rep(1:0, c(k1, 34 - k1)); l <- …; t.test(h, l, var.equal = TRUE, alternative = "greater") and Welch;
#    d from uniroot on pt(t, 66, ncp); columns: t, p, Welch df, Welch p, d, its interval, g, its interval
PUBLISHED = {
    (32, 0): (22.978250586152114, 1.6759911986305617e-33, 33.0, 3.5346664887553836e-22,
              5.5730443681538873, 4.5070986698189008, 6.6291076206776207, 5.5094330966015503,
              4.4556542063516202, 6.5534423402398341),
    (27, 9): (5.0819373231595186, 1.6480358696971692e-06, 65.504690431519677, 1.6700128259662814e-06,
              1.2325508450679628, 0.70899385206925791, 1.7482423144622270, 1.2184823896011974,
              0.70090132714506559, 1.7282877063058628),
    (32, 1): (18.081430925949885, 1.4467511274943696e-27, 59.883702989392475, 3.0671194746898305e-26,
              4.3853911511765364, 3.4951290083398012, 5.2650864591483693, 4.3353358691883344,
              3.4552352652125413, 5.2049902491821882),
    (19, 10): (2.256419413900831561, 0.013681101791085880, 65.518638573743913867, 0.013693503906276388,
               0.547262092894554297, 0.060858646484500872, 1.029674023497427982, 0.541015590031533433,
               0.060163999962403354, 1.017921223843909484),
}  # fmt: skip


@pytest.mark.parametrize("counts", PUBLISHED)
def test_the_published_counts_agree_with_r(counts: tuple[int, int]) -> None:
    t, p, welch_df, welch_p, d, d_low, d_high, g, g_low, g_high = PUBLISHED[counts]
    high, low = choices(counts[0]), choices(counts[1])
    student, welch = student_t(high, low, "greater"), welch_t(high, low, "greater")
    assert (student.t, student.p, student.df) == (
        pytest.approx(t, rel=1e-12),
        pytest.approx(p, rel=1e-11),
        66,
    )
    assert (welch.df, welch.p) == (pytest.approx(welch_df, rel=1e-12), pytest.approx(welch_p, rel=1e-11))
    assert student.d == pytest.approx(d, rel=1e-12)
    assert student.d_ci95 == pytest.approx((d_low, d_high), abs=1e-6)
    assert student.g == pytest.approx(g, rel=1e-12)
    assert student.g_ci95 == pytest.approx((g_low, g_high), abs=1e-6)


@pytest.mark.parametrize("counts", PUBLISHED)
def test_both_hypotheses_on_intensity_are_one_test(counts: tuple[int, int]) -> None:
    high, low = choices(counts[0]), choices(counts[1])
    higher, lower = student_t(high, low, "greater"), student_t(1 - low, 1 - high, "greater")
    assert (lower.t, lower.p) == pytest.approx((higher.t, higher.p), rel=1e-13)


def test_complete_separation_is_undefined_not_infinite() -> None:
    for result in (student_t(choices(34), choices(0)), welch_t(choices(34), choices(0))):
        assert result.reason == "undefined: zero variance in both groups"
        assert (result.t, result.p, result.d, result.ci95) == (None, None, None, None)
        assert result.estimate == 1.0
    assert student_t(choices(34), choices(0)).df == 66
    paired = paired_t(choices(34), choices(0))
    assert paired.reason == "undefined: zero variance of the differences, every difference is 1"


def test_one_constant_group_is_no_obstacle() -> None:
    assert welch_t(choices(32), choices(0)).df == pytest.approx(33)


@pytest.mark.parametrize(
    ("values", "reason"),
    [
        ([], "undefined: n = 0, a t-test needs 2 values"),
        ([np.nan, 4], "undefined: n = 1, a t-test needs 2 values"),
        ([5, 5, 5], "undefined: zero variance, every value is 5"),
        ([0.1] * 10, "undefined: zero variance, every value is 0.1"),
    ],
)
def test_degenerate_samples_say_why(values: list[float], reason: str) -> None:
    result = one_sample_t(values, null=3)
    assert (result.t, result.p, result.reason) == (None, None, reason)


@given(ratings, st.integers(1, 5))
def test_one_sided_probabilities_are_complements_and_missing_values_change_nothing(
    values: list[int], null: int
) -> None:
    greater = one_sample_t([*values, np.nan], null=null, alternative="greater")
    less = one_sample_t(values, null=null, alternative="less")
    assert greater.p is not None and less.p is not None
    assert greater.p + less.p == pytest.approx(1)


@given(ratings, ratings)
def test_the_interval_of_d_holds_d_and_excludes_zero_exactly_when_p_is_small(
    first: list[int], second: list[int]
) -> None:
    result = student_t(first, second)
    assert result.d is not None and result.d_ci95 is not None and result.p is not None
    low, high = result.d_ci95
    assert low <= result.d <= high
    if abs(result.p - 0.05) > 1e-6:
        assert (result.p < 0.05) == (low > 0 or high < 0)


@given(ratings)
def test_a_paired_test_does_not_care_about_the_order_of_participants(values: list[int]) -> None:
    others = [6 - value for value in values]
    forwards, backwards = paired_t(values, others), paired_t(values[::-1], others[::-1])
    assert forwards.t == pytest.approx(backwards.t) or forwards.reason == backwards.reason


def test_d_av_is_the_difference_in_root_mean_square_deviations() -> None:
    sd = np.sqrt((np.var(X, ddof=1) + np.var(Y, ddof=1)) / 2)
    assert d_av(X, Y) == pytest.approx((np.mean(X) - np.mean(Y)) / sd)
    assert d_av([1, 1], [0, 0]) is None


@pytest.mark.parametrize("df", [1, 2, 5, 33, 5000])
@pytest.mark.parametrize("t", [0, 1, 20, 300, 2e4, 1e9])
def test_every_t_has_an_interval_of_its_noncentrality(t: float, df: int) -> None:
    limits = ncp_interval(t, df)
    assert limits is not None and limits[0] < t < limits[1]
    if t < 1000:
        assert [float(nctdtr(df, limit, t)) for limit in limits] == pytest.approx([0.975, 0.025], abs=1e-9)
    mirrored = ncp_interval(-t, df)
    assert mirrored is not None and mirrored == pytest.approx((-limits[1], -limits[0]), abs=1e-9)


def test_the_interval_of_a_large_effect_in_few_participants_agrees_with_r() -> None:
    # R: f <- function(p, l, h) uniroot(function(n) pt(20, 5, n) - p, c(l, h), tol = 1e-12)$root
    #    c(f(.975, 5, 20), f(.025, 20, 36))
    assert ncp_interval(20, 5) == pytest.approx((7.9619655544, 32.177843773), rel=1e-8)


def test_differences_equal_but_for_rounding_have_no_variance() -> None:
    # R: t.test(c(.6, .4, .8), c(.4, .2, .6), paired = TRUE) stops: data are essentially constant
    found = paired_t([0.6, 0.4, 0.8], [0.4, 0.2, 0.6])
    assert (found.t, found.d, found.reason) == (
        None,
        None,
        "undefined: zero variance of the differences, every difference is 0.2",
    )
