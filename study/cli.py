"""The command line: the one place where motion, sessions and analysis are put together.

Every command reads as: load the protocol, call the stage, say what came out. Stages are imported inside their
command, so that `study --help` and `study analyse` never wait for MuJoCo.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

import typer
from rich.console import Console
from rich.markup import escape
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn
from rich.table import Table

from stimuli.errors import InputError

if TYPE_CHECKING:
    from stimuli.manifest import Manifest
    from study.protocol import Protocol
    from study.web import Links

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
Workers = Annotated[
    int | None, typer.Option("--workers", min=1, help="Processes that render; one per core unless told.")
]
Scheduler = Annotated[
    str | None,
    typer.Option("--scheduler", metavar="ADDRESS", help="Dask cluster that renders: tcp://host:port."),
]


def main() -> None:
    """Run the command line; a fault in the user's input is one message and exit code 1."""
    try:
        app()
    except InputError as fault:
        Console(stderr=True, highlight=False, soft_wrap=True).print(
            f"[red bold]study:[/] {escape(str(fault))}"
        )
        sys.exit(1)


@app.command()
def new(folder: Annotated[Path, typer.Argument(metavar="FOLDER", help="Where the study is to be.")]) -> None:
    """Write a new study from the template; it runs as it is."""
    from study.new import new_study

    protocol = new_study(folder)
    console.print(f"{protocol} is written. Change it, then: study check {folder}, and: study run {folder}")


@app.command()
def check(path: ProtocolPath, as_json: AsJson = False) -> None:
    """Check everything that can be known before the first participant comes."""
    from study.check import check as check_protocol

    with console.status("checking …"):
        report = check_protocol(_load(path))
    if as_json:
        _print_json(report.as_json())
    else:
        console.print(escape(str(report)))
    raise typer.Exit(0 if report.good else 1)


@app.command()
def preview(
    path: ProtocolPath,
    stimuli: Annotated[
        list[str] | None, typer.Argument(metavar="[STIMULUS …]", help="All unless told.")
    ] = None,
    clips: Clips = None,
    out: Annotated[Path | None, typer.Option("--out", help="Folder; CLIPS/preview unless told.")] = None,
) -> None:
    """Draw a contact sheet of the clips and describe their motion.

    Of stimuli named, also a poster and the joints' curves, and two or more side by side in one clip.
    """
    from stimuli.manifest import Manifest
    from stimuli.preview import draw_preview
    from stimuli.robots import load_robot

    protocol = _load(path)
    folder = clips or protocol.folder / "stimuli"
    manifest = Manifest.load(folder)
    names = {clip.spec["robot"] for clip in manifest.clips.values()}
    robots = {name: load_robot(name, protocol.folder) for name in names}
    with console.status("drawing …"):
        drawn = draw_preview(
            manifest, folder, out or folder / "preview", stimuli=stimuli or (), robots=robots
        )
    console.print(_descriptors(manifest, stimuli))
    console.print("\n".join(f"{file}" for file in drawn))


def _descriptors(manifest: Manifest, stimuli: Sequence[str] | None) -> Table:
    """What describes each motion: everything of the stimuli named, else of all what tells them apart best."""
    from stimuli.descriptors import UNITS

    clips = manifest.clips if not stimuli else {id_: manifest.clips[id_] for id_ in stimuli}
    names = list(dict.fromkeys(name for clip in clips.values() for name in clip.descriptors))
    shown = {name: f"{name.removesuffix('_s').removesuffix('_m')} ({UNITS.get(name, '–')})" for name in names}
    if stimuli:
        table = Table("", *clips)
        for name, title in shown.items():
            table.add_row(
                title, *(f"{clip.descriptors.get(name, float('nan')):.3g}" for clip in clips.values())
            )
        return table
    main = ("duration_s", "amplitude", "speed_mean", "speed_peak", "jerk_rms")
    table = Table("", *(shown[name] for name in main))
    for id_, clip in clips.items():
        table.add_row(id_, *(f"{clip.descriptors[name]:.3g}" for name in main))
    return table


@app.command()
def render(
    path: ProtocolPath,
    clips: Clips = None,
    workers: Workers = None,
    scheduler: Scheduler = None,
    as_json: AsJson = False,
) -> None:
    """Render the clips that are missing."""
    protocol = _load(path)
    folder = clips or protocol.folder / "stimuli"
    manifest = _render(protocol, folder, workers, scheduler)
    if as_json:
        _print_json(manifest.model_dump(mode="json"))
    else:
        console.print(f"{len(manifest.clips)} clips in {folder}")


@app.command()
def run(
    path: ProtocolPath,
    clips: Clips = None,
    data: Data = None,
    workers: Workers = None,
    host: str = "127.0.0.1",
    port: int = 8000,
    door: DoorOption = "open",
) -> None:
    """Render what is missing, then serve the study."""
    protocol = _load(path)
    folder = clips or protocol.folder / "stimuli"
    manifest = _render(protocol, folder, workers)
    _serve(protocol, manifest, folder, data=data, host=host, port=port, door=door)


@app.command()
def serve(
    path: ProtocolPath,
    clips: Clips = None,
    data: Data = None,
    database: Database = None,
    host: str = "127.0.0.1",
    port: int = 8000,
    door: DoorOption = "open",
    test: Annotated[
        bool, typer.Option("--test", help="Try the study out: answers are marked and kept apart.")
    ] = False,
) -> None:
    """Serve the study with the clips there are."""
    from stimuli.manifest import Manifest

    protocol = _load(path)
    folder = clips or protocol.folder / "stimuli"
    _serve(
        protocol,
        Manifest.load(folder),
        folder,
        data=data,
        database=database,
        host=host,
        port=port,
        door=door,
        test=test,
    )


def _serve(
    protocol: Protocol,
    manifest: Manifest,
    folder: Path,
    *,
    data: Path | None,
    host: str,
    port: int,
    door: Literal["open", "link", "kiosk"],
    database: str | None = None,
    test: bool = False,
) -> None:
    from study.web import serve as serve_until_stopped

    def analyse(responses: Path, out: Path) -> None:
        from analysis.report import analyse as analyse_responses

        analyse_responses(responses, protocol, out)

    def announce(links: Links) -> None:
        console.print(f"[bold]{protocol.title}[/] is open{' as a test' if test else ''}. Ctrl-C closes it.")
        console.print(f"  participants   {links.participant}")
        console.print(f"  experimenter   {links.experimenter}")
        if links.password:
            console.print(f"  password       {links.password}   (made now and shown once; write it down)")

    serve_until_stopped(
        protocol,
        manifest,
        clips_folder=folder,
        data_folder=data or protocol.folder / "data",
        announce=announce,
        url=database,
        host=host,
        port=port,
        kind="test" if test else "participant",
        door=door,
        analyse=analyse,
    )
    console.print("Closed. Every acknowledged answer is stored.")


@app.command()
def rehearse(
    path: ProtocolPath,
    n: Annotated[int, typer.Option("-n", min=1, help="Simulated participants.")] = 34,
    out: Out = Path("rehearsal"),
    clips: Clips = None,
) -> None:
    """Let simulated participants take the whole study over HTTP, then analyse what they left."""
    from analysis.report import analyse as analyse_responses
    from stimuli.manifest import Manifest
    from study.simulation import rehearse as let_them_come
    from study.web.site import clips_of

    protocol = _load(path)
    folder = clips or protocol.folder / "stimuli"
    with console.status(f"{n} simulated participants take the study …"):
        table = let_them_come(protocol, n, out, clips=clips_of(Manifest.load(folder), folder))
    analyse_responses(table, protocol, out)
    console.print(
        f"{n} [bold]simulated[/] participants (no data) took the study. The report: {out / 'report.html'}"
    )


@app.command()
def export(
    path: ProtocolPath,
    out: Out = Path("export"),
    data: Data = None,
    database: Database = None,
    clips: Clips = None,
) -> None:
    """Write the answers as a table, with the codebook that explains it."""
    from stimuli.manifest import Manifest
    from study.export import export_responses
    from study.storage import open_store
    from study.web.site import clips_of, hashes

    protocol = _load(path)
    folder = clips or protocol.folder / "stimuli"
    file = (data or protocol.folder / "data") / "study.db"
    if database is None and not file.exists():
        raise InputError(
            f"{file}: no answers yet. `study run {path}` opens the study; --data names another folder"
        )
    store = open_store(database or f"sqlite:///{file}")
    table = export_responses(store, protocol, out, clips=hashes(clips_of(Manifest.load(folder), folder)))
    store.close()
    console.print(f"{table} and its codebook are written.")


@app.command()
def restore(
    path: ProtocolPath,
    backup: Annotated[Path, typer.Argument(metavar="BACKUP", help="A file from PROTOCOL/data/backups.")],
    data: Data = None,
) -> None:
    """Put a backup in the place of the answers; the study must not be running."""
    from study.storage.backups import restore as restore_backup

    database = (data or _load(path).folder / "data") / "study.db"
    restore_backup(backup, database)
    console.print(f"{database} is now as it was in {backup.name}.")


@app.command()
def analyse(
    responses: Annotated[Path, typer.Argument(metavar="RESPONSES.csv", help="Answers, one row per item.")],
    protocol: Annotated[Path, typer.Option("--protocol", help="Protocol folder, or its YAML file.")],
    out: Out = Path("report"),
    column: Annotated[
        list[str] | None,
        typer.Option("--column", metavar="OURS=THEIRS", help="A column of another name: participant=PID."),
    ] = None,
) -> None:
    """Carry out the protocol's plan of analysis: statistics, tables, figures and the report."""
    from analysis.report import analyse as analyse_responses

    columns = {ours: theirs for ours, _, theirs in (said.partition("=") for said in column or ())}
    analyse_responses(responses, _load(protocol), out, columns)
    console.print(f"The report is {out / 'report.html'}; all numbers are in {out / 'results.json'}.")


@app.command()
def orders(
    path: ProtocolPath,
    n: Annotated[int | None, typer.Option("-n", min=1, help="Participants; as planned unless told.")] = None,
    as_json: AsJson = False,
) -> None:
    """Print who sees what when as CSV, and how well that is balanced."""
    from study.balance import balance, balance_table, orders_csv
    from study.orders import draw_plan

    protocol = _load(path)
    plans = [draw_plan(protocol, slot) for slot in range(n or protocol.participants.planned)]
    counts = balance(protocol, plans)
    if as_json:
        _print_json([asdict(plan) for plan in plans])
    else:
        sys.stdout.write(orders_csv(plans))
        sys.stdout.flush()
        Console(stderr=True, highlight=False).print(balance_table(counts))


@app.command()
def design(path: ProtocolPath, as_json: AsJson = False) -> None:
    """Show the design on one screen: factors, blocks, orders and balance."""
    from study.design import design as design_of

    found = design_of(_load(path))
    if as_json:
        _print_json(found.as_json())
    else:
        console.print(escape(str(found)))


@app.command()
def power(
    path: ProtocolPath,
    simulate: Annotated[
        int | None, typer.Option("--simulate", min=1, help="Simulate so many whole studies and analyse each.")
    ] = None,
    effect: Annotated[
        float, typer.Option(min=0, help="Assumed: 0 by chance, 1 as plain as to the paper's participants.")
    ] = 1.0,
    n: Annotated[int | None, typer.Option("-n", min=2, help="Participants; as planned unless told.")] = None,
) -> None:
    """Say what the planned participants can show: exactly, or by simulating the whole analysis."""
    protocol = _load(path)
    if simulate is None:
        from study.power import power as power_of

        for found in power_of(protocol):
            console.print(str(found))
        return
    from analysis.simulated_power import simulated_power

    with _progress("simulating", simulate) as advance:
        simulated = simulated_power(protocol, runs=simulate, effect=effect, n=n, progress=advance)
    for one in simulated:
        console.print(str(one))


@app.command()
def methods(
    path: ProtocolPath,
    latex: Annotated[bool, typer.Option("--latex", help="LaTeX instead of Markdown.")] = False,
    out: Annotated[Path | None, typer.Option("--out", help="File to write; the screen unless told.")] = None,
) -> None:
    """Draft the methods section, with the protocol's true numbers."""
    from study.methods import methods as draft
    from study.methods import methods_latex

    protocol = _load(path)
    _write(methods_latex(protocol) if latex else draft(protocol), out)


@app.command()
def schema(
    out: Annotated[Path | None, typer.Option("--out", help="File to write; the screen unless told.")] = None,
) -> None:
    """Write the protocol language as a JSON Schema, for completion in editors."""
    from study.protocol.schema import schema_text

    _write(schema_text(), out)


@app.command()
def preregister(
    path: ProtocolPath,
    out: Annotated[Path | None, typer.Option("--out", help="File to write; the screen unless told.")] = None,
) -> None:
    """Write the preregistration that follows from the protocol, in Markdown."""
    from study.preregister import preregister as preregistration

    _write(preregistration(_load(path)), out)


@app.command()
def verify(
    paper: Annotated[
        Path,
        typer.Argument(metavar="TABLE.csv|PAPER.md", help="Printed numbers with their decimals, or a text."),
    ],
    n: Annotated[int | None, typer.Option("-n", min=2, help="Participants behind the table.")] = None,
    items: Annotated[int, typer.Option(min=1, help="Items behind each mean.")] = 1,
) -> None:
    """Check what is published: can n participants give this table, do these p-values follow?"""
    from analysis.published import verify as verify_table
    from analysis.statcheck import check_file

    if paper.suffix.lower() == ".csv":
        if n is None:
            raise InputError(f"{paper}: say how many participants are behind the table, as in -n 34")
        found: Any = verify_table(paper, n, items=items)
    else:
        found = check_file(paper)
    console.print(escape(str(found)))
    raise typer.Exit(1 if found.faults else 0)


@app.command()
def figures(out: Out = Path("figures")) -> None:
    """Draw the paper's figures of the method from this code."""
    from stimuli.figures import draw_paper_figures

    with console.status("drawing …"):
        draw_paper_figures(out)
    console.print(f"The paper's figures are in {out}.")


@app.command()
def doctor() -> None:
    """Say whether this machine can render and serve, and what to install where not."""
    from stimuli.doctor import examine

    report = examine()
    console.print(str(report))
    raise typer.Exit(0 if report.good else 1)


def _load(path: Path) -> Protocol:
    from study.protocol import load_protocol

    return load_protocol(path)


def _render(protocol: Protocol, folder: Path, workers: int | None, scheduler: str | None = None) -> Manifest:
    from stimuli.library import Progress as Rendered
    from stimuli.library import render_missing
    from stimuli.robots import load_robot
    from study.specs import specs

    wanted = specs(protocol)
    robots = {spec.robot: load_robot(spec.robot, protocol.folder) for spec in wanted.values()}
    try:
        with _progress("rendering", None) as advance:

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
def _progress(what: str, total: int | None) -> Iterator[Any]:
    columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TimeRemainingColumn())
    with Progress(*columns, console=Console(stderr=True), transient=True) as shown:
        task = shown.add_task(what, total=total)
        yield lambda done, of=None: shown.update(task, completed=done, total=of or total)


def _write(text: str, out: Path | None) -> None:
    if out is None:
        sys.stdout.write(text)
        return
    out.write_text(text, encoding="utf-8")
    console.print(f"{out} is written.")


def _print_json(value: Any) -> None:
    sys.stdout.write(json.dumps(value, indent=2, ensure_ascii=False) + "\n")


if __name__ == "__main__":
    main()
