from __future__ import annotations

from decimal import Decimal
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from analysis.apa import share, t_sentence
from analysis.published import HIGHER, TABLE_II, N, counts_behind, verify
from analysis.statcheck import check_file, check_text
from analysis.statistics.student_t import student_t
from analysis.statistics.t_test import Alternative
from stimuli.errors import InputError
from tests.analysis.statistics.test_t_tests import choices, ratings


@pytest.fixture
def table_ii(tmp_path: Path) -> Path:
    path = tmp_path / "table.csv"
    path.write_text(TABLE_II, encoding="utf-8")
    return path


def test_the_only_misprint_of_the_published_table_is_found(table_ii: Path) -> None:
    found = verify(table_ii, n=N)
    assert [str(fault) for fault in found.faults] == [
        "line 3, arc/low: shares add up to 2.00, and no counts of 34 give them"
    ]
    assert found.cells == 24
    assert {one.name: (one.counts[0][0], one.counts[1][0]) for one in found.recomputed} == {
        name: (counts["high"], counts["low"]) for name, counts in HIGHER.items() if name != "arc"
    }
    follow = found.recomputed[-1]
    assert follow.student.p == pytest.approx(0.013681101791085880)


def test_no_other_number_of_participants_below_62_gives_the_published_table(table_ii: Path) -> None:
    assert verify(table_ii, n=N).other_sizes == (62, 66, 68)


@pytest.mark.parametrize(
    ("rows", "n", "fault"),
    [
        ("a,0.80,0.20\n", 34, "0.80 is no share of 34 answers"),
        ("a,1.5,-0.5\n", 10, "shares lie between 0 and 1"),
        ("a,0.3,0.3\n", 10, "shares add up to 0.6"),
    ],
)
def test_impossible_shares_are_named(tmp_path: Path, rows: str, n: int, fault: str) -> None:
    path = tmp_path / "t.csv"
    path.write_text("clip,yes,no\n" + rows, encoding="utf-8")
    assert any(fault in str(one) for one in verify(path, n=n).faults)


def test_means_of_ratings_are_checked_too(tmp_path: Path) -> None:
    path = tmp_path / "t.csv"
    path.write_text("emotion,mean,sd\njoy,3.88,1.07\nfear,3.87,1.01\n", encoding="utf-8")
    assert [fault.line for fault in verify(path, n=34).faults] == [3]
    assert verify(path, n=34, items=50).faults == ()


def test_a_table_without_numbers_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "t.csv"
    path.write_text("a,b\nx,y\n", encoding="utf-8")
    with pytest.raises(InputError, match="no column holds numbers only"):
        verify(path, n=34)


@given(st.integers(1, 120), st.integers(0, 120))
def test_what_we_print_of_a_count_leads_back_to_the_count(n: int, k: int) -> None:
    k = min(k, n)
    assert k in counts_behind(Decimal(share(k, n)), n)


@given(ratings, ratings, st.sampled_from(["greater", "less", "two-sided"]))
def test_our_sentences_pass_the_check(first: list[int], second: list[int], alternative: Alternative) -> None:
    sentence = t_sentence(student_t(first, second, alternative), None, 0.05)
    (checked,) = check_text(f"We found: {sentence}.")
    assert checked.consistent and not checked.decision_error


@pytest.mark.parametrize(
    ("sentence", "consistent", "decision_error"),
    [
        ("t(33) = 4.82, p < .001", True, False),
        ("t(66) = 2.26, p = .014, one-sided", True, False),
        ("t(66) = 2.26, p = .014", False, False),
        ("t(66) = 1.70, p = .047, one-tailed", True, False),
        ("t(66) = 1.20, p = .01", False, True),
        ("F(2, 30) = 3.32, p = .050", True, False),
        ("r(40) = .31, p = .046", True, False),
        ("χ2(1, N = 90) = 3.84, p = .05", True, False),
        ("z = 1.96, p = .05", True, False),
        ("t(10) = 9.99, p = .000", False, False),
    ],
)
def test_reported_tests_are_recomputed(sentence: str, consistent: bool, decision_error: bool) -> None:
    (checked,) = check_text(f"First.\nThe effect was clear, {sentence}. Nothing else.")
    assert (checked.consistent, checked.decision_error, checked.line) == (consistent, decision_error, 2)


def test_an_undefined_test_makes_no_claim_to_check() -> None:
    sentence = t_sentence(student_t(choices(34), choices(0)), None, 0.05)
    assert sentence == "t undefined: zero variance in both groups, df = 66, n = 34, n = 34"
    assert check_text(sentence) == []


def test_a_verification_reads_as_sentences(table_ii: Path) -> None:
    said = str(verify(table_ii, n=N))
    assert "line 3, arc/low: shares add up to 2.00" in said
    assert "follow: 19 against 10 of 34; t(66) = 2.26, p = .014, one-sided" in said
    assert check_text(said) and all(one.consistent for one in check_text(said))


def test_a_paper_is_read_line_by_line(tmp_path: Path) -> None:
    paper = tmp_path / "paper.md"
    paper.write_text(
        "It held, t(66) = 2.26, p = .014, one-sided.\nSo did t(66) = 1.20, p = .01.\n", encoding="utf-8"
    )
    found = check_file(paper)
    assert [one.line for one in found.faults] == [2]
    assert str(found).splitlines()[0] == "2 reported tests recomputed, 1 inconsistent."
    assert "the decision changes" in str(found)
    with pytest.raises(InputError, match="cannot be read"):
        check_file(tmp_path / "none.md")
