"""What people write by hand: the base of every model read from a protocol, and quantities with their unit."""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import Annotated, Any, Self

from pydantic import BaseModel, BeforeValidator, ConfigDict, ValidationError, WithJsonSchema, model_validator
from pydantic.functional_validators import ModelWrapValidatorHandler
from pydantic_core import ErrorDetails, InitErrorDetails, PydanticCustomError

from stimuli.errors import nearest

Location = tuple[str | int, ...]  # keys and indices from the top of a value to something in it


A_NAME = r"^[A-Za-z][A-Za-z0-9_-]*$"
AN_ITEM = r"^[a-z][a-z0-9_]*$"
A_HYPOTHESIS = r"^[A-Za-z][A-Za-z0-9_.-]*$"
A_LANGUAGE = r"^[a-z]{2,3}(-[A-Z]{2})?$"
A_SIZE = r"^[1-9]\d{1,3}x[1-9]\d{1,3}$"
A_HASH = r"^[0-9a-f]{12,64}$"

_SHAPES = {  # what to say of text that does not match
    A_NAME: "must begin with a letter from a to z, with letters, digits, - and _ after it",
    AN_ITEM: "must begin with a small letter from a to z, with small letters, digits and _ after it",
    A_HYPOTHESIS: "must begin with a letter from a to z, with letters, digits, . - and _ after it",
    A_LANGUAGE: "must be a language's code, such as en, de or pt-BR",
    A_SIZE: "must be width and height in pixels, such as 1280x720",
    A_HASH: "must be the first 12 or more characters of a protocol's hash, as the server's refusal has them",
}

_MEANT = {  # what others call it
    "counterbalanced": "williams",
    "fdr": "benjamini-hochberg",
    "holm-bonferroni": "holm",
    "likert": "rate",
    "random": "shuffled",
    "randomised": "shuffled",
    "randomized": "shuffled",
    "vas": "slider",
}

NAME = "name"  # type of errors about a field's name rather than its value

_KEY = "[key]"  # Pydantic's way to say that a name is at fault


def wrong(message: str, kind: str = "value") -> PydanticCustomError:
    """Make an error for a validator to raise, worded for the person who wrote the file."""
    return PydanticCustomError(kind, "{message}", {"message": message})


def wrong_at(location: Location, message: str, value: object, kind: str = "value") -> ValidationError:
    """Make an error for a validator to raise about something inside the value it was given."""
    return refusal([InitErrorDetails(type=wrong(message, kind), loc=location, input=value)])


def refusal(errors: list[InitErrorDetails]) -> ValidationError:
    """Make one error of several."""
    return ValidationError.from_exception_data("protocol", errors)


def relocated(error: ValidationError, before: Location, *, drop: int = 0) -> list[InitErrorDetails]:
    """The errors of a value, placed where that value stands: `before` takes the place of `drop` elements."""
    return [
        InitErrorDetails(
            type=wrong(detail["msg"], detail["type"]),
            loc=(*before, *detail["loc"][drop:]),
            input=detail["input"],
        )
        for detail in error.errors(include_url=False)
    ]


class Written(BaseModel):
    """A mapping in a protocol: frozen, and unknown fields are refused by naming the nearest known one."""

    model_config = ConfigDict(frozen=True, extra="forbid", populate_by_name=True, allow_inf_nan=False)

    @model_validator(mode="wrap")
    @classmethod
    def _say_which_field_was_meant(cls, data: Any, handler: ModelWrapValidatorHandler[Self]) -> Self:
        try:
            return handler(data)
        except ValidationError as error:
            fields = [field.alias or name for name, field in cls.model_fields.items()]
            raise refusal(reworded(error, fields)) from None


def _telling(error: ValidationError) -> list[ErrorDetails]:
    """The errors, without the one that a list is too short because its elements were refused."""
    details = error.errors(include_url=False)
    refused = {detail["loc"][:end] for detail in details for end in range(len(detail["loc"]))}
    return [d for d in details if not (d["type"] == "too_short" and d["loc"] in refused)]


def reworded(error: ValidationError, fields: Iterable[str]) -> list[InitErrorDetails]:
    """The errors of a mapping with these fields, in words about the file rather than about Python."""
    return [_reworded(detail, fields) for detail in _telling(error)]


def _reworded(detail: ErrorDetails, fields: Iterable[str]) -> InitErrorDetails:
    at = detail["loc"]
    of_name = bool(at) and at[-1] == _KEY
    kind = NAME if of_name or detail["type"] in {NAME, "extra_forbidden", "missing"} else "value"
    place = at[:-1] if of_name else at
    return {"type": wrong(_message(detail, fields), kind), "loc": place, "input": detail["input"]}


def meant(name: object, known: Iterable[str]) -> str:
    """Say which of the known names was meant, also by who knows it under another."""
    return nearest(_MEANT.get(str(name).lower(), name), known)


_WORDS = {  # by Pydantic's types of errors, which speak of Python rather than of the file
    "missing": "is missing",
    "string_too_short": "must not be empty",
    "string_too_long": "must have no more than {max_length} characters",
    "too_long": "must have no more than {max_length}",
    "model_type": "must be a mapping (name: value)",
    "dict_type": "must be a mapping (name: value)",
    "int_type": "must be a whole number",
    "int_from_float": "must be a whole number",
    "int_parsing": "must be a whole number",
    "float_type": "must be a number",
    "float_parsing": "must be a number",
    "bool_type": "must be true or false",
    "bool_parsing": "must be true or false",
    "none_required": "must be left empty",
    "greater_than": "must be more than {gt:g}",
    "less_than": "must be less than {lt:g}",
    "greater_than_equal": "must be at least {ge:g}",
    "less_than_equal": "must be at most {le:g}",
}


def _message(detail: ErrorDetails, fields: Iterable[str]) -> str:
    """What is wrong with a value, and what would do."""
    kind, given, bounds = detail["type"], detail["input"], detail.get("ctx", {})
    if len(detail["loc"]) == 1 and kind == "extra_forbidden":
        return f"is no field here; {nearest(detail['loc'][0], fields)}"
    message = _WORDS.get(kind, "").format(**bounds)
    if kind == "literal_error":
        names = re.findall(r"'([^']*)'", bounds["expected"])
        message = f"will not do; {meant(given, names)}"
    elif kind == "string_type":
        message = 'must be text; put it into "quotes"' if isinstance(given, (int, float)) else "must be text"
    elif kind in {"list_type", "tuple_type"}:
        message = f"must be a list, such as [{given}]" if isinstance(given, str) else "must be a list"
    elif kind == "too_short":
        least = bounds["min_length"]
        message = "must not be empty" if least == 1 else f"needs at least {least}"
    elif kind == "string_pattern_mismatch":
        message = _SHAPES[bounds["pattern"]]
    return message or detail["msg"].removeprefix("Value error, ")


_SECONDS = {"ms": 0.001, "s": 1.0, "min": 60.0, "h": 3600.0, "d": 86_400.0}


def _seconds(value: object) -> float:
    """Read `0.5 s`, `800 ms`, `2 min`, `1 h` or `14 d` as seconds."""
    match = re.fullmatch(r"\s*(\d+(?:\.\d+)?)\s*(ms|s|min|h|d)\s*", str(value))
    if not match:
        raise wrong("must be a time with its unit, such as 0.5 s, 800 ms or 2 min")
    return float(match[1]) * _SECONDS[match[2]]


Seconds = Annotated[
    float,
    BeforeValidator(_seconds),
    WithJsonSchema({"type": "string", "pattern": r"^\s*\d+(\.\d+)?\s*(ms|s|min|h|d)\s*$"}),
]
