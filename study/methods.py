"""A draft of the methods section, with the true numbers of the protocol."""

from __future__ import annotations

import re
from collections.abc import Iterator
from importlib.metadata import version

from stimuli.principles import PRINCIPLES, Modulation
from study.power import power
from study.protocol import BESIDE, PRACTICE, Part, Protocol
from study.specs import robot_titles
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
    tested,
)

SERVICES = {"prolific": "Prolific", "sona": "SONA", "mturk": "Amazon Mechanical Turk"}

ESCAPED = {character: f"\\{character}" for character in "&%$#_{}"} | {
    "\\": r"\textbackslash{}",
    "^": r"\textasciicircum{}",
    "~": r"\textasciitilde{}",
    "…": r"\dots{}",
    "“": "``",
    "”": "''",
    "–": "--",
    "≥": r"$\geq$",
    "≤": r"$\leq$",
}  # in LaTeX


def methods(protocol: Protocol) -> str:
    """The draft in Markdown. What only the authors can know is left in [brackets]."""
    sections = {
        "Stimuli": _stimuli,
        "Participants": _participants,
        "Procedure": _procedure,
        "Measures": _measures,
        "Analysis": _analysis,
    }
    paragraphs = [f"## {title}\n\n{' '.join(write(protocol))}" for title, write in sections.items()]
    return "# Methods (draft)\n\n" + "\n\n".join(paragraphs) + "\n"


def methods_latex(protocol: Protocol) -> str:
    """The draft in LaTeX, to be put into a paper."""
    text = _escaped(methods(protocol))
    text = re.sub(r"(?m)^\\#\\# (.*)$", r"\\subsection{\1}", text)
    text = re.sub(r"(?m)^\\# (.*)$", r"\\section{\1}", text)
    return re.sub(r"\*(.+?)\*", r"\\emph{\1}", text)


def _escaped(text: str) -> str:
    """Every character that LaTeX would take for a command, as itself."""
    return text.translate({ord(character): latex for character, latex in ESCAPED.items()})


def _stimuli(protocol: Protocol) -> Iterator[str]:
    video = protocol.video
    used = {kind for stimulus in protocol.stimuli.values() for kind in stimulus.modulation.model_dump()}
    principles = [principle.title for kind, principle in PRINCIPLES.items() if kind in used]
    yield f"We demonstrated {count(len(protocol.gestures), 'gesture')} ({listed(protocol.gestures)})"
    several = "s" if len(protocol.robots) > 1 else ""
    yield f"for the robot{several} {listed(robot_titles(protocol))}."
    yield "Each was learned as a Dynamic Movement Primitive"
    yield f"({protocol.learning.n_weights} basis functions, gain {protocol.learning.alpha:g})"
    yield f"and modulated by {listed(principles)}," if principles else "and replayed,"
    practised = len(protocol.stimuli) - sum(s.id not in {PRACTICE, BESIDE} for s in protocol.stimuli.values())
    yield f"which gave {count(len(protocol.stimuli), 'stimulus', 'stimuli')}" + (
        f", {count(practised, 'of them', 'of them')} to practise on." if practised else "."
    )
    yield from _intensities(protocol)
    width, height = video.pixels
    yield f"They were rendered with MuJoCo at {width} by {height} pixels and {video.fps} frames per second,"
    yield "without sound."


def _intensities(protocol: Protocol) -> Iterator[str]:
    """What every principle was set to, modulation by modulation and level by level."""
    said: dict[str, Modulation] = {}
    for stimulus in protocol.stimuli.values():
        if stimulus.modulation.principles:
            said.setdefault(stimulus.name or f"{stimulus.principle} {stimulus.level}", stimulus.modulation)
    if said:
        yield "Intensities (angles in rad, times in s; all else neutral) were:"
        yield "; ".join(f"*{name}*: {_set(modulation)}" for name, modulation in said.items()) + "."


def _set(modulation: Modulation) -> str:
    """The principles and their parameters, as far as they are not the defaults."""
    words = []
    for principle in modulation.principles:
        values = principle.model_dump(mode="json", exclude_defaults=True)
        told = values.pop("intensity", None) is not None or not values
        strength = f" {principle.intensity:g}" if told else ""
        words.append(f"{principle.title}{strength}" + (f" ({parameters(values)})" if values else ""))
    return ", ".join(words)


def _participants(protocol: Protocol) -> Iterator[str]:
    yield f"We planned for {count(protocol.participants.planned, 'participant')}."
    alike: dict[str, list[str]] = {}
    for found in power(protocol):
        alike.setdefault(f"{found} {found.level}", []).append(found.hypothesis)
    yield from (f"For {listed(names)}, {found}." for found, names in alike.items())
    by_hand = protocol.participants.stop == "by hand"
    until = "[when] we closed the study" if by_hand else "as many had completed the study"
    yield f"Data were gathered until {until}. [Number] took part"
    service = protocol.participants.recruitment.service
    means = f"through {SERVICES[service]}" if service else "by [means]"
    yield f"([number] female, [number] male, aged [range] years), recruited {means}."
    if protocol.ethics:
        yield f"The study was approved by [committee] ({protocol.ethics})."
    if left_out := exclusions(protocol.participants.exclude):
        yield f"As declared beforehand, we left out {left_out}: [number]."


def _procedure(protocol: Protocol) -> Iterator[str]:
    videos, minutes = protocol.length
    yield f"After giving consent, each participant saw {count(videos, 'video')} in about"
    yield f"{count(minutes, 'minute')}, in {count(len(protocol.parts), 'part')}" + (
        ", after a page to practise on." if protocol.practice else "."
    )
    yield "The questions of a page opened when its videos had been played in full;"
    yield f"a video {replays(protocol.video, 'could')}."
    for part in protocol.parts.values():
        yield from _part(part)


def _part(part: Part) -> Iterator[str]:
    what = ("pair of videos", "pairs of videos") if part.pairs else ("video", "videos")
    here = f"In part *{part.id}*" + (f", shown only where {shown_if(part)}," if part.only_if else ",")
    judged = count(len(part.stimuli), *what)
    if part.shown is not None:
        yield f"{here} each participant judged {count(part.shown, *what)} of {judged}, evenly assigned."
    elif len(part.stimuli) == 1:
        yield f"{here} {judged} was judged."
    else:
        after = ", each after its reference" if part.references else ""
        order = "they came" if part.order.blocks else "their order was"
        yield f"{here} {judged} were judged{after}; {order} {ordered(part.order)}."


def _measures(protocol: Protocol) -> Iterator[str]:
    for part in protocol.parts.values():
        for question in part.questions:
            yield f"In part *{part.id}* we asked {asked(question)}."


def _analysis(protocol: Protocol) -> Iterator[str]:
    for name, hypothesis in protocol.analysis.hypotheses.items():
        yield f"{name}: {hypothesis.text or stated(protocol, hypothesis)}"
        mirrored = f", the mirror image of {hypothesis.mirrors}" if hypothesis.mirrors else ""
        yield f"Its test was: {tested(protocol, hypothesis)}{mirrored}."
        if not mirrored and (note := beside_the_test(protocol, hypothesis)):
            yield f"{note}."
    yield f"The level of significance was {protocol.analysis.alpha:g}."
    for change in protocol.amendments:
        reason = change.reason.rstrip(".")
        yield f"The protocol was amended on {change.date}, after [number] participants: {reason}."
    yield f"The protocol's SHA-256 is {protocol.sha256[:16]}; orders follow from seed {protocol.seed}."
    yield "Stimuli, sessions and analysis were made with expressive-motion-study"
    yield f"{version('expressive-motion-study')}."
