"""Changes to a study that has begun: refused unless declared, with a date and a reason, for all to read."""

from __future__ import annotations

import datetime
from collections.abc import Collection
from typing import TYPE_CHECKING, Annotated

from pydantic import Field, field_validator

from study.protocol.errors import Problem, ProtocolError
from study.written import Written, wrong

if TYPE_CHECKING:
    from study.protocol.protocol import Protocol

SHORT = 12  # characters of a hash that are enough to know it by


class Amendment(Written):
    """One declared change: what it replaces, when and why."""

    date: datetime.date
    reason: Annotated[str, Field(min_length=1)]
    replaces: Annotated[str, Field(pattern=r"^[0-9a-f]{12,64}$")]  # hash of the protocol before the change

    @field_validator("date", mode="before")
    @classmethod
    def _date(cls, value: object) -> object:
        try:
            return datetime.date.fromisoformat(str(value))
        except ValueError:
            raise wrong("must be a date, such as 2026-11-22") from None


def check(protocol: Protocol, known_hashes: Collection[str]) -> None:
    """Refuse to go on with participants of another protocol, unless an amendment says why it was changed.

    `known_hashes` are those of the protocols that the participants so far took part in.
    """
    declared = tuple(amendment.replaces for amendment in protocol.amendments)
    others = sorted(known for known in known_hashes if known != protocol.sha256)
    problems = [
        Problem(
            protocol.path,
            None,
            None,
            "",
            f"has changed since participants took part in {known[:SHORT]}. Take the change back, gather the "
            "new data elsewhere (--data), or declare it:\n"
            f"amendments:\n  - {{date: <today>, reason: <why>, replaces: {known[:SHORT]}}}",
        )
        for known in others
        if not known.startswith(declared)
    ]
    if problems:
        raise ProtocolError(problems)
