"""Commands that hold sessions, and get the answers out."""

from __future__ import annotations

import shlex
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

import typer

from stimuli.errors import InputError
from study.cli.command import (
    Clips,
    Data,
    Database,
    DoorOption,
    Out,
    Port,
    ProtocolPath,
    Workers,
    app,
    console,
    load,
    rendered,
)

if TYPE_CHECKING:
    from stimuli.manifest import Manifest
    from study.protocol import Protocol
    from study.web import Links


@app.command()
def run(
    path: ProtocolPath,
    clips: Clips = None,
    data: Data = None,
    workers: Workers = None,
    host: str = "127.0.0.1",
    port: Port = 8000,
    door: DoorOption = "open",
) -> None:
    """Render what is missing, then serve the study."""
    from study.versions import refuse_if_begun_otherwise

    protocol = load(path)
    refuse_if_begun_otherwise(protocol, data or protocol.folder / "data")  # nothing is rendered for it
    folder = clips or protocol.folder / "stimuli"
    manifest = rendered(protocol, folder, workers)
    _serve(protocol, manifest, folder, data=data, host=host, port=port, door=door)


@app.command()
def serve(
    path: ProtocolPath,
    clips: Clips = None,
    data: Data = None,
    database: Database = None,
    host: str = "127.0.0.1",
    port: Port = 8000,
    door: DoorOption = "open",
    test: Annotated[
        bool, typer.Option("--test", help="Try the study out: answers are marked and kept apart.")
    ] = False,
) -> None:
    """Serve the study with the clips there are."""
    from stimuli.manifest import Manifest

    protocol = load(path)
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
        if links.passwords:
            console.print(
                f"  password       {links.passwords.edit}   (made now and shown once; write it down)"
            )
            console.print(f"  to look on     {links.passwords.view}   (changes nothing, shows no contacts)")

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
    manner: Annotated[
        list[str] | None,
        typer.Option(
            help="How all answer, once or more: attentive, unsure, random clicker, yea-sayer, speeder, "
            "dropout. Unless told, most are attentive."
        ),
    ] = None,
) -> None:
    """Let simulated participants take the whole study over HTTP, then analyse what they left."""
    from analysis.report import analyse as analyse_responses
    from stimuli.manifest import Manifest
    from study.simulation import crowd_of
    from study.simulation import rehearse as let_them_come
    from study.web.site import clips_of

    protocol, shares = load(path), crowd_of(manner or ())
    folder = clips or protocol.folder / "stimuli"
    shown = clips_of(Manifest.load(folder), folder)
    with console.status(f"{n} simulated participants take the study …"):
        table = let_them_come(protocol, n, out, clips=shown, shares=shares)
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
    """Write the answers as a table, with the codebook that explains it, and as a Psych-DS dataset."""
    from stimuli.manifest import Manifest
    from study.export import export_responses
    from study.psych_ds import write_dataset
    from study.storage import open_store
    from study.versions import earlier_versions
    from study.web.site import clips_of, hashes

    protocol = load(path)
    folder = clips or protocol.folder / "stimuli"
    kept = data or protocol.folder / "data"
    file = kept / "study.db"
    if database is None and not file.exists():
        raise InputError(
            f"{file}: no answers yet. `study run {shlex.quote(str(path))}` opens the study; "
            "--data names another folder"
        )
    store = open_store(database or f"sqlite:///{file}")
    earlier = list(earlier_versions(protocol, kept))
    manifests = {version.sha256: version.manifest for version in earlier}
    manifests[protocol.sha256] = Manifest.load(folder)
    files = {sha256: hashes(clips_of(manifest, folder)) for sha256, manifest in manifests.items()}
    before = {version.sha256: version.protocol for version in earlier}
    table = export_responses(store, protocol, out, clips=files, earlier=before)
    store.close()
    dataset = write_dataset(protocol, table, out / "psych-ds", earlier=before)
    console.print(f"{table} and its codebook are written, and as a Psych-DS dataset {dataset}.")


@app.command()
def restore(
    path: ProtocolPath,
    backup: Annotated[Path, typer.Argument(metavar="BACKUP", help="A file from PROTOCOL/data/backups.")],
    data: Data = None,
) -> None:
    """Put a backup in the place of the answers; the study must not be running."""
    from study.storage.backups import restore as restore_backup

    database = (data or load(path).folder / "data") / "study.db"
    restore_backup(backup, database)
    console.print(f"{database} is now as it was in {backup.name}.")
