"""What commands share: the application, options, reading a protocol, rendering, and printing."""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

import typer
from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

if TYPE_CHECKING:
    from stimuli.manifest import Manifest
    from study.protocol import Protocol

app = typer.Typer(
    help="Studies of expressive robot motion: from one protocol file to stimuli, sessions and statistics.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    rich_markup_mode="rich",
)
console = Console(highlight=False, soft_wrap=True)

ProtocolPath = Annotated[Path, typer.Argument(metavar="PROTOCOL", help="Protocol folder, or its YAML file.")]
Out = Annotated[Path, typer.Option("--out", help="Folder to write into.")]
AsJson = Annotated[bool, typer.Option("--json", help="Print the answer as JSON, for programs.")]
Clips = Annotated[
    Path | None, typer.Option("--clips", help="Folder of the clips; PROTOCOL/stimuli unless told.")
]
Data = Annotated[
    Path | None, typer.Option("--data", help="Folder of the answers; PROTOCOL/data unless told.")
]
Database = Annotated[str | None, typer.Option(help="Database URL; SQLite in the data folder unless told.")]
DoorOption = Annotated[
    Literal["open", "link", "kiosk"],
    typer.Option("--door", help="Who may begin: anybody; only who is invited; or, in a laboratory, by key."),
]
Port = Annotated[
    int, typer.Option("--port", min=0, max=65535, help="Where to listen; 0 for any that is free.")
]
Workers = Annotated[
    int | None, typer.Option("--workers", min=1, help="Processes that render; one per core unless told.")
]
Scheduler = Annotated[
    str | None,
    typer.Option("--scheduler", metavar="ADDRESS", help="Dask cluster that renders: tcp://host:port."),
]


def load(path: Path) -> Protocol:
    """Read the protocol a command was given."""
    from study.protocol import load_protocol

    return load_protocol(path)


def rendered(protocol: Protocol, folder: Path, workers: int | None, scheduler: str | None = None) -> Manifest:
    """The manifest of a folder of clips, after rendering those missing with a progress bar."""
    from stimuli.library import Progress as Rendered
    from stimuli.library import render_missing
    from stimuli.robots import load_robot
    from study.specs import specs

    wanted = specs(protocol)
    robots = {spec.robot: load_robot(spec.robot, protocol.folder) for spec in wanted.values()}
    try:
        with progress("rendering", None) as advance:

            def told(rendered: Rendered) -> None:
                advance(rendered.done + rendered.under_way, rendered.total)

            return render_missing(
                list(wanted.values()),
                robots,
                folder,
                workers=workers,
                scheduler=scheduler,
                progress=told,
            )
    except KeyboardInterrupt:
        console.print(
            "Stopped. Finished clips are kept, nothing is half written; the next run goes on from there."
        )
        raise typer.Exit(130) from None


@contextmanager
def progress(what: str, total: int | None) -> Iterator[Any]:
    """A progress bar for as long as the block lasts; gives the function that says how far it is."""
    columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TimeRemainingColumn())
    screen = Console(stderr=True)
    with Progress(*columns, console=screen, transient=True, disable=not screen.is_terminal) as shown:
        task = shown.add_task(what, total=total)
        yield lambda done, of=None: shown.update(task, completed=done, total=of or total)


def print_json(value: Any) -> None:
    """Print for programs."""
    sys.stdout.write(json.dumps(value, indent=2, ensure_ascii=False) + "\n")
