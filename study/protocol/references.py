"""Names that lead nowhere and statements that contradict each other: what no single field can see."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from typing import TYPE_CHECKING

from study.protocol.parts import NEUTRAL, PRACTICE, series_of
from study.protocol.texts import files_named_in
from study.text import Text
from study.written import Location, nearest

if TYPE_CHECKING:
    from study.protocol.protocol import Protocol

Contradiction = tuple[Location, str]  # where, and what is wrong


def contradictions(protocol: Protocol) -> Iterator[Contradiction]:
    """Everything in a protocol that does not fit together."""
    lost = [*_stimuli(protocol), *_practice(protocol)]
    yield from lost
    yield from _texts(protocol)
    yield from _questions(protocol)
    yield from _conditions(protocol)
    if not lost:  # what follows needs the stimuli
        yield from _ids(protocol)
        yield from _hypotheses(protocol)


def _unknown(location: Location, name: str, known: Collection[str], what: str) -> Iterator[Contradiction]:
    if name not in known:
        yield location, f"is no {what}; {nearest(name, known)}"


def _stimuli(protocol: Protocol) -> Iterator[Contradiction]:
    for part_id, part in protocol.written_parts.items():
        here: Location = ("parts", part_id)
        chosen = part.stimuli
        for at, gesture in enumerate(chosen.gestures):
            yield from _unknown((*here, "stimuli", "gesture", at), gesture, protocol.gestures, "gesture")
        for at, name in enumerate(chosen.modulations or ()):
            if not protocol.members(name):
                known = [*protocol.modulations, NEUTRAL]
                yield from _unknown((*here, "stimuli", "modulations", at), name, known, "modulation")
        for at, kind in enumerate(chosen.levels or ()):
            place: Location = (*here, "stimuli", "levels", at)
            yield from _unknown(place, kind, protocol.levels, "principle with levels")
            if part.reference and kind in protocol.levels and part.reference not in protocol.levels[kind]:
                known_levels = protocol.levels[kind]
                yield from _unknown((*here, "reference"), part.reference, known_levels, f"level of {kind}")
        if part.reference and not chosen.levels:
            yield (*here, "reference"), "is for stimuli chosen by levels"
        if part.order.principles and not chosen.levels:
            yield (*here, "order", "principles"), "is for stimuli chosen by levels; order `stimuli` instead"


def _practice(protocol: Protocol) -> Iterator[Contradiction]:
    if practice := protocol.practice:
        here: Location = ("practice", "stimulus")
        yield from _unknown((*here, "gesture"), practice.stimulus.gesture, protocol.gestures, "gesture")
        if practice.stimulus.modulation:
            name = practice.stimulus.modulation
            yield from _unknown((*here, "modulation"), name, protocol.modulations, "modulation")
        yield from _unknown(("practice", "ask"), practice.ask, protocol.written_parts, "part")


def _ids(protocol: Protocol) -> Iterator[Contradiction]:
    taken = {PRACTICE: "the practice"}
    for part_id in protocol.written_parts:
        for stimulus in protocol.stimuli_of(part_id):
            if stimulus.id in taken:
                yield (
                    ("parts", part_id, "stimuli"),
                    f"gives a stimulus the id {stimulus.id}, which {taken[stimulus.id]} has too; "
                    "add a prefix, such as {prefix: second_, gesture: …}",
                )
            taken[stimulus.id] = f"part {part_id}"


def _questions(protocol: Protocol) -> Iterator[Contradiction]:
    pages = [(("parts", part_id, "ask"), part.ask) for part_id, part in protocol.written_parts.items()]
    for here, questions in [*pages, (("demographics",), protocol.demographics)]:
        seen: set[str] = set()
        for at, question in enumerate(questions):
            for item in question.items:
                if item in seen:
                    yield (*here, at, question.kind), f"asks for {item} a second time on the page"
                seen.add(item)


def _conditions(protocol: Protocol) -> Iterator[Contradiction]:
    """Parts shown only after certain answers, and checks on certain trials."""
    earlier = {item: question.values for question in protocol.demographics for item in question.items}
    for part_id, part in protocol.written_parts.items():
        for item, answers in part.only_if.items():
            here: Location = ("parts", part_id, "if", item)
            yield from _unknown(here, item, earlier, "item asked before this part")
            for answer in answers if item in earlier else ():
                yield from _unknown(here, answer, earlier[item] or (answer,), f"answer to {item}")
        earlier |= {item: question.values for question in part.ask for item in question.items}


def _texts(protocol: Protocol) -> Iterator[Contradiction]:
    texts: list[tuple[Location, Text]] = [
        (("texts", name), text) for name, text in protocol.written_texts if text is not None
    ]
    texts += [
        (("parts", part_id, "intro"), part.intro)
        for part_id, part in protocol.written_parts.items()
        if part.intro is not None
    ]
    for here, text in texts:
        for language, file in files_named_in(text, protocol.folder).items():
            place: Location = (*here, language) if language else here
            try:
                file.read_text(encoding="utf-8")
            except OSError as error:
                yield place, f"cannot be read: {error.strerror}"
            except UnicodeDecodeError:
                yield place, "is not UTF-8; save the file with encoding UTF-8"


def _hypotheses(protocol: Protocol) -> Iterator[Contradiction]:
    hypotheses = protocol.analysis.hypotheses
    for name, hypothesis in hypotheses.items():
        here: Location = ("analysis", name)
        yield from _unknown((*here, "part"), hypothesis.part, protocol.written_parts, "part")
        if hypothesis.mirrors is not None:
            others = [other for other in hypotheses if other != name]
            yield from _unknown((*here, "mirrors"), hypothesis.mirrors, others, "other hypothesis")
        if hypothesis.part not in protocol.written_parts:
            continue
        part = protocol.written_parts[hypothesis.part]
        items = [item for question in part.ask for item in question.items]
        values = [value for question in part.ask for value in question.values or ()]
        stimuli = protocol.stimuli_of(hypothesis.part)
        conditions = dict.fromkeys(condition for s in stimuli if (condition := s.level or s.name))
        scored = [*items, *series_of(part.ask)]
        if hypothesis.item is not None:
            yield from _unknown((*here, "item"), hypothesis.item, scored, f"item of {hypothesis.part}")
        if hypothesis.outcome is not None:
            yield from _unknown(
                (*here, "outcome"), hypothesis.outcome, values, f"answer in {hypothesis.part}"
            )
        for at, level in enumerate(hypothesis.compare or ()):
            what = f"level or modulation in {hypothesis.part}"
            yield from _unknown((*here, "compare", at), level, conditions, what)
        if hypothesis.of == "target" and not any(stimulus.name in items for stimulus in stimuli):
            yield (*here, "of"), f"needs items of {hypothesis.part} that bear the names of its modulations"
