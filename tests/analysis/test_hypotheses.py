"""Several hypotheses, several tests: each has results, tables, figures and sentences of its own."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from analysis.answers import Answers
from analysis.apa import number
from analysis.chance import DEFINITIONS, Target
from analysis.dataset import Responses, read_responses
from analysis.exclusions import Flow
from analysis.figures import draw_targets
from analysis.further import look_further
from analysis.plan import Findings, Levels, Targets, carry_out
from analysis.report import analyse
from analysis.statistics.t_test import Alternative
from analysis.target import Judging, recognition
from analysis.words import assumptions, sentences, summary, warnings
from study.protocol import Protocol, load_protocol
from study.protocol.errors import ProtocolError
from tests.analysis.conftest import PAPER, Write, choices, ratings

MORE = """
  H3:   {part: recognition, test: wilcoxon, of: target, against: other items, alternative: greater}
  H4:   {part: recognition, item: joy, test: paired t, compare: [joy, fear], alternative: greater}
  H5:   {part: intensity, test: mcnemar, compare: [high, low], outcome: higher, alternative: greater}
"""


def with_hypotheses(folder: Path, more: str) -> Protocol:
    """The paper's study with more hypotheses."""
    path = folder / "protocol.yaml"
    text = (PAPER / "protocol.yaml").read_text(encoding="utf-8")
    path.write_text(text.rstrip() + more, encoding="utf-8")
    return load_protocol(path)


def test_hypotheses_on_one_part_keep_their_results_tables_and_figures_apart(
    tmp_path: Path, write: Write
) -> None:
    protocol = with_hypotheses(tmp_path, MORE)
    analyse(write([*ratings(n=12), *choices(n=12)]), protocol, tmp_path / "out")
    names = {"recognition_H1", "recognition_H3", "recognition_H4", "intensity_H2.1", "intensity_H5"}
    tables = {path.name for path in (tmp_path / "out" / "tables").iterdir()}
    figures = {path.name for path in (tmp_path / "out" / "figures").iterdir()}
    written = json.loads((tmp_path / "out" / "results.json").read_text(encoding="utf-8"))
    assert {f"{name}.{form}" for name in names for form in ("tex", "csv")} <= tables
    assert {f"{name}.{form}" for name in names for form in ("svg", "pdf", "png")} <= figures
    assert names <= set(written) and names == set(written["further"]) & names
    assert {one["results"] for one in written["hypotheses"].values()} == names
    assert written["recognition_H1"]["joy"]["chance"]["definition"] == "midpoint"
    ranked = written["recognition_H3"]["joy"]
    assert ranked["chance"]["definition"] == "other items"
    assert (ranked["t_test"]["p_adjusted"], ranked["verdict"]["test"]) == (None, "wilcoxon")
    page = (tmp_path / "out" / "report.html").read_text(encoding="utf-8")
    assert page.count(" (Wilcoxon&#39;s signed-rank)</td>") == 6
    assert "H2.2" in written["intensity_H2.1"]["arc"]["mirrors"]
    assert "mirrors" not in written["intensity_H5"]["arc"]


def test_a_sentence_reports_the_test_that_was_declared(tmp_path: Path, write: Write) -> None:
    protocol = with_hypotheses(tmp_path, MORE)
    outcomes = carry_out(read_responses(write([*ratings(n=12), *choices(n=12)]), protocol), protocol).outcomes
    compared = outcomes["H4"]
    assert isinstance(compared, Levels)
    t = compared.results["joy"].paired.t
    assert f", t(11) = {number(t)}, " in sentences(compared)["joy"]
    ranks = sentences(outcomes["H3"])["joy"]
    assert "; score 1.98 against chance = 0.00 (other items), " in ranks
    assert ranks.endswith("; Wilcoxon's signed-rank p = .002, one-sided")
    assert "; McNemar's exact p" in sentences(outcomes["H5"])["ant"]
    assert assumptions(outcomes["H3"]) == ""


def test_under_other_definitions_of_chance_the_declared_test_decides_too(
    tmp_path: Path, write: Write
) -> None:
    protocol = with_hypotheses(tmp_path, MORE)
    findings = carry_out(read_responses(write([*ratings(n=9), *choices(n=9)]), protocol), protocol)
    outcome = findings.outcomes["H3"]
    assert isinstance(outcome, Targets)
    for one in outcome.results.values():
        decided = {name: verdict.test for name, verdict in one.sensitivity_verdicts.items()}
        assert {name for name, test in decided.items() if test != "wilcoxon"} == {"best item"}
        assert one.sensitivity_verdicts["other items"] == one.verdict


HITS = """
  H3: {part: recognition, test: binomial, of: target, against: best item, alternative: greater}
"""


def test_hits_are_counted_and_decisions_that_hang_on_chance_are_named_together(
    tmp_path: Path, write: Write
) -> None:
    protocol = with_hypotheses(tmp_path, HITS)
    rated = [
        (person, clip, item, "3" if (clip, item) == ("joy", "joy") else "2" if clip == "joy" else rating)
        for person, clip, item, rating in ratings(n=12)
    ]
    findings = carry_out(read_responses(write([*rated, *choices(n=12)]), protocol), protocol)
    hits = sentences(findings.outcomes["H3"])["joy"]
    assert hits == (
        "M = 3.00, SD = 0.00; score 1.00 against chance = 0.17 (best item), "
        "exact binomial p < .001, one-sided, N = 12"
    )
    assert (
        "H1: the decision depends on the definition of chance. "
        "Decided otherwise: joy by B, C, D, E1, E2, F, G (defined below)."
    ) in warnings(findings)


def test_hits_need_the_test_that_counts_them(tmp_path: Path) -> None:
    with pytest.raises(ProtocolError, match="against: 'best item' counts hits, which needs test: binomial"):
        with_hypotheses(tmp_path, HITS.replace("binomial", "wilcoxon"))


def test_only_chance_that_is_a_rating_is_a_line_among_the_ratings(tmp_path: Path, write: Write) -> None:
    protocol = with_hypotheses(tmp_path, MORE)
    outcomes = carry_out(read_responses(write([*ratings(n=4), *choices(n=4)]), protocol), protocol).outcomes
    drawn = {name: draw_targets(outcomes[name], {}).figure.axes[0].texts for name in ("H1", "H3")}
    assert [len(texts) for texts in drawn.values()] == [1, 0]


def test_few_ranks_are_decided_by_their_exact_test(tmp_path: Path, write: Write) -> None:
    protocol = with_hypotheses(tmp_path, MORE)
    rows = [(p, s, i, "5" if s == i else "1") for p, s, i, _ in ratings(n=4)]
    verdict = carry_out(read_responses(write([*rows, *choices(n=4)]), protocol), protocol).outcomes["H3"]
    # R: coin::wilcoxsign_test(rep(4, 4) ~ rep(0, 4), distribution = "exact", alternative = "greater") is 1/16
    assert {one.verdict.p for one in verdict.results.values()} == {1 / 16}


def test_a_hypothesis_bears_a_name_that_a_file_can_bear(tmp_path: Path) -> None:
    with pytest.raises(ProtocolError, match="a/b"):
        with_hypotheses(tmp_path, MORE.replace("H3", "a/b"))


@pytest.mark.parametrize(
    ("alternative", "clips", "levels"),
    [
        ("greater", "clips rated above chance", "told apart as expected"),
        ("less", "clips rated below chance", "told apart as expected"),
        ("two-sided", "clips rated above or below chance", "told apart ("),
    ],
)
def test_the_summary_says_no_more_than_what_was_tested(
    alternative: Alternative, clips: str, levels: str, paper: Protocol, write: Write
) -> None:
    outcomes = carry_out(read_responses(write([*ratings(n=4), *choices(n=4)]), paper), paper).outcomes
    for name, said in {"H1": clips, "H2.1": levels}.items():
        judging = replace(outcomes[name].judging, alternative=alternative)
        assert said in summary(name, replace(outcomes[name], judging=judging))


def test_a_mean_on_a_slider_is_practically_at_chance_within_five_percent_of_it(paper: Protocol) -> None:
    people = tuple(map(str, range(40)))
    codes = np.array([[[46 + place % 9, 50]] for place in range(40)], dtype=np.int8)
    answers = Answers("p", people, ("calm",), ("calm", "other"), tuple(map(str, range(101))), codes)
    judging = Judging("one-sample t", "greater", "none", 0.05)
    midpoint = DEFINITIONS["midpoint"]
    results = recognition(answers, {"calm": "calm"}, midpoint, judging)
    outcome = Targets("H1", "p", "p", answers, judging, "midpoint", midpoint, results, {})
    responses = Responses(Path("r.csv"), "", people, (answers,))
    findings = Findings(responses, Flow(40, (), 40, ()), {"H1": outcome}, 0.05)
    close = look_further(findings, responses, paper).targets["H1"]["calm"].equivalence
    assert close is not None and close.bounds == (45, 55)


def test_who_gives_no_points_at_all_gives_equal_shares() -> None:
    codes = np.array([[[0, 0]], [[30, 10]], [[-1, 0]]], dtype=np.int8)
    answers = Answers("p", ("1", "2", "3"), ("calm",), ("calm", "other"), tuple(map(str, range(101))), codes)
    for name in ("equal share", "equal share above lowest"):
        shares = DEFINITIONS[name].scores(Target(answers, 0, 0)).values
        np.testing.assert_array_equal(shares, [0.5, 0.75, np.nan])
