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


NAME = "name"  # type of errors about a field's name rather than its value


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
    kind = NAME if detail["type"] in {NAME, "extra_forbidden", "missing"} else "value"
    return {"type": wrong(_message(detail, fields), kind), "loc": detail["loc"], "input": detail["input"]}


def _message(detail: ErrorDetails, fields: Iterable[str]) -> str:
    """Reword pydantic's message where it speaks of Python rather than of the file."""
    if len(detail["loc"]) == 1 and detail["type"] == "extra_forbidden":
        return f"is no field here; {nearest(detail['loc'][0], fields)}"
    reworded = {
        "missing": "is missing",
        "too_short": "must not be empty",
        "string_too_short": "must not be empty",
        "model_type": "must be a mapping (name: value)",
        "dict_type": "must be a mapping (name: value)",
        "list_type": "must be a list",
        "tuple_type": "must be a list",
        "string_type": "must be text",
        "int_type": "must be a whole number",
        "int_from_float": "must be a whole number",
        "int_parsing": "must be a whole number",
        "float_type": "must be a number",
        "float_parsing": "must be a number",
        "bool_type": "must be true or false",
        "bool_parsing": "must be true or false",
        "none_required": "must be left empty",
    }
    if detail["type"] in reworded:
        return reworded[detail["type"]]
    if detail["type"] == "literal_error":
        names = re.findall(r"'([^']*)'", detail["ctx"]["expected"])
        return f"will not do; {nearest(detail['input'], names)}"
    return (
        detail["msg"]
        .removeprefix("Value error, ")
        .replace("Input should be", "must be")
        .replace("String should", "must")
    )


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
