"""A preregistration from the protocol: everything decided before the first answer, as one document."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import Any

from study.orders import ALGORITHM, cycle
from study.power import power
from study.protocol import Exclusions, Hypothesis, Order, Protocol
from study.questions import Question
from study.specs import specs

_METHODS = {
    "williams": "a Williams design, which balances positions and first-order carry-over",
    "latin square": "a cyclic Latin square, which balances positions",
    "shuffled": "a random order of its own for each participant",
    "fixed": "the order given here, for everybody",
    "between participants": "one of them per participant, evenly assigned",
}


def preregister(protocol: Protocol) -> str:
    """The preregistration in Markdown."""
    sections = (_head, _hypotheses, _design, _stimuli, _participants, _analysis)
    return "\n".join(line for section in sections for line in section(protocol)) + "\n"


def _head(protocol: Protocol) -> Iterator[str]:
    yield f"# Preregistration: {protocol.title.in_('en')}"
    yield ""
    yield f"- Study: `{protocol.study}`" + (f", by {', '.join(protocol.authors)}" if protocol.authors else "")
    yield f"- Contact: {protocol.contact}"
    if protocol.ethics:
        yield f"- Ethics approval: {protocol.ethics}"
    yield f"- Protocol: SHA-256 `{protocol.sha256}` (content of the protocol and the files it names)"
    for change in protocol.amendments:
        yield f"- Amended on {change.date} (SHA-256 `{change.replaces[:12]}` before): {change.reason}"
    yield "- To be registered before the first participant takes part."


def _hypotheses(protocol: Protocol) -> Iterator[str]:
    yield from ("", "## Hypotheses", "")
    hypotheses = protocol.analysis.hypotheses
    if not hypotheses:
        yield "No hypothesis is declared; this study is exploratory."
    for name, hypothesis in hypotheses.items():
        yield f"- **{name}.** {hypothesis.text or stated(hypothesis)}"


def stated(hypothesis: Hypothesis) -> str:
    """The hypothesis in words, where the protocol gives none."""
    if hypothesis.compare is None:
        direction = {"greater": "above", "less": "below", "two-sided": "different from"}[
            hypothesis.alternative
        ]
        return f"In part *{hypothesis.part}*, each stimulus is rated {direction} chance on its target item."
    first, second = hypothesis.compare
    outcome = f"“{hypothesis.outcome}” is chosen" if hypothesis.outcome else "ratings are"
    direction = {"greater": "more", "less": "less", "two-sided": "more or less"}[hypothesis.alternative]
    often = (
        f"{direction} often"
        if hypothesis.outcome
        else {"greater": "higher", "less": "lower"}.get(hypothesis.alternative, "different")
    )
    return f"In part *{hypothesis.part}*, {outcome} {often} for {first} than for {second} intensity."


def _design(protocol: Protocol) -> Iterator[str]:
    videos, minutes = protocol.length
    yield from ("", "## Design", "")
    yield f"Each participant sees {videos} videos in about {minutes} minutes."
    if protocol.practice:
        yield "A practice page comes first; its answers are not analysed."
    for part in protocol.parts.values():
        yield from ("", f"### {part.title.in_('en')} (`{part.id}`)", "")
        yield f"- Judged: {_ids(part.stimuli)}."
        if part.only_if:
            conditions = " and ".join(f"{item} is {' or '.join(a)}" for item, a in part.only_if.items())
            yield f"- Shown only to participants with these earlier answers: {conditions}."
        if part.references:
            yield f"- Each is seen after its reference: {_ids(dict.fromkeys(part.references.values()))}."
        yield f"- Order: {described(part.order)}."
        yield from (f"- Asked: {_asked(question)}." for question in part.questions)
    yield ""
    yield (
        f"Orders are drawn by `{ALGORITHM}` from seed {protocol.seed} and the participant's place in the "
        f"design; all are balanced exactly after every {cycle(protocol)} participants. A place left by "
        "somebody who does not finish is given to the next."
    )


def _ids(stimuli: Iterable[str]) -> str:
    return ", ".join(f"`{stimulus}`" for stimulus in stimuli)


def _asked(question: Question) -> str:
    """A question in words: what is asked, of which items, and the possible answers."""
    items = [text.in_("en") for text in question.items.values() if text != question.text]
    of = f", of each of {', '.join(items)}" if items else ""
    values = question.values
    answers = "free" if values is None else " / ".join(label.in_("en") for label in values.values())
    return f"“{question.text.in_('en')}” ({question.kind}){of}; answers: {answers}"


def described(order: Order) -> str:
    """An order in words."""
    if order.blocks:
        alike, method = order.blocks
        within = (
            "their levels in orders that are evenly spread within each participant"
            if order.levels
            else f"the stimuli within each by {_METHODS[order.stimuli or 'fixed']}"
        )
        return f"in blocks of one {alike}; the blocks by {_METHODS[method]}; {within}"
    limits = " and ".join(f"at most {n} of the same {alike} in a row" for alike, n in order.max_run.items())
    return _METHODS[order.stimuli or "fixed"] + (f", with {limits}" if limits else "")


def _stimuli(protocol: Protocol) -> Iterator[str]:
    yield from ("", "## Stimuli", "")
    yield f"Robot: {', '.join(protocol.robots)}. Parameters that are not listed are neutral."
    yield from ("", "| id | gesture | parameters | SHA-256 |", "|---|---|---|---|")
    for stimulus_id, spec in specs(protocol).items():
        modulation = spec.modulation.model_dump(mode="json")
        parameters = "; ".join(f"{kind}: {_parameters(values)}" for kind, values in modulation.items())
        gesture = protocol.stimuli[stimulus_id].gesture
        yield f"| `{stimulus_id}` | {gesture} | {parameters or 'neutral'} | `{spec.sha256[:16]}` |"


def _parameters(values: Mapping[str, Any]) -> str:
    """Parameters as `name = value`, numbers to four digits; what is empty is left out."""
    words = []
    for name, value in values.items():
        if isinstance(value, Mapping):
            words += [
                f"{inner}: ({_parameters(of)})" if isinstance(of, Mapping) else _parameters({inner: of})
                for inner, of in value.items()
            ]
        elif value not in ([], None):
            words.append(f"{name} = {value:.4g}" if isinstance(value, float) else f"{name} = {value}")
    return ", ".join(words)


def _participants(protocol: Protocol) -> Iterator[str]:
    yield from ("", "## Participants", "")
    yield (
        f"Data are gathered until {protocol.participants.planned} participants have completed the study, "
        "and no tests are run before that."
    )
    for rule in exclusions(protocol.participants.exclude):
        yield f"- {rule}"
    findings = power(protocol)
    if findings:
        yield ""
        yield "Sensitivity:"
        yield ""
        for found in findings:
            strictest = f"the strictest of {found.tests} tests, at alpha = {found.alpha:.4g}"
            yield f"- {found.hypothesis}: {found} in {strictest}."


def exclusions(rules: Exclusions) -> Iterator[str]:
    """The rules of exclusion in words."""
    if rules.incomplete:
        yield "Left out: participants who do not finish."
    if rules.faster_than is not None:
        yield f"Left out: participants whose median time per answer is below {rules.faster_than:g} s."
    if rules.failed_attention is not None:
        yield f"Left out: participants who fail {rules.failed_attention} or more attention checks."
    if rules.straight_lining:
        yield "Left out: participants who give the same answer to every item of a part."


def _analysis(protocol: Protocol) -> Iterator[str]:
    yield from ("", "## Analysis", "", f"The level of significance is {protocol.analysis.alpha:g}.", "")
    for name, hypothesis in protocol.analysis.hypotheses.items():
        compared = (
            f"of the target ratings against chance ({hypothesis.against or 'midpoint'})"
            if hypothesis.compare is None
            else " against ".join(hypothesis.compare)
        )
        corrected = (
            "no correction for multiple tests"
            if hypothesis.correction == "none"
            else f"{hypothesis.correction.capitalize()} correction over the tests of this hypothesis"
        )
        mirrored = ""
        if hypothesis.mirrors:
            mirrored = f" It is {hypothesis.mirrors} seen from the other side, and is not counted again."
        tested = f"{hypothesis.test} test {compared}, {hypothesis.alternative}"
        yield f"- **{name}**: {tested}; {corrected}.{mirrored}"
    yield from ("", "Anything beyond this will be reported as exploratory.")
