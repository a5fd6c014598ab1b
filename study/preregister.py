"""A preregistration from the protocol: everything decided before the first answer, as one document."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from importlib.metadata import version

from study.orders import ALGORITHM, cycle
from study.power import power
from study.protocol import Part, Protocol
from study.specs import robot_titles, specs
from study.words import (
    asked,
    beside_the_test,
    count,
    exclusions,
    listed,
    ordered,
    parameters,
    replays,
    shown_if,
    stated,
    stop_rule,
    tested,
)


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
    yield f"- Software: expressive-motion-study {version('expressive-motion-study')}"
    for change in protocol.amendments:
        yield f"- Amended on {change.date} (SHA-256 `{change.replaces[:12]}` before): {change.reason}"
    when = (
        "beside what was registered before it began"
        if protocol.amendments
        else "before the first participant takes part"
    )
    yield f"- To be registered {when}."


def _hypotheses(protocol: Protocol) -> Iterator[str]:
    yield from ("", "## Hypotheses", "")
    hypotheses = protocol.analysis.hypotheses
    if not hypotheses:
        yield "No hypothesis is declared; this study is exploratory."
    for name, hypothesis in hypotheses.items():
        yield f"- **{name}.** {hypothesis.text or stated(protocol, hypothesis)}"


def _design(protocol: Protocol) -> Iterator[str]:
    videos, minutes = protocol.length
    yield from ("", "## Design", "")
    yield f"Each participant sees {count(videos, 'video')} in about {count(minutes, 'minute')}."
    if protocol.practice:
        yield "A practice page comes first; its answers are not analysed."
    if protocol.demographics:
        questions = "; ".join(asked(question) for question in protocol.demographics)
        yield f"About themselves participants are asked first: {questions}."
    for part in protocol.parts.values():
        yield from ("", f"### {part.title.in_('en')} (`{part.id}`)", "")
        yield from _part(part)
    whole = cycle(protocol)
    yield ""
    yield (
        f"Orders are drawn by `{ALGORITHM}` from seed {protocol.seed} and the participant's place"
        + (f"; what is balanced is so exactly after every {whole} participants" if whole > 1 else "")
        + ". A place is given to the next once nothing was answered for "
        + f"{protocol.participants.abandoned_after / 60:g} minutes."
    )


def _part(part: Part) -> Iterator[str]:
    if part.pairs:
        pairs = (f"`{first}` or `{second}`" for first, second in part.pairs.values())
        yield f"- Compared, side by side, each side balanced: {'; '.join(pairs)}."
    else:
        yield f"- Judged: {_ids(part.stimuli)}."
    if part.shown is not None:
        yield f"- Each participant judges {part.shown} of these {len(part.stimuli)}."
    if part.only_if:
        yield f"- Shown only to participants with these earlier answers: {shown_if(part)}."
    if part.references:
        yield f"- Each is seen after its reference: {_ids(dict.fromkeys(part.references.values()))}."
    yield f"- Order: {ordered(part.order)}."
    yield from (f"- Asked: {asked(question)}." for question in part.questions)


def _ids(stimuli: Iterable[str]) -> str:
    return ", ".join(f"`{stimulus}`" for stimulus in stimuli)


def _stimuli(protocol: Protocol) -> Iterator[str]:
    yield from ("", "## Stimuli", "")
    video = protocol.video
    learning = protocol.learning
    yield f"Robot: {listed(robot_titles(protocol))}. Gestures are learned as Dynamic Movement Primitives"
    yield f"({parameters(learning.model_dump(mode='json'))}) and modulated by the parameters"
    yield "below, angles in radians and times in seconds; what is not listed is neutral."
    yield f"Clips are rendered at {video.size} pixels and {video.fps} frames per second, without sound,"
    yield f"still for {video.lead_in:g} s before the motion and {video.hold:g} s after it. The questions open"
    yield f"when a clip has been played to its end; it {replays(video)}."
    yield "The hash is that of all a clip is made from."
    yield from ("", "| id | gesture | parameters | SHA-256 |", "|---|---|---|---|")
    for stimulus_id, spec in specs(protocol).items():
        modulation = spec.modulation.model_dump(mode="json")
        shown = "; ".join(f"{kind}: {parameters(values)}" for kind, values in modulation.items())
        gesture = protocol.stimuli[stimulus_id].gesture
        yield f"| `{stimulus_id}` | {gesture} | {shown or 'neutral'} | `{spec.sha256[:16]}` |"


def _participants(protocol: Protocol) -> Iterator[str]:
    rules = protocol.participants
    yield from ("", "## Participants", "")
    yield f"Data are gathered {stop_rule(rules)}."
    if not rules.peeking:
        yield "No test is run before as many as planned have completed."
    if left_out := exclusions(rules.exclude):
        yield f"Left out of all tests are {left_out}. Whoever is left out after completing is not replaced."
    findings = power(protocol)
    if findings:
        yield from ("", "What so many can find:", "")
    yield from (f"- {found.hypothesis}: {found} {found.level}." for found in findings)


def _analysis(protocol: Protocol) -> Iterator[str]:
    yield from ("", "## Analysis", "", f"The level of significance is {protocol.analysis.alpha:g}.")
    yield "A missing answer is left out of each test it concerns; paired tests use complete pairs."
    yield "Where a t-test is undefined, because nobody differs, its exact counterpart decides."
    yield ""
    for name, hypothesis in protocol.analysis.hypotheses.items():
        mirrored = ""
        if hypothesis.mirrors:
            mirrored = f" It is {hypothesis.mirrors} seen from the other side, and is not counted again."
        beside = f" {note}." if (note := beside_the_test(protocol, hypothesis)) else ""
        yield f"- **{name}**: {tested(protocol, hypothesis)}.{mirrored or beside}"
    yield from ("", "Anything beyond this will be reported as exploratory.")
