"""What was found, in words: for the report, and for a paper."""

from __future__ import annotations

from typing import TYPE_CHECKING

from analysis import apa
from analysis.plan import Findings, Levels, Outcome, Preferences, Targets
from analysis.preference import Preferred
from analysis.statistics.t_test import TTest
from analysis.target import Judging, Verdict

if TYPE_CHECKING:
    from study.protocol import Protocol


def sentences(outcome: Outcome) -> dict[str, str]:
    """The test of each stimulus, principle or pair as a sentence for a paper."""
    if isinstance(outcome, Preferences):
        return {name: _preferred(one, outcome.judging) for name, one in outcome.results.items()}
    tests = (
        {name: (one.against.t_test, one.verdict) for name, one in outcome.results.items()}
        if isinstance(outcome, Targets)
        else {name: (one.deciding_t, one.verdict) for name, one in outcome.results.items()}
    )
    return {name: _sentence(test, verdict, outcome.judging) for name, (test, verdict) in tests.items()}


def _sentence(test: TTest, verdict: Verdict, judging: Judging) -> str:
    """A t-test, and beside it the test that decided where that was another."""
    adjusted = None if judging.correction == "none" else verdict.p_adjusted
    if verdict.test.endswith(" t"):
        return apa.t_sentence(test, adjusted, judging.alpha, judging.adjustment)
    decided = f"{verdict.test} p {apa.probability(verdict.p, judging.alpha)}, {judging.sides}"
    if adjusted is not None:
        decided += f", {judging.adjustment} p {apa.probability(adjusted, judging.alpha)}"
    return f"{apa.t_sentence(test)}; {decided}"


def _preferred(one: Preferred, judging: Judging) -> str:
    """How many preferred the first, with the exact interval and test."""
    test, compared = one.test, one.compared
    share = f"{apa.bounded(test.estimate)}, 95% CI {apa.interval(test.ci95)}"
    p = f"p {apa.probability(test.p, judging.alpha)}, {judging.sides}"
    if judging.correction != "none":
        p += f", {judging.adjustment} p {apa.probability(one.verdict.p_adjusted, judging.alpha)}"
    return f"{test.k} of {test.n} preferred {compared.first} to {compared.second} ({share}), {p}"


def summary(name: str, outcome: Outcome) -> str:
    """What was found, in one line."""
    found = [key for key, one in outcome.results.items() if one.verdict.significant]
    what = {Targets: "rated above chance", Preferences: "preferred as expected"}.get(
        type(outcome), "told apart as expected"
    )
    n, of = len(found), len(outcome.results)
    missed = [key for key in outcome.results if key not in found]
    but = f"; not {', '.join(missed)}" if missed and found else ""
    mirrors = outcome.mirrors if isinstance(outcome, Levels) else None
    mirror = f" (the mirror image of {mirrors}, not counted again)" if mirrors else ""
    alpha = apa.bounded(outcome.judging.alpha)
    return f"{name}: {n} of {of} {what} (p {outcome.judging.adjustment}, α = {alpha}){but}{mirror}."


def warnings(findings: Findings) -> list[str]:
    """What a reader must not miss."""
    said = []
    for name, outcome in findings.outcomes.items():
        if isinstance(outcome, Targets):
            if outcome.chance == "midpoint":
                said.append(
                    f"{name}: the chance level is the middle of the scale by assumption; agreeing with every "
                    "item would pass it. The table of definitions shows what others say."
                )
            if depends := [key for key, one in outcome.results.items() if one.depends_on_definition]:
                said.append(
                    f"{name}: the decision depends on the definition of chance for {', '.join(depends)}."
                )
        if degenerate := ", ".join(key for key, one in outcome.results.items() if one.verdict.note):
            said.append(f"{name}: no t-test for {degenerate} (zero variance); an exact test decides.")
    return said


def claim(protocol: Protocol, name: str, outcome: Outcome) -> str:
    """The hypothesis in words: the protocol's, or what its test says."""
    written = protocol.analysis.hypotheses[name].text
    if written:
        return written
    if isinstance(outcome, Targets):
        return "the intended expression is seen"
    if isinstance(outcome, Preferences):
        return f"{outcome.compare[0]} is preferred to {outcome.compare[1]}"
    first, second = outcome.comparison.levels
    return f"{first} is told from {second}"


def method(outcome: Outcome) -> str:
    """How a hypothesis was tested."""
    judging = outcome.judging
    how = (
        f"{judging.test[0].upper()}{judging.test[1:]}, {judging.sides}, α = {apa.bounded(judging.alpha)}; "
        f"p {judging.adjustment} for {len(outcome.results)} tests."
    )
    if isinstance(outcome, Targets):
        return (
            "Each clip's rating on its intended expression against chance: "
            f"{outcome.definition.says} ({outcome.definition.id}). {how}"
        )
    if isinstance(outcome, Preferences):
        first, second = outcome.compare
        return f"Share that chose {first} over {second}, side by side, against one half; exact. {how}"
    first, second = outcome.comparison.levels
    share = f", share of “{outcome.comparison.outcome}”" if outcome.comparison.outcome else ""
    return f"{first.capitalize()} against {second} intensity{share}. {how}"


def labels_of(protocol: Protocol) -> dict[str, str]:
    """English names of items, where the protocol has them."""
    return {
        item: text.in_("en")
        for part in protocol.parts.values()
        for question in part.questions
        for item, text in question.items.items()
        if len(question.items) > 1
    }
