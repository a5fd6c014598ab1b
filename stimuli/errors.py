"""Errors whose message is for the person at the keyboard: one text, exit code 1, no traceback."""

from __future__ import annotations

import difflib
from collections.abc import Iterable

LISTED = 40  # names at most, where none is near


class InputError(Exception):
    """Something the user gave cannot be used; the message names the place, the value and what would do."""


def closest(name: object, known: Iterable[str]) -> str | None:
    """The known name that was probably meant."""
    names = {each.lower(): each for each in known}
    close = difflib.get_close_matches(str(name).lower(), names, n=1, cutoff=0.6)
    return names[close[0]] if close else None


def nearest(name: object, known: Iterable[str]) -> str:
    """Say which of the known names was meant, if one is near, and otherwise list them all."""
    names = list(known)
    if meant := closest(name, names):
        return f"did you mean {meant}?"
    more = f" and {len(names) - LISTED} more" if len(names) > LISTED else ""
    return f"known: {', '.join(names[:LISTED])}{more}" if names else "none is defined"
