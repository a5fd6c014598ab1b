"""The protocol's plan of analysis, carried out: which answers meet which test."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from analysis.answers import Answers
from analysis.chance import DEFINITIONS, Definition, fixed
from analysis.dataset import Responses
from analysis.exclusions import Flow, apply_exclusions
from analysis.levels import Compared, Comparison, comparisons
from analysis.preference import Preferred, Two, preferences
from analysis.statistics.samples import Moments, moments
from analysis.target import Judging, Recognised, recognition
from stimuli.errors import InputError
from study.questions.prefer import Prefer

if TYPE_CHECKING:
    from study.protocol import Hypothesis, Protocol


TAKEN = frozenset({
    "study", "data", "answered_at", "analysed_at", "software", "seed", "alpha", "participants", "missing",
    "hypotheses", "further", "described", "answering", "effects", "scales", "bootstrap_seed",
    "before_exclusions",
})  # fmt: skip
"""Names that stand in results.json or among the figures for something else than a hypothesis."""


class PlanError(InputError):
    """A hypothesis that the study's parts cannot answer."""


@dataclass(frozen=True)
class Targets:
    """A hypothesis that targets are rated above chance."""

    hypothesis: str
    name: str  # among results, tables and figures
    part: str
    answers: Answers
    judging: Judging
    chance: str  # name of the definition
    definition: Definition
    results: Mapping[str, Recognised]  # by stimulus
    means: Mapping[str, Mapping[str, Moments]]  # stimulus → item


@dataclass(frozen=True)
class Levels:
    """A hypothesis that one level is judged higher than another."""

    hypothesis: str
    name: str  # among results, tables and figures; a mirrored one bears that of what it mirrors
    mirrors: str | None
    part: str
    answers: Answers
    judging: Judging
    comparison: Comparison
    results: Mapping[str, Compared]  # by principle

    @property
    def within(self) -> bool:
        """Whether some participants judged both levels."""
        return any(one.paired.n[0] > 0 for one in self.results.values())


@dataclass(frozen=True)
class Preferences:
    """A hypothesis that of two clips side by side one is preferred."""

    hypothesis: str
    name: str
    part: str
    answers: Answers
    judging: Judging
    item: str
    compare: tuple[str, str]  # the levels or modulations; the first is what counts
    results: Mapping[str, Preferred]  # by gesture, principle or item


Outcome = Targets | Levels | Preferences


@dataclass(frozen=True)
class Findings:
    """Every hypothesis of a study with its tests, and who was counted."""

    responses: Responses
    flow: Flow
    outcomes: Mapping[str, Outcome]  # by hypothesis
    alpha: float


def carry_out(responses: Responses, protocol: Protocol) -> Findings:
    """Leave out whom the protocol says, and test each of its hypotheses on the rest."""
    kept, flow = apply_exclusions(responses, protocol.participants.exclude)
    outcomes = decide_all(kept, protocol)
    return Findings(responses=kept, flow=flow, outcomes=outcomes, alpha=protocol.analysis.alpha)


def decide_all(responses: Responses, protocol: Protocol) -> dict[str, Outcome]:
    """Test every hypothesis of the protocol, whoever the responses are from."""
    return {
        name: decide(name, hypothesis, responses, protocol)
        for name, hypothesis in protocol.analysis.hypotheses.items()
    }


def result_name(hypothesis: str, protocol: Protocol) -> str:
    """What a hypothesis's results are called: as its part; where a part has several, PART_HYPOTHESIS."""
    hypotheses = protocol.analysis.hypotheses
    counted = hypotheses[hypothesis].mirrors or hypothesis
    part = hypotheses[counted].part
    alone = sum(one.part == part and one.mirrors is None for one in hypotheses.values()) == 1
    return part if alone and part not in TAKEN else f"{part}_{counted}"


def decide(name: str, hypothesis: Hypothesis, responses: Responses, protocol: Protocol) -> Outcome:
    """Test one hypothesis."""
    answers = responses.answers(hypothesis.part, _item(hypothesis, protocol))
    judging = Judging(
        test=hypothesis.test,
        alternative=hypothesis.alternative,
        correction=_counted(hypothesis, protocol).correction,
        alpha=protocol.analysis.alpha,
    )
    if hypothesis.compare is None:
        return _targets(name, hypothesis, answers, protocol, judging)
    if protocol.parts[hypothesis.part].pairs:
        return _preferences(name, hypothesis, answers, protocol, judging)
    return _levels(name, hypothesis, answers, protocol, judging)


def _item(hypothesis: Hypothesis, protocol: Protocol) -> str | None:
    """What is asked: as named; of pairs, which is preferred."""
    part = protocol.parts[hypothesis.part]
    asked = [question for question in part.questions if part.pairs and isinstance(question, Prefer)]
    return hypothesis.item or next((question.item for question in asked), None)


def _counted(hypothesis: Hypothesis, protocol: Protocol) -> Hypothesis:
    """The hypothesis that is counted: a mirrored one takes over the correction of what it mirrors."""
    return protocol.analysis.hypotheses[hypothesis.mirrors] if hypothesis.mirrors else hypothesis


def _targets(
    name: str, hypothesis: Hypothesis, answers: Answers, protocol: Protocol, judging: Judging
) -> Targets:
    if answers.scale is None:
        raise PlanError(f"{name}: the answers of part {answers.part} are no numbers, so none is above chance")
    meant = {s: protocol.stimuli[s].name or s for s in answers.stimuli}
    targets = {stimulus: item for stimulus, item in meant.items() if item in answers.items}
    if not targets:
        raise PlanError(f"{name}: no stimulus of part {answers.part} bears the name of an item")
    chance = hypothesis.against if hypothesis.against is not None else "midpoint"
    definition = DEFINITIONS[chance] if isinstance(chance, str) else fixed(chance)
    ratings = answers.ratings
    return Targets(
        hypothesis=name,
        name=result_name(name, protocol),
        part=answers.part,
        answers=answers,
        judging=judging,
        chance=chance if isinstance(chance, str) else "fixed",
        definition=definition,
        results=recognition(answers, targets, definition, judging),
        means={
            stimulus: {item: moments(ratings[:, s, i]) for i, item in enumerate(answers.items)}
            for s, stimulus in enumerate(answers.stimuli)
        },
    )


def _preferences(
    name: str, hypothesis: Hypothesis, answers: Answers, protocol: Protocol, judging: Judging
) -> Preferences:
    assert hypothesis.compare is not None
    item = hypothesis.item or answers.items[0]
    shown = protocol.pairs_of(hypothesis.part)
    several = len({pair.gesture for pair in shown}) > 1
    pairs = {}
    for pair in shown:
        if two := pair.of(hypothesis.compare):
            where = (pair.gesture if several else None, pair.principle)
            pairs[" ".join(filter(None, where)) or item] = Two(pair.id, *(one.id for one in two))
    return Preferences(
        hypothesis=name,
        name=result_name(name, protocol),
        part=answers.part,
        answers=answers,
        judging=judging,
        item=item,
        compare=hypothesis.compare,
        results=preferences(answers, item, pairs, judging),
    )


def _levels(
    name: str, hypothesis: Hypothesis, answers: Answers, protocol: Protocol, judging: Judging
) -> Levels:
    assert hypothesis.compare is not None
    if hypothesis.outcome is not None and hypothesis.outcome not in answers.options:
        raise PlanError(
            f"{name}: outcome {hypothesis.outcome!r} is no answer; known: {', '.join(answers.options)}"
        )
    if hypothesis.outcome is None and answers.scale is None:
        raise PlanError(f"{name}: name the outcome that counts as 1; one of {', '.join(answers.options)}")
    pairs = _pairs(hypothesis, answers, protocol)
    if not pairs:
        raise PlanError(
            f"{name}: part {answers.part} shows nothing both as {' and as '.join(hypothesis.compare)}"
        )
    comparison = Comparison(
        levels=hypothesis.compare,
        pairs=pairs,
        item=hypothesis.item or answers.items[0],
        outcome=hypothesis.outcome,
        other=_other(hypothesis.outcome, answers.options),
    )
    return Levels(
        hypothesis=name,
        name=result_name(name, protocol),
        mirrors=hypothesis.mirrors,
        part=answers.part,
        answers=answers,
        judging=judging,
        comparison=comparison,
        results=comparisons(answers, comparison, judging),
    )


def _other(outcome: str | None, options: Sequence[str]) -> str | None:
    """The answer that is not the outcome, or of several "not OUTCOME"."""
    others = [option for option in options if option != outcome]
    return None if outcome is None else others[0] if len(others) == 1 else f"not {outcome}"


def _pairs(hypothesis: Hypothesis, answers: Answers, protocol: Protocol) -> dict[str, tuple[str, str]]:
    """What is compared with what: each principle at both levels, or each gesture under both modulations.

    Principles bear their own name; of modulations the pair is named after the item or series judged.
    """
    assert hypothesis.compare is not None
    seen = [protocol.stimuli[stimulus] for stimulus in answers.stimuli]
    several = len({stimulus.gesture for stimulus in seen}) > 1

    def of(condition: str) -> dict[str, str]:
        named = {}
        for stimulus in seen:
            if stimulus.level == condition:
                named[stimulus.id.removesuffix(f"_{condition}")] = stimulus.id
            elif stimulus.name == condition:
                item = hypothesis.item or answers.items[0]
                named[f"{item} {stimulus.gesture}" if several else item] = stimulus.id
        return named

    first, second = map(of, hypothesis.compare)
    return {name: (stimulus, second[name]) for name, stimulus in first.items() if name in second}
