"""What people write by hand: the base of every model read from a protocol, and quantities with their unit."""

from __future__ import annotations

import difflib
import re
from collections.abc import Iterable
from typing import Annotated, Any

from pydantic import BaseModel, BeforeValidator, ConfigDict, ValidationError, WithJsonSchema, model_validator
from pydantic.functional_validators import ModelWrapValidatorHandler
from pydantic_core import InitErrorDetails, PydanticCustomError
from typing_extensions import Self


def nearest(name: object, known: Iterable[str]) -> str:
    """Say which of the known names was meant, if one is near, and otherwise list them all."""
    names = list(known)
    close = difflib.get_close_matches(str(name).lower(), [n.lower() for n in names], n=1, cutoff=0.6)
    if close:
        meant = next(n for n in names if n.lower() == close[0])
        return f"did you mean {meant}?"
    return "known: " + ", ".join(names) if names else "none is defined"


def wrong(message: str) -> PydanticCustomError:
    """Make an error for a validator to raise, worded for the person who wrote the file."""
    return PydanticCustomError("wrong", "{message}", {"message": message})


def wrong_at(location: tuple[str | int, ...], message: str, value: object) -> ValidationError:
    """Make an error for a validator to raise about something inside the value it was given."""
    return ValidationError.from_exception_data(
        "protocol", [InitErrorDetails(type=wrong(message), loc=location, input=value)]
    )


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
            raise ValidationError.from_exception_data(
                error.title,
                [
                    InitErrorDetails(
                        type=PydanticCustomError(
                            detail["type"], "{message}", {"message": _message(detail, fields)}
                        ),
                        loc=detail["loc"],
                        input=detail["input"],
                    )
                    for detail in error.errors(include_url=False)
                ],
            ) from None


def _message(detail: Any, fields: list[str]) -> str:
    """Reword pydantic's message where it speaks of Python rather than of the file."""
    if len(detail["loc"]) == 1 and detail["type"] == "extra_forbidden":
        return f"is no field here; {nearest(detail['loc'][0], fields)}"
    reworded = {
        "missing": "is missing",
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
    message: str = detail["msg"]
    return message.replace("Input should be", "must be")


_SECONDS = {"ms": 0.001, "s": 1.0, "min": 60.0, "h": 3600.0}


def _seconds(value: object) -> float:
    """Read `0.5 s`, `800 ms`, `2 min` or `1 h` as seconds."""
    match = re.fullmatch(r"\s*(\d+(?:\.\d+)?)\s*(ms|s|min|h)\s*", str(value))
    if not match:
        raise wrong("must be a time with its unit, such as 0.5 s, 800 ms or 2 min")
    return float(match[1]) * _SECONDS[match[2]]


Seconds = Annotated[
    float,
    BeforeValidator(_seconds),
    WithJsonSchema({"type": "string", "pattern": r"^\s*\d+(\.\d+)?\s*(ms|s|min|h)\s*$"}),
]
