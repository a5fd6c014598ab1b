"""Two levels or modulations compared: which test decides, and in which direction."""

from __future__ import annotations

import numpy as np
import pytest

from analysis.answers import Answers, Codes
from analysis.levels import Comparison, comparisons
from analysis.plan import Levels
from analysis.statistics.t_test import Alternative
from analysis.target import Judging
from analysis.words import assumptions


def levels(
    codes: Codes, test: str, alternative: Alternative, options: tuple[str, ...], outcome: str | None = None
) -> Levels:
    """The first clip against the second, (participants, 2)."""
    people = tuple(map(str, range(len(codes))))
    answers = Answers("part", people, ("one", "two"), ("item",), options, codes[:, :, None].astype(np.int8))
    comparison = Comparison(("one", "two"), {"pair": ("one", "two")}, "item", outcome)
    judging = Judging(test, alternative, "none", 0.05)
    found = comparisons(answers, comparison, judging)
    return Levels("H1", "part", None, "part", answers, judging, comparison, found)


@pytest.mark.parametrize(
    ("alternative", "p"),
    [("greater", 1 - 1 / 1024), ("less", 11 / 1024), ("two-sided", 22 / 1024)],  # R: binom.test(1, 10, .5)
)
def test_mcnemars_test_decides_in_the_declared_direction(alternative: Alternative, p: float) -> None:
    codes = np.array([[1, 0]] * 1 + [[0, 1]] * 9 + [[1, 1]] * 3)
    found = levels(codes, "mcnemar", alternative, ("no", "yes"), "yes").results["pair"]
    assert (found.verdict.test, found.verdict.p) == ("McNemar's exact", pytest.approx(p))


@pytest.mark.parametrize(("alternative", "p"), [("greater", 1 / 70), ("less", 1.0), ("two-sided", 2 / 70)])
def test_two_groups_without_variance_are_decided_by_their_permutations(
    alternative: Alternative, p: float
) -> None:
    """Of the 70 ways to deal eight answers to two groups of four, one sets all the higher in the first."""
    codes = np.array([[4, -1]] * 4 + [[-1, 1]] * 4)
    found = levels(codes, "independent t", alternative, tuple("12345")).results["pair"]
    assert (found.verdict.test, found.verdict.p) == ("Fisher's exact", pytest.approx(p))
    assert found.deciding_t.reason == "undefined: zero variance in both groups"


def test_a_p_that_is_alpha_is_not_below_it_for_rounding() -> None:
    """R: fisher.test(matrix(c(3, 0, 0, 3), 2), alternative = "greater") is 1 of 20 tables, and not < 0.05."""
    codes = np.array([[4, -1]] * 3 + [[-1, 1]] * 3)
    found = levels(codes, "independent t", "greater", tuple("12345")).results["pair"]
    assert (found.verdict.p, found.verdict.significant) == (pytest.approx(1 / 20), False)


def test_a_test_that_is_undefined_confirms_nothing() -> None:
    codes = np.array([[4, -1]] * 4 + [[-1, 1]] * 4)
    found = levels(codes, "independent t", "greater", tuple("12345"))
    assert "equal variances (Welch's t: undefined)" in assumptions(found)
    choices = np.array([[1, 0]] * 8)
    assert assumptions(levels(choices, "mcnemar", "greater", ("no", "yes"), "yes")) == ""


@pytest.mark.parametrize(
    ("alternative", "p"), [("greater", 7 / 64), ("less", 7 / 64), ("two-sided", 14 / 64)]
)
def test_whether_most_chose_a_levels_own_answer_is_asked_upwards_or_of_both_sides(
    alternative: Alternative, p: float
) -> None:
    codes = np.array([[1, 0]] * 5 + [[0, 1]])
    choices = levels(codes, "mcnemar", alternative, ("no", "yes"), "yes").results["pair"].choices
    assert choices is not None
    assert [test.p for test in choices.binomial.values()] == pytest.approx([p, p])  # R: binom.test(5, 6)
