"""One thing in a protocol that does not fit another."""

from __future__ import annotations

from collections.abc import Collection, Iterator

from stimuli.errors import nearest
from study.written import Location

Contradiction = tuple[Location, str]  # where, and what is wrong


def unknown(location: Location, name: str, known: Collection[str], what: str) -> Iterator[Contradiction]:
    """Say so where a name leads nowhere."""
    if name not in known:
        yield location, f"is no {what}; {nearest(name, known)}"
