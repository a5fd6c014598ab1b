"""Answers recorded by another program: what its files call the names of a protocol."""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import BeforeValidator, Field

from study.written import Written


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
