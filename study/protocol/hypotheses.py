"""Hypotheses that the study cannot test as they are declared."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from study.protocol.contradiction import Contradiction, unknown
from study.protocol.parts import BETWEEN, WrittenPart, could_be_meant, series_of
from study.protocol.plan import Hypothesis
from study.protocol.protocol import Protocol
from study.questions import Question
from study.questions.scale import Scale
from study.written import Location

TESTS = {  # by what is tested
    "target": ("one-sample t", "wilcoxon", "binomial"),
    "ratings": ("independent t", "paired t", "wilcoxon"),
    "choices": ("independent t", "paired t", "wilcoxon", "mcnemar"),
    "pairs": ("binomial",),
}
MEANING = {
    "target": "target ratings against chance",
    "ratings": "ratings of two conditions",
    "choices": "choices under two conditions",
    "pairs": "pairs, one of which is preferred",
}
WITHIN = ("paired t", "wilcoxon", "mcnemar")  # of two answers by the same participant
HITS = "best item"  # the definition of chance that counts hits, which a binomial test is of


def hypotheses(protocol: Protocol) -> Iterator[Contradiction]:
    """Everything about the plan of analysis that the rest of the protocol contradicts."""
    declared = protocol.analysis.hypotheses
    for name, hypothesis in declared.items():
        here: Location = ("analysis", name)
        yield from unknown((*here, "part"), hypothesis.part, protocol.written_parts, "part")
        if hypothesis.mirrors is not None:
            others = [other for other in declared if other != name]
            yield from unknown((*here, "mirrors"), hypothesis.mirrors, others, "other hypothesis")
        if hypothesis.part in protocol.written_parts:
            part = protocol.written_parts[hypothesis.part]
            wrong = [*_names(protocol, hypothesis, part, here)]
            yield from wrong or _test(protocol, hypothesis, part, here)


def _names(
    protocol: Protocol, hypothesis: Hypothesis, part: WrittenPart, here: Location
) -> Iterator[Contradiction]:
    """Names that the part does not know."""
    items = _questions_by_item(part)
    stimuli = protocol.stimuli_of(hypothesis.part)
    conditions = dict.fromkeys(stimulus.condition or "" for stimulus in stimuli)
    if hypothesis.item is not None:
        known = [*items, *series_of(part.ask)]
        yield from unknown((*here, "item"), hypothesis.item, known, f"item of {hypothesis.part}")
    if hypothesis.outcome is not None and part.pairs is None:
        values = [value for question in part.ask for value in question.values or ()]
        yield from unknown((*here, "outcome"), hypothesis.outcome, values, f"answer in {hypothesis.part}")
    for at, condition in enumerate(hypothesis.compare or ()):
        what = f"level or modulation in {hypothesis.part}"
        yield from unknown((*here, "compare", at), condition, conditions, what)
    if hypothesis.compare and hypothesis.compare[0] == hypothesis.compare[1]:
        yield (*here, "compare"), f"compares {hypothesis.compare[0]} with itself"
    if hypothesis.of == "target" and not any(stimulus.name in items for stimulus in stimuli):
        yield (*here, "of"), f"needs items of {hypothesis.part} that bear the names of its modulations"


def _test(
    protocol: Protocol, hypothesis: Hypothesis, part: WrittenPart, here: Location
) -> Iterator[Contradiction]:
    """Tests of another kind of data than the part yields."""
    tested = "target" if hypothesis.of else "choices" if hypothesis.outcome else "ratings"
    tested = "pairs" if part.pairs is not None else tested
    if tested == "pairs" and hypothesis.of:
        yield (*here, "of"), "does not go with pairs; write compare: [one, another]"
    elif hypothesis.test not in TESTS[tested]:
        fit = ", ".join(TESTS[tested])
        yield (
            (*here, "test"),
            f"is no test of {MEANING[tested]}; {'those are' if ',' in fit else 'that is'} {fit}",
        )
    elif hypothesis.test == "binomial" and hypothesis.of and hypothesis.against != HITS:
        yield (*here, "test"), f"counts hits, which needs against: {HITS}"
    elif hypothesis.against == HITS and hypothesis.of and hypothesis.test != "binomial":
        yield (*here, "against"), "counts hits, which needs test: binomial"
    elif tested == "pairs":
        yield from _of_pairs(protocol, hypothesis, part, here)
    elif tested == "target":
        yield from _chance(hypothesis, part, here)
    elif hypothesis.item is None and len(items := could_be_meant(part.ask)) > 1:
        yield (*here, "compare"), f"does not say of which item; add item: with one of {', '.join(items)}"
    elif tested == "ratings" and (question := _asked(hypothesis, part)):
        if question.values is None:
            yield (*here, "compare"), "is about free answers, which no test here compares"
        elif not isinstance(question, Scale):
            yield (*here, "compare"), f"needs the outcome that counts; one of {', '.join(question.values)}"
    sees_one = BETWEEN in {part.order.stimuli, part.order.modulations}
    if hypothesis.compare and hypothesis.test in WITHIN and sees_one:
        yield (*here, "test"), "sets a person's answers side by side, but each sees one; use independent t"


def _chance(hypothesis: Hypothesis, part: WrittenPart, here: Location) -> Iterator[Contradiction]:
    """A level of chance that no rating can be compared with."""
    scale = next((question.scale for question in part.ask if isinstance(question, Scale)), None)
    if scale is None:
        yield (*here, "of"), "needs ratings; the answers here are none"
    elif isinstance(hypothesis.against, float) and not scale[0] <= hypothesis.against <= scale[1]:
        yield (*here, "against"), f"is not on the scale, which goes from {scale[0]} to {scale[1]}"


def _of_pairs(
    protocol: Protocol, hypothesis: Hypothesis, part: WrittenPart, here: Location
) -> Iterator[Contradiction]:
    if hypothesis.compare and not any(
        pair.of(hypothesis.compare) for pair in protocol.pairs_of(hypothesis.part)
    ):
        yield (*here, "compare"), f"names no pair of {hypothesis.part}"
    if hypothesis.outcome is not None:
        yield (*here, "outcome"), "does not go with pairs: the first of `compare` is what counts"
    if not any(question.kind == "prefer" for question in part.ask):
        yield (*here, "part"), "asks for no preference; ask {prefer: {text: …}} there"


def _asked(hypothesis: Hypothesis, part: WrittenPart) -> Question | None:
    """The question a hypothesis is about; None for a series of items."""
    items = _questions_by_item(part)
    meant = [hypothesis.item] if hypothesis.item else could_be_meant(part.ask)
    return items.get(meant[0] if meant else next(iter(items)))


def _questions_by_item(part: WrittenPart) -> Mapping[str, Question]:
    return {item: question for question in part.ask for item in question.items}
