"""A draft of the methods section, with the true numbers of the protocol."""

from __future__ import annotations

import re
from collections.abc import Iterator

from study.preregister import described, exclusions, stated
from study.protocol import Part, Protocol

_NUMBERS = ("no", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten")


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
    text = re.sub(r"([&%$#_{}])", r"\\\1", text)
    return text.translate(
        {ord("“"): "``", ord("”"): "''", ord("~"): r"\textasciitilde{}", ord("…"): r"\dots{}"}
    )


def _count(n: int, one: str, many: str | None = None) -> str:
    number = _NUMBERS[n] if n < len(_NUMBERS) else str(n)
    return f"{number} {one if n == 1 else many or one + 's'}"


def _stimuli(protocol: Protocol) -> Iterator[str]:
    video = protocol.video
    yield f"We demonstrated {_count(len(protocol.gestures), 'gesture')} ({', '.join(protocol.gestures)})"
    yield f"for the robot {' and '.join(protocol.robots)}, learned each as a Dynamic Movement Primitive"
    yield f"({protocol.learning.n_weights} basis functions, gain {protocol.learning.alpha:g})"
    yield "and modulated it with animation principles,"
    yield f"which gave {_count(len(protocol.stimuli), 'stimulus', 'stimuli')}."
    yield f"They were rendered at {video.size} pixels and {video.fps} frames per second, without sound."


def _participants(protocol: Protocol) -> Iterator[str]:
    yield f"We planned for {_count(protocol.participants.planned, 'participant')}; [number] took part"
    yield "([number] female, [number] male, aged [range] years), recruited by [means]."
    if protocol.ethics:
        yield f"The study was approved by [committee] ({protocol.ethics})."
    yield from exclusions(protocol.participants.exclude)


def _procedure(protocol: Protocol) -> Iterator[str]:
    videos, minutes = protocol.length
    yield f"After giving consent, each participant saw {videos} videos in about {minutes} minutes"
    yield f"in {_count(len(protocol.parts), 'part')}" + (
        ", after a page to practise on." if protocol.practice else "."
    )
    yield "Questions opened after a video had been played in full."
    for part in protocol.parts.values():
        after = ", each after its reference" if part.references else ""
        yield f"In part *{part.id}*, {_count(len(part.stimuli), 'video')} were judged{after};"
        yield f"the order was {described(part.order)}."


def _measures(protocol: Protocol) -> Iterator[str]:
    for part in protocol.parts.values():
        yield from _asked(part)


def _asked(part: Part) -> Iterator[str]:
    for question in part.questions:
        if question.values is None:
            answers = "answered freely"
        else:
            labels = [label.in_("en") for label in question.values.values()]
            answers = f"answered on {_count(len(labels), 'option')} from “{labels[0]}” to “{labels[-1]}”"
        yield f"In part *{part.id}* we asked: “{question.text.in_('en')}” ({answers})."


def _analysis(protocol: Protocol) -> Iterator[str]:
    for name, hypothesis in protocol.analysis.hypotheses.items():
        yield f"{name}: {hypothesis.text or stated(hypothesis)}"
        correction = hypothesis.correction.capitalize()
        corrected = "" if hypothesis.correction == "none" else f", {correction}-corrected"
        yield f"The test was: {hypothesis.test}, alternative {hypothesis.alternative}{corrected}."
    yield f"The level of significance was {protocol.analysis.alpha:g}."
    yield f"The protocol's SHA-256 is {protocol.sha256[:16]}; orders follow from seed {protocol.seed}."
