"""Errors whose message is for the person at the keyboard: one text, exit code 1, no traceback."""

from __future__ import annotations


class InputError(Exception):
    """Something the user gave cannot be used; the message names the place, the value and what would do."""
