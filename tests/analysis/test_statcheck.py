"""Reported tests read back: what is right passes however it is written, what is wrong is named."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from analysis.apa import t_sentence
from analysis.paper import check_paper
from analysis.statcheck import check_text
from analysis.statistics.one_sample_t import METHOD
from analysis.statistics.student_t import student_t
from analysis.statistics.t_test import Alternative, Contrast, TTest, t_test
from stimuli.errors import InputError
from tests.analysis.statistics.test_t_tests import choices, ratings

GOOD = [  # R: 2 * pt(-|t|, df), pf(F, df1, df2, lower.tail = FALSE), pchisq(…), 2 * pnorm(-|z|)
    "t(33) = 4.82, p < .001",
    "t(33)=4.82,p<.001",
    "$t_{33} = 4.82$, $p < 10^{-3}$",
    r"$t(33)~=~4.82,\, p = 3.14 \times 10^{-5}$",
    r"$t(33) = 4.82, p \leq .001$",
    "t(33) = 4.82, p &lt; .001",
    "t(66) = 2.26, P-value = .027",
    "F(1, 30) = 4.20, MSE = 3.2, p = .049",
    "$F_{1,30} = 4.20$, $p = .049$",
    "*t*(33) = 4.82, *p* < .001",
    "_t_(66) = 2.26, _p_ = .027",
    "$t(66) = 2.26$, $p = .027$",
    r"\textit{t}(66) = 2.26, \textit{p} = .027",
    "t(66) = −2.26, p = .027",
    "t(66) = -2.26; p = 0.027",
    "t(df = 66) = 2.26 (p = .027)",
    "t(66) = 2.26, d = 0.55, 95% CI [0.06, 1.03], p = .027",
    "t(66) = 2.26, p = .014, one-sided",
    "t(66) = 2.26, p = .014 (one-tailed)",
    "t(66) = −2.26, p = .986, one-sided",
    "t(59.88) = 18.08, p < .001",
    "t(2.05) = 2.05, p = .086, one-sided",  # df of 2.046 print as 2.05 too
    "F(2, 30) = 3.32, p = .050",
    "F(2,30)=3.32, p=.05",
    "F(1, 28) = 4.20, ηp² = .13, p = .050",
    "r(40) = .31, p = .046",
    "r(40) = −.31, p = .046",
    "χ2(1, N = 90) = 3.84, p = .05",
    "χ²(5) = 36.93, p < .001",
    r"$\chi^2(1) = 3.84$, $p = .05$",
    "X2(1) = 3.84, p = .050",
    "chi2(1) = 3.84, p = .050",
    "H(2) = 7.10, p = .029",
    "z = 1.96, p = .05",
    "Z = −1.96, p = .050",
    "z = 4.50, p = 6.8 × 10^-6",
    "z = 4.50, p = 6.8e-6",
    "t(66) = 2,26, p = ,027",
    "t(66) = −2,26; p = 0,014 (einseitig)",
    "F(2, 30) = 3,32, p = ,050",
    "t(20) = 1.10, p > .05",
    "t(20) = 1.10, p ≥ .25",
    "after Bonferroni correction, t(33) = 2.40, p = .132",
    "t(33) = 2.40, p = .132 (Holm-corrected)",
    "t(33) = 2.40, p = .022, Holm-adjusted p = .132",
]
BAD = [  # sentence, whether the decision changes
    ("t(66) = 2.26, p = .014", False),
    ("t(66) = 2.26, p = .040, two-sided", False),
    ("t(66) = 2,26, p = ,040", False),
    ("t(66) = 2,26, p = 0,014, zweiseitig", False),
    ("t(66) = 2.26, p = .027, one-sided", False),
    ("t(66) = 1.20, p = .01", True),
    ("t(66) = 1.20, p < .05", True),
    ("$t_{66} = 1.20$, $P < .05$", True),
    (r"$t(66) = 1.20, p = 1.0 \times 10^{-3}$", True),
    ("t(10) = 9.99, p = .000", False),
    ("t(33) = 2.40, p = .322, Holm-adjusted p = .132", True),
    ("t(33) = 2.40, p = .002 after Holm's correction", False),
    ("F(2, 30) = 3.32, p = .015", False),
    ("F(2, 30) = 3.32, p = .025, one-sided", False),
    ("*r*(40) = .31, *p* = .01", False),
    ("χ²(1, N = 90) = 4.84, p = .5", True),
    ("z = 1.50, p = .05", False),
    ("z = 4.50, p = 6.8 × 10^-4", False),
    ("t(20) = 3.10, p > .05", True),
]
NO_TESTS = [
    "$r_{12} = .35$, p = .9",  # of variables 1 and 2
    "$t_{1} = 2.26$, p = .9",  # the first
    "The cost = 3.2, p = .5 of the shirt(33) = 4, p = .2.",
    "at 50 Hz = 1.96, p = .9",
    "r = .31, p = .9",
    "F(1) = 3.3, p = .9",
    "t(66) = 2.26, which is large. Then p = .9",
    "t(66) = 2.26, Holm-adjusted p = .9",
    "t(66) = 2.26, n.s.",
    "U = 12, p = .4",
    "β = .4, t = 2.1, p = .9",
]


@pytest.mark.parametrize("sentence", GOOD)
def test_what_is_right_is_read_and_passes(sentence: str) -> None:
    (checked,) = check_text(f"First.\nThe effect was clear, {sentence}. Nothing else.")
    assert (checked.consistent, checked.decision_error, checked.line) == (True, False, 2)


@pytest.mark.parametrize(("sentence", "decision_error"), BAD)
def test_what_is_wrong_is_named(sentence: str, decision_error: bool) -> None:
    (checked,) = check_text(f"First.\nThe effect was clear, {sentence}. Nothing else.")
    assert (checked.consistent, checked.decision_error, checked.line) == (False, decision_error, 2)


@pytest.mark.parametrize("sentence", NO_TESTS)
def test_what_is_no_reported_test_is_left_alone(sentence: str) -> None:
    assert check_text(sentence) == []


def test_one_sided_tests_announced_elsewhere_are_allowed_for() -> None:
    text = "All tests were one-sided.\n\nIt held, t(66) = 2.26, p = .014. So did t(66) = 2.26, p = .027."
    assert [one.consistent for one in check_text(text)] == [True, True]
    assert not check_text(text + " But t(66) = 2.26, p = .04.")[2].consistent


@given(ratings, ratings, st.sampled_from(["greater", "less", "two-sided"]))
def test_our_sentences_pass_the_check(first: list[int], second: list[int], alternative: Alternative) -> None:
    sentence = t_sentence(student_t(first, second, alternative), None, 0.05)
    (checked,) = check_text(f"We found: {sentence}.")
    assert checked.consistent and not checked.decision_error


found = st.builds(
    lambda t, df, alternative: t_test(METHOD, Contrast((9,), t, 1, df, 1), 0, alternative),
    st.floats(-3, 3) | st.floats(-60, 60),
    st.integers(1, 5000).map(float) | st.floats(1, 500),
    st.sampled_from(["greater", "less", "two-sided"]),
)


@given(found, st.none() | st.floats(1, 40), st.sampled_from([0.05, 0.0167]))
def test_whatever_was_found_is_read_back(found: TTest, tests: float | None, alpha: float) -> None:
    assert found.p is not None
    adjusted = None if tests is None else min(1.0, tests * found.p)
    sentence = t_sentence(found, adjusted, alpha, "Holm-adjusted")
    (checked,) = check_text(f"We found: {sentence}.", alpha)
    assert checked.consistent and not checked.decision_error


def test_an_undefined_test_makes_no_claim_to_check() -> None:
    sentence = t_sentence(student_t(choices(34), choices(0)), None, 0.05)
    assert sentence == "t undefined: zero variance in both groups, df = 66, n = 34, n = 34"
    assert check_text(sentence) == []


def test_a_paper_is_read_line_by_line(tmp_path: Path) -> None:
    paper = tmp_path / "paper.md"
    paper.write_text(
        "It held, t(66) = 2.26, p = .014, one-sided.\nSo did t(66) = 1.20,\np = .01.\n", encoding="utf-8"
    )
    found = check_paper(paper, None)
    assert [(one.line, one.text) for one in found.faults] == [(2, "t(66) = 1.20, p = .01")]
    assert str(found).splitlines()[0] == "2 reported tests recomputed, 1 inconsistent."
    assert "the decision changes" in str(found)


@pytest.mark.parametrize(
    "table",
    [
        "\\begin{tabular}{lr}\na & .79 \\\\\n\\end{tabular}",
        "| a | b |\n|---|--:|\n| .79 | .21 |",
        "a | b\n--- | ---\n.79 | .21",
    ],
)
def test_a_table_within_a_text_is_said_to_be_unread(table: str, tmp_path: Path) -> None:
    paper = tmp_path / "paper.md"
    paper.write_text(f"# Results\n\n---\n\nIt held, t(66) = 2.26, p = .027.\n\n{table}\n", encoding="utf-8")
    unread = "1 table was not read: say how many participants are behind it, as in -n 34."
    assert str(check_paper(paper, None)) == f"1 reported test recomputed, 0 inconsistent.\n{unread}"


MARKDOWN = """\
| clip | up | down |
|--|:-:|-:|
| arc high | **0.94** | 0.06 |
| arc low  | 1.00 | 1.00 |
| ant low  | .26 | .74 |

Text | with a bar.
"""
IN_LATEX = r"""\begin{tabular}{l@{}c|c} \toprule
  clip & \textit{up} & down \\[2pt] \midrule
  arc high & $\mathbf{0.94}$ & 0.06 \\ % bold
  arc low & 1.00 & 1.00 \\
  ant low & .26 & .74 \\ \cmidrule(lr){1-2}
\end{tabular}
"""


WIDE = r"{tabularx}{\linewidth}{X@"
IN_TABULARX = IN_LATEX.replace("{tabular}{l@", WIDE).replace("{tabular}", "{tabularx}")


@pytest.mark.parametrize("text", [MARKDOWN, IN_LATEX, IN_TABULARX])
def test_tables_of_a_text_are_checked(text: str, tmp_path: Path) -> None:
    paper = tmp_path / "paper.md"
    paper.write_text(text, encoding="utf-8")
    found = check_paper(paper, 34)
    assert [str(fault) for fault in found.faults] == [
        "line 4, arc low: shares add up to 2.00, and no counts of 34 give them"
    ]
    assert "Table in line 1: 6 printed shares checked against n = 34." in str(found)


def test_a_table_in_which_nothing_can_be_checked_says_so(tmp_path: Path) -> None:
    paper = tmp_path / "paper.md"
    paper.write_text("| a | b |\n|---|---|\n| x | y |\n", encoding="utf-8")
    assert "Table in line 1: not checked; no column holds numbers to check" in str(check_paper(paper, 34))


def test_a_text_that_cannot_be_read_is_refused_in_plain_words(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"none\.md: cannot be read: No such file or directory$"):
        check_paper(tmp_path / "none.md", 34)
    (tmp_path / "paper.pdf").write_bytes(b"%PDF-1.4 \xff\xfe")
    with pytest.raises(InputError, match=r"paper\.pdf: is no UTF-8 text \(a PDF or Word file"):
        check_paper(tmp_path / "paper.pdf", 34)
