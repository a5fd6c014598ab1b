"""YAML as it is written: values with their places, and nothing a study could be surprised by.

Read from the parser's events, so that hostile input ends in one message: no tags, no anchors (and so no alias
bombs), no repeated keys, one document, bounded size and depth. Plain words are read as in YAML 1.2: only
`true` and `false` are logical, so `no` can be a language and `on` a name.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NoReturn

import yaml

from study.protocol.errors import Problem, ProtocolError
from study.written import Location

MAX_BYTES = 256 * 1024
MAX_DEPTH = 24
_SHOWN = 60  # characters of a value quoted in a message


@dataclass(frozen=True)
class Source:
    """One file's content as plain values, and the line and column of each, counted from 1."""

    path: Path
    value: Any
    places: dict[Location, tuple[int, int]]  # of values
    key_places: dict[Location, tuple[int, int]]  # of the names in front of them

    def problem(self, location: Sequence[str | int], message: str, *, name: bool = False) -> Problem:
        """Say what is wrong at a location, or as near to it as the file goes.

        Elements that are not in the file (a missing field, the branch of a choice) are passed over. `name`:
        the field's name is at fault, not its value.
        """
        found: Location = ()
        rest: Location = ()
        for element in location:
            if (*found, element) in self.places and (found or not rest):
                found, rest = (*found, element), ()
            else:
                rest = (*rest, element)
        if rest and not isinstance(self._value_at(found), (dict, list)):
            rest = ()  # a plain value where a mapping could stand: the value itself is at fault
        at_name = name or bool(rest)
        line, column = (self.key_places if at_name else self.places).get(found) or self.places[found]
        value = "" if at_name else self._quoted(found)
        return Problem(self.path, line, column, written((*found, *rest)), value + message)

    def _value_at(self, location: Location) -> Any:
        value = self.value
        for element in location:
            value = value[element]
        return value

    def _quoted(self, location: Location) -> str:
        value = self._value_at(location)
        if isinstance(value, (dict, list)) or value is None:
            return ""
        text = str(value)
        return f"'{text if len(text) <= _SHOWN else text[:_SHOWN] + '…'}' "


def written(location: Sequence[str | int]) -> str:
    """Write a location as `parts.recognition.ask[0].rate`."""
    return "".join(f"[{e}]" if isinstance(e, int) else f".{e}" for e in location).lstrip(".")


def read_source(path: Path) -> Source:
    """Read a YAML file. Raises ProtocolError."""
    return _Reader(path, _read_text(path)).read()


def _fail(path: Path, message: str, line: int | None = None, column: int | None = None) -> NoReturn:
    raise ProtocolError([Problem(path, line, column, "", message)])


def _read_text(path: Path) -> str:
    try:
        with path.open("rb") as file:
            content = file.read(MAX_BYTES + 1)
    except OSError as error:
        _fail(path, f"cannot be read: {error.strerror}")
    if len(content) > MAX_BYTES:
        _fail(path, f"is larger than {MAX_BYTES // 1024} KiB, which no protocol needs")
    try:
        text = content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = content[: error.start].count(b"\n") + 1
        _fail(path, "is not UTF-8 here; save the file with encoding UTF-8", line)
    return text


class _Reader:
    """Builds values from the parser's events and notes where each stood."""

    def __init__(self, path: Path, text: str) -> None:
        self.path = path
        self.text = text
        self.places: dict[Location, tuple[int, int]] = {}
        self.key_places: dict[Location, tuple[int, int]] = {}

    def read(self) -> Source:
        try:
            events = iter(yaml.parse(self.text, Loader=yaml.CSafeLoader))
            value = self._document(events)
        except yaml.MarkedYAMLError as error:
            mark = error.context_mark if _lacks_value(error) else error.problem_mark or error.context_mark
            line, column = (mark.line + 1, mark.column + 1) if mark else (1, 1)
            _fail(self.path, _plainly(error, self.text), line, column)
        except yaml.reader.ReaderError as error:
            line = self.text.count("\n", 0, error.position) + 1
            _fail(self.path, f"holds the character U+{int(error.character):04X}, which is not text", line)
        return Source(self.path, value, self.places, self.key_places)

    def _document(self, events: Iterator[yaml.Event]) -> Any:
        next(events)
        if not isinstance(next(events), yaml.DocumentStartEvent):
            _fail(self.path, "is empty; `study new` writes a protocol to start from")
        value = self._value(next(events), events, ())
        next(events)
        after = next(events)
        if not isinstance(after, yaml.StreamEndEvent):
            self._refuse(after, "a second document begins; a protocol is one document, without '---' inside")
        if not isinstance(value, dict):
            _fail(self.path, "must be a mapping (name: value) from the first line on", 1, 1)
        return value

    def _value(self, event: yaml.Event, events: Iterator[yaml.Event], at: Location) -> Any:
        self.places[at] = _place(event)
        if isinstance(event, yaml.AliasEvent) or getattr(event, "anchor", None):
            self._refuse(event, "anchors (&) and aliases (*) are not used in protocols; write it out")
        if getattr(event, "tag", None):
            self._refuse(event, "tags (!) are not used in protocols; quote text that begins with !")
        if isinstance(event, yaml.ScalarEvent):
            return self._scalar(event)
        if len(at) >= MAX_DEPTH:
            self._refuse(event, f"is nested more than {MAX_DEPTH} deep")
        if isinstance(event, yaml.SequenceStartEvent):
            return self._list(events, at)
        return self._mapping(events, at)

    def _list(self, events: Iterator[yaml.Event], at: Location) -> list[Any]:
        values: list[Any] = []
        while not isinstance(event := next(events), yaml.SequenceEndEvent):
            values.append(self._value(event, events, (*at, len(values))))
        return values

    def _mapping(self, events: Iterator[yaml.Event], at: Location) -> dict[str, Any]:
        values: dict[str, Any] = {}
        while not isinstance(event := next(events), yaml.MappingEndEvent):
            if not isinstance(event, yaml.ScalarEvent) or getattr(event, "tag", None) or event.anchor:
                self._refuse(event, "a name must be plain text")
            key = event.value
            if key == "<<":
                self._refuse(event, "merging (<<) is not used in protocols; write it out, or use extends")
            if key in values:
                line, _ = self.key_places[(*at, key)]
                self._refuse(event, f"{written((*at, key))} is given twice; first in line {line}")
            self.key_places[(*at, key)] = _place(event)
            values[key] = self._value(next(events), events, (*at, key))
        return values

    def _scalar(self, event: yaml.ScalarEvent) -> Any:
        text = event.value
        if event.style:  # quoted, or a block of text
            return text
        if text in {"", "~", "null"}:
            return None
        if text in {"true", "false"}:
            return text == "true"
        if re.fullmatch(r"[-+]?\d{19,}", text):
            self._refuse(event, "has more digits than any number of a study")
        if re.fullmatch(r"[-+]?\d+", text):
            return int(text)
        if re.fullmatch(r"[-+]?(\d+\.\d*|\.?\d+)([eE][-+]?\d+)?", text) and abs(float(text)) < float("inf"):
            return float(text)
        if re.fullmatch(r"[-+]?\.?(nan|inf)", text, re.IGNORECASE):
            self._refuse(event, f"{text} is no number a study can use")
        return text

    def _refuse(self, event: yaml.Event, message: str) -> NoReturn:
        _fail(self.path, message, *_place(event))


def _place(event: yaml.Event) -> tuple[int, int]:
    mark = event.start_mark
    return (mark.line + 1, mark.column + 1) if mark else (1, 1)


def _lacks_value(error: yaml.MarkedYAMLError) -> bool:
    """Whether a name stands there without its value."""
    return error.context == "while scanning a simple key" and error.context_mark is not None


def _plainly(error: yaml.MarkedYAMLError, text: str) -> str:
    """Say what is wrong with the YAML in words that tell what to do."""
    mark = error.problem_mark
    lines = text.splitlines()
    if mark and mark.line < len(lines) and "\t" in lines[mark.line][: mark.column + 1]:
        return "a tab indents this line; indent with spaces"
    if _lacks_value(error):
        return "is a name without a value; after a name come a colon, a space and its value"
    return (
        f"is not YAML: {error.problem or error.context}; look at the indentation, colons and brackets here, "
        'and put text with any of , : ? # [ ] { } into "quotes"'
    )
