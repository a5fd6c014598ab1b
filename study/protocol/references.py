"""Names that lead nowhere and statements that contradict each other: what no single field can see."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from stimuli.robots.belongings import bound_names
from study.protocol.contradiction import Contradiction, unknown
from study.protocol.hypotheses import hypotheses
from study.protocol.parts import BESIDE, NEUTRAL, PRACTICE
from study.protocol.protocol import Protocol
from study.protocol.renamed import renamed
from study.protocol.texts import files_named_in
from study.questions import Question
from study.questions.attention import Attention
from study.questions.prefer import Prefer
from study.text import Text
from study.written import Location

LEAVES = "leaves the study's folder; copy it there, so that the study can be kept whole and handed on"


def contradictions(protocol: Protocol, *, kept: bool = False) -> Iterator[Contradiction]:
    """Everything in a protocol that does not fit together; of a kept copy, not where files lie."""
    lost = [*_stimuli(protocol), *_practice(protocol)]
    yield from lost
    yield from () if kept else _files(protocol)
    yield from _texts(protocol)
    yield from _questions(protocol)
    yield from _conditions(protocol)
    if not lost:  # what follows needs the stimuli
        yield from _ids(protocol)
        yield from _pairs(protocol)
        yield from _attention(protocol)
        yield from hypotheses(protocol)
        yield from renamed(protocol)


def _stimuli(protocol: Protocol) -> Iterator[Contradiction]:
    for part_id, part in protocol.written_parts.items():
        here: Location = ("parts", part_id)
        chosen = part.stimuli
        for at, gesture in enumerate(chosen.gestures):
            yield from unknown((*here, "stimuli", "gesture", at), gesture, protocol.gestures, "gesture")
        for at, name in enumerate(chosen.modulations or ()):
            if not protocol.members(name):
                known = [*protocol.modulations, NEUTRAL]
                yield from unknown((*here, "stimuli", "modulations", at), name, known, "modulation")
        for at, kind in enumerate(chosen.levels or ()):
            place: Location = (*here, "stimuli", "levels", at)
            yield from unknown(place, kind, protocol.levels, "principle with levels")
            if part.reference and kind in protocol.levels and part.reference not in protocol.levels[kind]:
                known_levels = protocol.levels[kind]
                yield from unknown((*here, "reference"), part.reference, known_levels, f"level of {kind}")
        if part.reference and part.pairs is not None:
            yield (*here, "reference"), "does not go with pairs, which are shown side by side already"
        if part.reference and not chosen.levels:
            yield (*here, "reference"), "is for stimuli chosen by levels"
        if part.order.principles and not chosen.levels:
            yield (*here, "order", "principles"), "is for stimuli chosen by levels; order `stimuli` instead"


def _practice(protocol: Protocol) -> Iterator[Contradiction]:
    practice = protocol.practice
    if practice is None:
        return
    for field, chosen in (("stimulus", practice.stimulus), ("beside", practice.beside)):
        if chosen is None:
            continue
        here: Location = ("practice", field)
        yield from unknown((*here, "gesture"), chosen.gesture, protocol.gestures, "gesture")
        if chosen.modulation not in {None, NEUTRAL}:
            known = [*protocol.modulations, NEUTRAL]
            yield from unknown((*here, "modulation"), chosen.modulation or "", known, "modulation")
    yield from unknown(("practice", "ask"), practice.ask, protocol.written_parts, "part")
    asked = protocol.written_parts.get(practice.ask)
    if asked and asked.pairs is None and practice.beside:
        yield ("practice", "beside"), f"is for a part with pairs; {practice.ask} has none"
    if asked and asked.pairs is not None and not practice.beside:
        example = f"beside: {{gesture: {practice.stimulus.gesture}}}"
        yield ("practice", "ask"), f"compares pairs; add what stands beside the stimulus, such as {example}"


def _pairs(protocol: Protocol) -> Iterator[Contradiction]:
    """Pairs that cannot be formed, orders they cannot have, and questions that are for pairs alone."""
    for place, questions in _pages(protocol):
        part = protocol.written_parts.get(str(place[1])) if len(place) > 1 else None
        for at, question in enumerate(questions):
            if isinstance(question, Prefer) and (part is None or part.pairs is None):
                yield (*place, at, question.kind), "is for a part with pairs, such as pairs: all"
    for part_id, part in protocol.written_parts.items():
        here: Location = ("parts", part_id, "pairs")
        if part.pairs is None:
            continue
        stimuli, pairs = protocol.stimuli_of(part_id), protocol.pairs_of(part_id)
        conditions = dict.fromkeys(stimulus.condition or "" for stimulus in stimuli)
        for at, two in enumerate(part.pairs):
            for side, condition in enumerate(two):
                yield from unknown(
                    (*here, at, side), condition, conditions, f"level or modulation in {part_id}"
                )
            if two[0] == two[1]:
                yield (*here, at), f"compares {two[0]} with itself"
            if {frozenset(two)} & set(map(frozenset, part.pairs[:at])):
                yield (*here, at), f"compares {two[0]} and {two[1]} a second time"
        in_pairs = {id_ for pair in pairs for id_ in pair.ids}
        if left_over := [stimulus.id for stimulus in stimuli if stimulus.id not in in_pairs]:
            yield here, f"leaves {', '.join(left_over)} without another to be compared with"
        if part.order.modulations or {"modulation", "level"} & set(part.order.max_run):
            yield ("parts", part_id, "order"), "goes by gestures or principles where pairs are compared"
        if part.order.levels:
            yield ("parts", part_id, "order", "levels"), "is for levels judged one by one; order `stimuli`"


def _ids(protocol: Protocol) -> Iterator[Contradiction]:
    taken = {PRACTICE: "the practice", BESIDE: "the practice"}
    for part_id in protocol.written_parts:
        for stimulus in protocol.stimuli_of(part_id):
            if stimulus.id in taken:
                yield (
                    ("parts", part_id, "stimuli"),
                    f"gives a stimulus the id {stimulus.id}, which {taken[stimulus.id]} has too; "
                    "add a prefix, such as {prefix: second_, gesture: …}",
                )
            taken[stimulus.id] = f"part {part_id}"


def _pages(protocol: Protocol) -> list[tuple[Location, tuple[Question, ...]]]:
    """The questions of every page, and where they stand."""
    asked = [(("parts", part_id, "ask"), part.ask) for part_id, part in protocol.written_parts.items()]
    return [*asked, (("demographics",), protocol.demographics)]


def _questions(protocol: Protocol) -> Iterator[Contradiction]:
    for here, questions in _pages(protocol):
        seen: set[str] = set()
        for at, question in enumerate(questions):
            for item in question.items:
                if item in seen:
                    yield (*here, at, question.kind), f"asks for {item} a second time on the page"
                seen.add(item)


def _conditions(protocol: Protocol) -> Iterator[Contradiction]:
    """Parts shown only after certain answers."""
    earlier = {item: question.values for question in protocol.demographics for item in question.items}
    for part_id, part in protocol.written_parts.items():
        for item, answers in part.only_if.items():
            here: Location = ("parts", part_id, "if", item)
            yield from unknown(here, item, earlier, "item asked before this part")
            for answer in answers if item in earlier else ():
                yield from unknown(here, answer, earlier[item] or (answer,), f"answer to {item}")
        earlier |= {item: question.values for question in part.ask for item in question.items}


def _attention(protocol: Protocol) -> Iterator[Contradiction]:
    """Attention checks on trials there are not, and more failures asked for than there are checks."""
    checks = sum(isinstance(question, Attention) for question in protocol.demographics)
    for part_id, part in protocol.written_parts.items():
        trials = part.order.shown(protocol.judged_in(part_id))
        for at, question in enumerate(part.ask):
            if not isinstance(question, Attention):
                continue
            checks += len(question.at or range(trials))
            for place, trial in enumerate(question.at or ()):
                if trial > trials:
                    here = ("parts", part_id, "ask", at, question.kind, "at", place)
                    yield here, f"is no trial of {part_id}, which has {trials}"
    needed = protocol.participants.exclude.failed_attention or 0
    if needed > checks:
        yield ("participants", "exclude", "failed_attention"), f"is more than the attention checks: {checks}"


def _files(protocol: Protocol) -> Iterator[Contradiction]:
    """Gestures and robots that would be missing from the copy kept of what participants began with."""
    for name, gesture in protocol.gestures.items():
        if leaves_the_folder(str(gesture.file)):
            yield ("gestures", name), LEAVES
    for robot in protocol.robots:
        files = protocol.files_of_robot(robot)  # none of a packaged one
        outside = next((file for file in files and (robot, *files) if leaves_the_folder(file)), None)
        if outside:
            needs = "" if outside == robot else f"needs {outside}, which "
            yield protocol.place_of_robot(robot), needs + LEAVES
            continue
        for name, remedy in bound_names(protocol.folder / robot, protocol.folder) if files else ():
            lost = f"names {name}, which in a copy of the study would lead elsewhere; {remedy}"
            yield protocol.place_of_robot(robot), lost
            break


def leaves_the_folder(name: str) -> bool:
    """Whether a path leads out of the folder it is seen from, or may."""
    return Path(name).is_absolute() or ".." in Path(name).parts


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
            if leaves_the_folder(text.root[language]):
                yield place, LEAVES
                continue
            try:
                file.read_text(encoding="utf-8")
            except OSError as error:
                yield place, f"cannot be read: {error.strerror}"
            except UnicodeDecodeError:
                yield place, "is not UTF-8; save the file with encoding UTF-8"
