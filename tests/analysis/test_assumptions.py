"""What a test assumes is said, and which decisions rest on it."""

from __future__ import annotations

from analysis.assumptions import relaxed
from analysis.dataset import read_responses
from analysis.plan import carry_out
from analysis.words import assumptions, warnings
from study.protocol import Protocol
from tests.analysis.conftest import N, Row, Write, choices, ratings


def follow_paired_at_its_worst() -> list[Row]:
    """The published counts, with those who called Follow low higher among those who did not call high so."""
    return [
        (person, stimulus, item, "higher" if int(person[1:]) >= N - 10 else "lower")
        if stimulus == "follow_low"
        else (person, stimulus, item, answer)
        for person, stimulus, item, answer in choices()
    ]


def test_a_decision_that_rests_on_independent_answers_is_named(paper: Protocol, write: Write) -> None:
    findings = carry_out(read_responses(write([*ratings(), *follow_paired_at_its_worst()]), paper), paper)
    outcome = findings.outcomes["H2.1"]
    found = {one.test: one.otherwise for one in relaxed(outcome)}
    # R: p.adjust(c(rep(1e-6, 5), binom.test(19, 29, alternative = "greater")$p.value), "holm")[6] is .068
    assert found["McNemar's exact"] == ("follow",)
    assert found["Welch's t"] == () and found["Fisher's exact"] == ()
    said = "by McNemar's exact, not assuming independent answers and normal means: follow"
    assert any(said in warning for warning in warnings(findings))
    assert "(McNemar's exact: otherwise for follow)" in assumptions(outcome)
    assert assumptions(findings.outcomes["H2.2"]) == ""  # the same tests, seen from the other side


def test_every_assumption_is_named_where_nothing_rests_on_it(paper: Protocol, write: Write) -> None:
    findings = carry_out(read_responses(write([*ratings(), *choices()]), paper), paper)
    assert assumptions(findings.outcomes["H1"]) == (
        "Assumptions, and what tests without them decide: normally distributed means "
        "(exact sign flip: the same); equally spaced points (Wilcoxon's signed ranks: the same)."
    )
    assert warnings(findings) == [
        "H2.1: Student's t-test of independent samples undefined: zero variance in both groups (time, exa); "
        "Fisher's exact test decides."
    ]
