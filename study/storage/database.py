"""What the store needs of a kind of database."""

from __future__ import annotations

import os
import socket
from collections.abc import Callable
from contextlib import AbstractContextManager
from dataclasses import dataclass

from pydantic_core import to_json
from sqlalchemy import Engine

from stimuli.errors import InputError


@dataclass(frozen=True)
class Database:
    """An open database, and what each kind does in a way of its own."""

    engine: Engine
    held: Callable[[], AbstractContextManager[object]]  # by this server, or ServedByAnotherError says by whom
    purge: Callable[[], None]  # leave no trace of rows that were deleted


class ServedByAnotherError(InputError):
    """Another server holds the database."""


def holder() -> str:
    """How this process names itself to another that wants the same database."""
    return f"process {os.getpid()} on {socket.gethostname()}"


def as_json(value: object) -> str:
    """What a column of JSON keeps: answers and views as they are, without a copy in between."""
    return to_json(value).decode()
