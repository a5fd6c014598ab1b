"""Answers recorded by another program: what its files call the names of a protocol."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator
from typing import TYPE_CHECKING, Annotated, Any

from pydantic import BeforeValidator, Field

from stimuli.errors import nearest
from study.protocol.contradiction import Contradiction
from study.written import Location, Written

if TYPE_CHECKING:
    from study.protocol.protocol import Protocol

COLUMNS = ("participant", "stimulus", "item", "response", "part", "trial", "rt_ms", "session")


def _plain(value: Any) -> Any:
    """Read a number as the text that stands in the file."""
    if isinstance(value, (int, float)) and not isinstance(value, bool):
        return str(value)
    return value


def _codes(value: Any) -> Any:
    return [_plain(code) for code in value] if isinstance(value, list) else [_plain(value)]


Name = Annotated[str, BeforeValidator(_plain, json_schema_input_type=str | float)]
Codes = Annotated[
    tuple[str, ...], BeforeValidator(_codes, json_schema_input_type=str | float | list[str | float])
]


class Recorded(Written):
    """What a file calls what, each as `OURS: THEIRS`."""

    columns: dict[str, Name] = Field(default_factory=dict)  # or STIMULUS.ITEM; "" leaves a column out
    stimuli: dict[str, Name] = Field(default_factory=dict)
    items: dict[str, Name] = Field(default_factory=dict)
    answers: dict[str, dict[Name, Codes]] = Field(default_factory=dict)  # of a part or an item; "" is none


def recorded(protocol: Protocol) -> Iterator[Contradiction]:
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
