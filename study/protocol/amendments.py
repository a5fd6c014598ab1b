"""Declared changes to a study that has begun, each with a date and a reason, for all to read."""

from __future__ import annotations

import datetime
import re
from typing import Annotated

from pydantic import Field, field_validator

from study.written import A_HASH, Written, wrong

SHORT = 12  # characters of a hash that are enough to know it by


def as_replaced(sha256: str) -> str:
    """A protocol's hash as `replaces` has it: short, and quoted where YAML would take it for a number."""
    short = sha256[:SHORT]
    return f'"{short}"' if re.fullmatch(r"\d+(e\d+)?", short) else short


class Amendment(Written):
    """One declared change: what it replaces, when and why."""

    date: datetime.date
    reason: Annotated[str, Field(min_length=1)]
    replaces: Annotated[str, Field(pattern=A_HASH)]  # hash of the protocol before the change

    @field_validator("date", mode="before")
    @classmethod
    def _date(cls, value: object) -> object:
        try:
            return datetime.date.fromisoformat(str(value))
        except ValueError:
            raise wrong("must be a date, such as 2026-11-22") from None
