"""The command line: the one place where motion, sessions and analysis are put together.

Every command reads as: load the protocol, call the stage, say what came out. Stages are imported inside their
command, so that `study --help` and `study analyse` never wait for MuJoCo.
"""

from __future__ import annotations

import sys
from typing import NoReturn

from rich.console import Console
from rich.markup import escape

from stimuli.errors import InputError
from study.cli import pictures, planning, results, sessions  # each adds its commands
from study.cli.command import app

__all__ = ["app", "main", "pictures", "planning", "results", "sessions"]


def main() -> None:
    """Run the command line; a fault in the user's input, or of their disk, is one message and exit code 1."""
    try:
        app()
    except InputError as fault:
        _refuse(str(fault))
    except OSError as fault:  # not there, not allowed, no room
        _refuse(f"{fault.filename}: {fault.strerror}" if fault.filename else fault.strerror or str(fault))


def _refuse(message: str) -> NoReturn:
    Console(stderr=True, highlight=False, soft_wrap=True).print(f"[red bold]study:[/] {escape(message)}")
    sys.exit(1)
