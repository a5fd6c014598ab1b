"""What was found, in words: for the report, and for a paper."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING

from analysis import apa
from analysis.assumptions import Relaxed, relaxed
from analysis.further import Further
from analysis.levels import Compared
from analysis.plan import Findings, Levels, Outcome, Preferences, Targets
from analysis.preference import Preferred
from analysis.statistics.binomial import Binomial
from analysis.statistics.t_test import Alternative, TTest
from analysis.target import Judging, Recognised, Verdict

if TYPE_CHECKING:
    from study.protocol import Protocol


def sentences(outcome: Outcome) -> dict[str, str]:
    """The test of each stimulus, principle or pair as a sentence for a paper."""
    if isinstance(outcome, Preferences):
        return {name: _preferred(one, outcome.judging) for name, one in outcome.results.items()}
    if isinstance(outcome, Targets):
        return {
            name: f"{_against(one, outcome)}, {_tested(one, outcome.judging)}"
            for name, one in outcome.results.items()
        }
    return {
        name: f"{_levels(one)}, {_sentence(one.deciding_t, one.verdict, outcome.judging)}"
        for name, one in outcome.results.items()
    }


def _against(one: Recognised, outcome: Targets) -> str:
    """The mean rating, and chance; of scores that are no ratings their own mean beside it."""
    sd = "" if one.summary.sd is None else f", SD = {apa.number(one.summary.sd)}"
    score = apa.number(one.against.test.estimate)
    scores = "" if outcome.definition.on_scale else f"; score {score}"
    chance = f"against chance = {apa.number(one.against.null)} ({outcome.chance})"
    return f"M = {apa.number(one.summary.mean)}{sd}{scores} {chance}"


def _tested(one: Recognised, judging: Judging) -> str:
    """The test of a target: a t-test, or of hits the exact one."""
    if isinstance(one.against.test, Binomial):
        return f"{_decided_by(one.verdict, judging)}, N = {one.against.test.n}"
    return _sentence(one.against.test, one.verdict, judging)


def _levels(one: Compared) -> str:
    """What was found at both levels."""
    if one.choices is not None:
        (k1, rest1), (k2, rest2) = one.choices.counts.values()
        return f"{k1} of {k1 + rest1} against {k2} of {k2 + rest2}"
    return " against ".join(
        f"M = {apa.number(m.mean)} (SD = {apa.number(m.sd)})" for m in one.summaries.values()
    )


def _sentence(test: TTest, verdict: Verdict, judging: Judging) -> str:
    """A t-test, and beside it the test that decided where that was another."""
    if verdict.test.endswith(" t"):
        adjusted = None if judging.correction == "none" else verdict.p_adjusted
        return apa.t_sentence(test, adjusted, judging.alpha, judging.adjustment)
    return f"{apa.t_sentence(test)}; {_decided_by(verdict, judging)}"


def _decided_by(verdict: Verdict, judging: Judging) -> str:
    """The test that decided, with its p."""
    decided = f"{verdict.by} p {apa.probability(verdict.p, judging.alpha)}, {judging.sides}"
    if judging.correction != "none" and verdict.p_adjusted is not None:
        decided += f", {judging.adjustment} p {apa.probability(verdict.p_adjusted, judging.alpha)}"
    return decided


def _preferred(one: Preferred, judging: Judging) -> str:
    """How many preferred the first, with the exact interval and test."""
    test, compared = one.test, one.compared
    share = f"{apa.bounded(test.estimate)}, 95% CI {apa.interval(test.ci95)}"
    p = f"p {apa.probability(test.p, judging.alpha)}, {judging.sides}"
    if judging.correction != "none":
        p += f", {judging.adjustment} p {apa.probability(one.verdict.p_adjusted, judging.alpha)}"
    return f"{test.k} of {test.n} preferred {compared.first} to {compared.second} ({share}), {p}"


MISSING = (
    "A missing answer is left out of each test it concerns; paired tests use complete pairs, by participant."
)


def left_out(further: Further, findings: Findings) -> str:
    """What leaving participants out changed; empty where nobody was."""
    if not findings.flow.excluded:
        return ""
    changed = [f"{name} {key}" for name, key in further.changed(findings)]
    if changed:
        return f"Leaving participants out changed the decision for {', '.join(changed)}."
    return "Leaving participants out changed no decision."


FOUND: Mapping[type[Outcome], Mapping[Alternative, str]] = {
    Targets: {
        "greater": "clips rated above chance",
        "less": "clips rated below chance",
        "two-sided": "clips rated above or below chance",
    },
    Preferences: {
        "greater": "preferred as expected",
        "less": "preferred as expected",
        "two-sided": "preferred one way or the other",
    },
    Levels: {
        "greater": "told apart as expected",
        "less": "told apart as expected",
        "two-sided": "told apart",
    },
}


def summary(name: str, outcome: Outcome) -> str:
    """What was found, in one line."""
    found = [key for key, one in outcome.results.items() if one.verdict.significant]
    what = FOUND[type(outcome)][outcome.judging.alternative]
    n, of = len(found), len(outcome.results)
    missed = [key for key in outcome.results if key not in found]
    but = f"; not {', '.join(missed)}" if missed and found else ""
    mirrors = outcome.mirrors if isinstance(outcome, Levels) else None
    mirror = f" (the mirror image of {mirrors}, not counted again)" if mirrors else ""
    alpha = apa.significance(outcome.judging.alpha)
    return f"{name}: {n} of {of} {what} ({outcome.judging.adjustment} p, α = {alpha}){but}{mirror}."


def warnings(findings: Findings) -> list[str]:
    """What a reader must not miss."""
    said: list[str] = []
    for name, outcome in findings.outcomes.items():
        if isinstance(outcome, Targets):
            said += _depends(name, outcome)
        said += _assumes(name, outcome)
        if not (isinstance(outcome, Levels) and outcome.mirrors):
            said += _undefined(name, outcome)
    return said


def _undefined(name: str, outcome: Outcome) -> Iterator[str]:
    """Where the declared test has no answer, why, and which exact test decides instead."""
    replaced: dict[tuple[str | None, str], list[str]] = {}
    for key, one in outcome.results.items():
        if one.verdict.note:
            exact = f"; {one.verdict.test} test decides" if one.verdict.p is not None else ""
            replaced.setdefault((one.verdict.note, exact), []).append(key)
    for (reason, exact), keys in replaced.items():
        yield f"{name}: {outcome.judging.named} {reason} ({', '.join(keys)}){exact}."


def _depends(name: str, outcome: Targets) -> Iterator[str]:
    """Which decisions another definition of chance turns round."""
    turned: dict[str, list[str]] = {}  # by the definitions that do
    for stimulus, one in outcome.results.items():
        if others := [
            one.sensitivity[name].definition.id
            for name, verdict in one.sensitivity_verdicts.items()
            if verdict.significant != one.verdict.significant
        ]:
            turned.setdefault(", ".join(others), []).append(stimulus)
    if turned:
        which = "; ".join(f"{', '.join(stimuli)} by {others}" for others, stimuli in turned.items())
        yield (
            f"{name}: the decision depends on the definition of chance. Decided otherwise: {which} "
            "(defined below)."
        )


def _assumes(name: str, outcome: Outcome) -> Iterator[str]:
    """Which decisions rest on an assumption of the declared test."""
    turned = [one for one in relaxed(outcome) if one.otherwise]
    if turned:
        which = "; ".join(
            f"by {one.test}, not assuming {one.assumes}: {', '.join(one.otherwise)}" for one in turned
        )
        yield f"{name}: the decision depends on the test. Decided otherwise: {which}."


def assumptions(outcome: Outcome) -> str:
    """What the declared test assumes, and what tests without it decide; empty for exact tests."""
    found = [f"{one.assumes} ({one.test}: {_decided(one)})" for one in relaxed(outcome)]
    return f"Assumptions, and what tests without them decide: {'; '.join(found)}." if found else ""


def _decided(one: Relaxed) -> str:
    if one.undefined:
        return "undefined"
    return f"otherwise for {', '.join(one.otherwise)}" if one.otherwise else "the same"


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
    on = "" if outcome.comparison.outcome else f" on {outcome.comparison.item}"
    return f"{first} is told from {second}{on}"


def method(outcome: Outcome) -> str:
    """How a hypothesis was tested."""
    judging = outcome.judging
    alpha = apa.significance(judging.alpha)
    how = (
        f"{judging.named[0].upper()}{judging.named[1:]}, {judging.sides}, α = {alpha}; "
        f"{judging.adjustment} p for {len(outcome.results)} test{'s' * (len(outcome.results) != 1)}."
    )
    if isinstance(outcome, Targets):
        is_assumed = " The middle is an assumption: agreeing with every item would pass it."
        assumed = is_assumed if outcome.chance == "midpoint" else ""
        return (
            "Each clip's rating on its intended expression against chance: "
            f"{outcome.definition.says} ({outcome.definition.id}).{assumed} {how}"
        )
    if isinstance(outcome, Preferences):
        first, second = outcome.compare
        return f"Share that chose {first} over {second}, side by side, against one half. {how}"
    first, second = outcome.comparison.levels
    share = f", share of “{outcome.comparison.outcome}”" if outcome.comparison.outcome else ""
    return f"{first.capitalize()} against {second}{share}. {how}"


def labels_of(protocol: Protocol) -> dict[str, str]:
    """English names of items, where the protocol has them."""
    return {
        item: text.in_("en")
        for part in protocol.parts.values()
        for question in part.questions
        for item, text in question.items.items()
        if len(question.items) > 1
    }
