from __future__ import annotations

from decimal import Decimal
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from analysis.apa import share
from analysis.grim import counts_behind, sd_is_possible
from analysis.published import HIGHER, TABLE_II, N, Verification, verify
from analysis.statcheck import check_text
from stimuli.errors import InputError


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


SHARES = """\
high,0.94,0.06,0.79,0.21,1.00,0.00,1.00,0.00,0.94,0.06,0.56,0.44
low,1.00,1.00,0.26,0.74,0.00,1.00,0.00,1.00,0.03,0.97,0.29,0.71
"""
NAMES = ("Arc", "Ant", "Time", "Exa", "Sec", "Follow")
MERGED = f",{',,'.join(NAMES)},\nI_M \\ I_P{',↑,↓' * 6}\n"  # as a person copies the printed table
REPEATED = f",{','.join(f'{name},{name}' for name in NAMES)}\nintended{',higher,lower' * 6}\n"
ONE_ROW = f"intended,{','.join(f'{name} ↑,{name} ↓' for name in NAMES)}\n"
UNDERSCORES = f"level,{','.join(f'P_{name}_higher,P_{name}_lower' for name in NAMES)}\n"


@pytest.mark.parametrize("header", [MERGED, REPEATED, ONE_ROW, UNDERSCORES])
def test_the_table_may_be_copied_as_it_is_printed(tmp_path: Path, table_ii: Path, header: str) -> None:
    found, long = check(tmp_path, header + SHARES, N), verify(table_ii, n=N)
    (fault,) = found.faults
    line = header.count("\n") + 2
    assert fault.line == line and fault.message == long.faults[0].message
    assert fault.row.removeprefix("P_") == "Arc/low"
    assert [one.student for one in found.recomputed] == [one.student for one in long.recomputed]
    assert found.other_sizes == long.other_sizes
    semicolons = (header + SHARES).replace(",", ";").replace("0.", "0,").replace("1.", "1,")
    assert check(tmp_path, semicolons, N).faults == found.faults


def test_no_other_number_of_participants_below_62_gives_the_published_table(table_ii: Path) -> None:
    assert verify(table_ii, n=N).other_sizes == (62, 66, 68)


def check(folder: Path, text: str, n: int, items: int = 1) -> Verification:
    path = folder / "t.csv"
    path.write_text(text, encoding="utf-8")
    return verify(path, n=n, items=items)


GOOD_ROWS = "b,0.3,0.7\nc,0.5,0.5\n"


@pytest.mark.parametrize(
    ("row", "n", "fault"),
    [
        ("a,0.80,0.20", 34, "line 4, a: 0.80 is no share of 34 answers"),
        ("a,1.5,-0.5", 10, "line 4, a: 1.5 is no share: they lie between 0 and 1"),
        ("a,0.3,0.3", 10, "line 4, a: shares add up to 0.6, and no counts of 10 give them"),
    ],
)
def test_impossible_shares_are_named(tmp_path: Path, row: str, n: int, fault: str) -> None:
    found = check(tmp_path, f"clip,yes,no\n{GOOD_ROWS}{row}\n", n)
    assert str(next(one for one in found.faults if one.line == 4)) == fault


@pytest.mark.parametrize(
    ("text", "n", "kind", "faults"),
    [
        ("clip,yes,no\na,27,7\nb,30,4\nc,30,5\n", 34, "counts", ["line 4, c: counts add up to 35, not 34"]),
        ("clip,yes,no\na,27,7\nb,35,-1\n", 34, "counts", ["line 3, b: 35 is no count among 34 answers"]),
        ("clip;yes;no\na;79%;21%\nb;80%;20%\n", 34, "percentages",
         ["line 3, b: 80% is no share of 34 answers", "line 3, b: 20% is no share of 34 answers"]),
        ("clip,yes,no\na,79,21\nb,94,6\n", 34, "percentages", []),
        ("clip;yes;no\na;0,79;0,21\nb;0,94;0,06\n", 34, "shares", []),
        ("clip,recognised\na,0.79\nb,0.94\n", 34, "shares", []),  # of several wholes
        ("no,clip,yes,no\n1,a,.79,.21\n2,b,.94,.06\n", 34, "shares", []),  # rows are numbered
        ("emotion,M,SD,n\njoy,3.88,1.07,34\nfear,3.87,1.01,34\n", 34, "means",
         ["line 3, fear: 3.87 is no mean of 34 answers"]),
    ],
)  # fmt: skip
def test_each_kind_of_table_is_checked_as_what_it_is(
    tmp_path: Path, text: str, n: int, kind: str, faults: list[str]
) -> None:
    found = check(tmp_path, text, n)
    assert found.kind == kind and f" printed {kind} checked" in str(found)
    assert [str(fault) for fault in found.faults] == faults


def test_counts_and_percentages_lead_to_the_tests_of_shares(tmp_path: Path) -> None:
    texts = ("27,7\na,low,9,25", "79%,21%\na,low,26%,74%", "0.79,0.21\na,low,0.26,0.74")
    found = [check(tmp_path, f"clip,level,up,down\na,high,{text}\n", 34).recomputed for text in texts]
    assert found[0] == found[1] == found[2] and found[0][0].counts == ((27, 7), (9, 25))


def test_means_are_of_as_many_answers_as_there_are_items(tmp_path: Path) -> None:
    text = "emotion,mean,sd\njoy,3.88,1.07\nfear,3.87,1.01\n"
    assert [fault.line for fault in check(tmp_path, text, 34).faults] == [3]
    found = check(tmp_path, text, 34, items=50)
    assert (
        found.faults == ()
        and found.unchecked == ()
        and found.spreads == 2
        and 35 in (found.other_sizes or ())
    )


# R: s <- sqrt((1.07^2 + .95^2) / 2); t <- (3.88 - 3.21) / (s * sqrt(2 / 34)); pt(t, 66, lower.tail = FALSE)
@pytest.mark.parametrize(
    "text",
    [
        "item,level,M,SD\njoy,high,3.88,1.07\njoy,low,3.21,0.95\n",
        "item,level,M,SD,n\njoy,high,3.88,1.07,34\njoy,low,3.21,0.95,34\n",
        "level,joy_M,joy_SD,fear_M,fear_SD\nhigh,3.88,1.07,3.88,1.07\nlow,3.21,0.95,3.21,0.95\n",
    ],
)
def test_means_with_standard_deviations_lead_to_their_t(tmp_path: Path, text: str) -> None:
    found = check(tmp_path, text, 34)
    assert found.kind == "means" and not found.faults
    student = found.recomputed[0].student
    assert student.t == pytest.approx(2.7303159851066439) and student.df == 66
    assert student.p == pytest.approx(0.0040526904064724098)
    assert "joy: t(66) = 2.73, p = .004, one-sided" in str(found)


def test_each_mean_is_of_the_participants_in_its_row(tmp_path: Path) -> None:
    found = check(tmp_path, "item,M,SD,n\njoy,3.88,1.07,34\nfear,3.50,1.01,30\nshame,3.88,1.00,30\n", 34)
    assert [fault.row for fault in found.faults] == ["shame"] and "of 30 answers" in found.faults[0].message


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("a,b\nx,y\n", r"t\.csv: no column holds numbers to check"),
        ("a,b\n", r"t\.csv: holds no rows below its header"),
        ("", r"t\.csv: holds no rows below its header"),
        ("sep=,\na,b\nx,0.5\n", r"t\.csv:1: 'sep=' is a line for Excel"),
        (
            "clip,yes,no\na,0.3,0.7\nb,0.3,O.7\nc,0.3,0.7\n",
            r"t\.csv:3: column 'no' holds numbers, but 'O\.7'",
        ),
        ("clip,yes,no\na,0.3,0.7\nb,0.3,\nc,0.3,0.7\n", r"t\.csv:3: column 'no' is empty here"),
        ("clip,yes,no\na,0.3,0.7\nb,0.3\n", r"t\.csv:3: has 2 cells; the header has 3"),
        ("clip,yes,no\na,0,3,0,7\n", r"t\.csv:2: has 5 cells; the header has 3"),
    ],
)
def test_a_table_that_cannot_be_read_is_refused_at_its_line(tmp_path: Path, text: str, message: str) -> None:
    with pytest.raises(InputError, match=message):
        check(tmp_path, text, 34)


def test_a_table_that_is_not_there_is_refused_in_plain_words(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"none\.csv: cannot be read: No such file or directory$"):
        verify(tmp_path / "none.csv", n=34)
    (tmp_path / "t.csv").write_bytes("clip,yes\ncafé,0.3\n".encode("latin-1"))
    with pytest.raises(InputError, match=r"t\.csv: is not UTF-8"):
        verify(tmp_path / "t.csv", n=34)


# R: scrutiny::grimmer(x = M, sd = SD, n = n), the examples of its manual; the last one of two items
GRIMMER = [
    ("5.23", "2.55", 35, 1, False),
    ("5.23", "2.55", 31, 1, True),
    ("4.74", "6.55", 31, 1, True),
    ("2.57", "2.57", 30, 1, True),
    ("2.68", "2.59", 34, 1, True),
    ("5.00", "2.18", 31, 1, True),
    ("2.74", "0.96", 63, 2, True),
    ("2.50", "0.00", 8, 1, False),  # as even as whole answers can be, four 2 and four 3 differ by 0.53
    ("2.50", "0.53", 8, 1, True),
]


@pytest.mark.parametrize(("mean", "sd", "n", "items", "possible"), GRIMMER)
def test_published_standard_deviations_are_judged_as_elsewhere(
    mean: str, sd: str, n: int, items: int, possible: bool
) -> None:
    assert sd_is_possible(Decimal(sd), Decimal(mean), n, items) == possible


@given(
    st.lists(st.lists(st.integers(0, 9), min_size=3, max_size=3), min_size=2, max_size=40), st.integers(0, 17)
)
def test_a_standard_deviation_of_real_answers_is_always_possible(
    people: list[list[int]], decimals: int
) -> None:
    scores = [sum(answers) / 3 for answers in people]
    mean, sd = (Decimal(f"{number:.{decimals}f}") for number in (np.mean(scores), np.std(scores, ddof=1)))
    assert sd_is_possible(sd, mean, len(people), items=3)


def test_a_standard_deviation_that_no_answers_have_is_named(tmp_path: Path) -> None:
    found = check(tmp_path, "item,M,SD\njoy,3.21,0.95\nfear,3.21,0.96\n", 34)
    assert [str(fault) for fault in found.faults] == [
        "line 3, fear: 0.96 is no standard deviation (n − 1) of 34 whole answers with the mean 3.21"
    ]
    assert "2 printed means checked against n = 34, and their standard deviations." in str(found)


@given(st.integers(1, 120), st.integers(0, 120))
def test_what_we_print_of_a_count_leads_back_to_the_count(n: int, k: int) -> None:
    k = min(k, n)
    assert k in counts_behind(Decimal(share(k, n)), n)


def test_a_verification_reads_as_sentences(table_ii: Path) -> None:
    said = str(verify(table_ii, n=N))
    assert "line 3, arc/low: shares add up to 2.00" in said
    assert "follow: 19 against 10 of 34; t(66) = 2.26, p = .014, one-sided" in said
    assert check_text(said) and all(one.consistent for one in check_text(said))


def test_the_table_that_the_analysis_writes_can_be_checked(tmp_path: Path) -> None:
    head = "principle,level,n,higher,lower,share_higher,share_ci_low,d_ci_low,mcnemar_p,fisher_p,binomial_p\n"
    found = check(tmp_path, f"{head}arc,high,34,25,9,{25 / 34},0.56,1.2,0.01,0.003,0.2\n", 34)
    assert (found.kind, found.cells, found.faults) == ("shares", 1, ())
