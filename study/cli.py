"""The command line: the one place where motion, sessions and analysis are put together.

Every command reads as: load the protocol, call the stage, say what came out. Heavy stages are imported inside their
command, so that `study --help` and `study analyse` never wait for MuJoCo.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

from stimuli.errors import InputError

if TYPE_CHECKING:
    from stimuli.manifest import Manifest
    from study.protocol import Protocol

app = typer.Typer(
    name="study",
    help="Expressive robot motion studies: one protocol file to stimuli, sessions and statistics.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    rich_markup_mode="rich",
)
console = Console(highlight=False)

ProtocolPath = Annotated[Path, typer.Argument(metavar="PROTOCOL", help="Protocol folder, or its YAML file.")]
AsJson = Annotated[bool, typer.Option("--json", help="Print the answer as JSON, for programs.")]
Out = Annotated[Path, typer.Option("--out", help="Folder to write into.")]


def main() -> None:
    """Run the command line; a fault in the user's input is one message and exit code 1."""
    try:
        app()
    except InputError as fault:
        Console(stderr=True, highlight=False, soft_wrap=True).print(f"[red]study:[/red] {fault}", markup=True)
        sys.exit(1)
