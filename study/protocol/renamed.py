"""Names that files of another program are said to call otherwise, but the study does not have."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator

from stimuli.errors import nearest
from study.protocol.contradiction import Contradiction
from study.protocol.protocol import Protocol
from study.written import Location

COLUMNS = ("participant", "stimulus", "item", "response", "part", "trial", "rt_ms", "session")


def renamed(protocol: Protocol) -> Iterator[Contradiction]:
    """Names that files are said to call otherwise, but the study does not have."""
    said, here = protocol.analysis.responses, ("analysis", "responses")
    questions = {part: written.ask for part, written in protocol.written_parts.items()}
    stimuli = [judged.id for part in protocol.written_parts for judged in protocol.judged_in(part)]
    items = {item: question for asked in questions.values() for question in asked for item in question.items}
    answers = {f"{stimulus}.{item}" for stimulus in stimuli for item in items}
    columns = [column for column in said.columns if column not in answers]
    yield from _strange((*here, "columns"), columns, COLUMNS, "column, nor STIMULUS.ITEM")
    yield from _strange((*here, "stimuli"), said.stimuli, stimuli, "stimulus")
    yield from _strange((*here, "items"), said.items, items, "item")
    yield from _strange((*here, "answers"), said.answers, dict.fromkeys([*questions, *items]), "part or item")
    for of, codes in said.answers.items():
        asked = questions.get(of, ()) or ((items[of],) if of in items else ())
        known = [value for question in asked for value in question.values or ()]
        given = [answer for answer in codes if answer and asked]
        yield from _strange((*here, "answers", of), given, known, f"answer to {of}")


def _strange(
    place: Location, names: Iterable[str], known: Collection[str], what: str
) -> Iterator[Contradiction]:
    for name in names:
        if name not in known:
            yield place, f"{name!r} is no {what}; {nearest(name, known)}"
