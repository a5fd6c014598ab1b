"""Texts that are seen in a study but not written in one of its languages."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from pydantic import BaseModel

from study.protocol import Problem, Protocol
from study.text import ANY, Text
from study.words import listed
from study.written import Location


def untranslated(protocol: Protocol) -> list[Problem]:
    """What is missing in which language: a protocol's own texts at their places, shipped ones together."""
    source, seen = protocol.source, protocol.languages
    lacking = {place: missing for place, text in _seen(protocol) if (missing := text.lacks(seen))}
    problems = [
        source.problem(place, f"is missing in {listed(missing)}", name=True)
        for place, missing in lacking.items()
        if place[:2] in source.places
    ]
    if shipped := {place: missing for place, missing in lacking.items() if place[:2] not in source.places}:
        names = dict.fromkeys(str(place[1] if place[0] == "texts" else place[0]) for place in shipped)
        languages = sorted({language for missing in shipped.values() for language in missing})
        message = f"{listed(names)} come in English and German; write your own for {listed(languages)}"
        problems.append(source.problem(("texts",), message, name=True))
    return problems


def unseen_languages(protocol: Protocol) -> list[str]:
    """The languages in which the protocol has texts that nobody sees, as the study is not in them."""
    own = (text for place, text in _seen(protocol) if place[:2] in protocol.source.places)
    return sorted({language for text in own for language in text.root} - {ANY, *protocol.languages})


def _seen(protocol: Protocol) -> Iterator[tuple[Location, Text]]:
    """Every text that somebody sees, and where it stands."""
    yield ("title",), protocol.title
    if protocol.video.description:
        yield ("video", "description"), protocol.video.description
    introducing = [part.intro for part in protocol.parts.values()]
    for name, text in protocol.texts:
        practice = name == "practice" and protocol.practice is not None
        if name in {"consent", "debrief"} or practice or any(text is intro for intro in introducing):
            yield ("texts", name), text
    for at, question in enumerate(protocol.demographics):
        yield from _texts_in(question, ("demographics", at, question.kind))
    for part_id, part in protocol.parts.items():
        yield ("parts", part_id, "title"), part.title
        if protocol.written_parts[part_id].intro:
            yield ("parts", part_id, "intro"), part.intro
        for at, question in enumerate(part.questions):
            yield from _texts_in(question, ("parts", part_id, "ask", at, question.kind))


def _texts_in(value: Any, location: Location) -> Iterator[tuple[Location, Text]]:
    """All texts inside a question, wherever its kind keeps them."""
    if isinstance(value, Text):
        yield location, value
    elif isinstance(value, BaseModel):
        for name, field in type(value).model_fields.items():
            yield from _texts_in(getattr(value, name), (*location, field.alias or name))
    elif isinstance(value, dict):
        for key, inner in value.items():
            yield from _texts_in(inner, (*location, key))
    elif isinstance(value, tuple):
        for at, inner in enumerate(value):
            yield from _texts_in(inner, (*location, at))
