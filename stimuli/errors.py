"""Errors whose message is for the person at the keyboard: one text, exit code 1, no traceback."""

from __future__ import annotations

import difflib
from collections.abc import Iterable

LISTED = 40  # names at most, where none is near


class InputError(Exception):
    """Something the user gave cannot be used; the message names the place, the value and what would do."""


def nearest(name: object, known: Iterable[str]) -> str:
    """Say which of the known names was meant, if one is near, and otherwise list them all."""
    names = list(known)
    close = difflib.get_close_matches(str(name).lower(), [n.lower() for n in names], n=1, cutoff=0.6)
    if close:
        meant = next(n for n in names if n.lower() == close[0])
        return f"did you mean {meant}?"
    more = f" and {len(names) - LISTED} more" if len(names) > LISTED else ""
    return f"known: {', '.join(names[:LISTED])}{more}" if names else "none is defined"
