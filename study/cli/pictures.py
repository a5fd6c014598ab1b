"""Commands that make motion and pictures."""

from __future__ import annotations

import shlex
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

import typer
from rich.table import Table

from stimuli.errors import InputError, nearest
from study.cli.command import (
    AsJson,
    Clips,
    Out,
    ProtocolPath,
    Scheduler,
    Workers,
    app,
    console,
    load,
    print_json,
    rendered,
)

if TYPE_CHECKING:
    from stimuli.manifest import Manifest


@app.command()
def render(
    path: ProtocolPath,
    clips: Clips = None,
    workers: Workers = None,
    scheduler: Scheduler = None,
    as_json: AsJson = False,
) -> None:
    """Render the clips that are missing."""
    protocol = load(path)
    folder = clips or protocol.folder / "stimuli"
    manifest = rendered(protocol, folder, workers, scheduler)
    if as_json:
        print_json(manifest.model_dump(mode="json"))
    else:
        stimuli, files = len(manifest.clips), len({clip.file for clip in manifest.clips.values()})
        shared = "" if stimuli == files else f" of {stimuli} stimuli; those that look the same share one"
        console.print(f"{folder}: {files} clips{shared}.")


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
    from study.specs import specs

    protocol = load(path)
    folder = clips or protocol.folder / "stimuli"
    manifest = Manifest.load(folder)
    if not manifest.clips:
        makes = shlex.join(["study", "render", str(path), *(["--clips", str(clips)] if clips else [])])
        raise InputError(f"{folder}: there are no clips yet. `{makes}` makes them.")
    names = {clip.spec["robot"] for clip in manifest.clips.values()}
    robots = {name: load_robot(name, protocol.folder) for name in names}
    gestures = {spec.gesture_sha256: spec.gesture for spec in specs(protocol).values()} if stimuli else {}
    with console.status("drawing …"):
        drawn = draw_preview(
            manifest,
            folder,
            out or folder / "preview",
            stimuli=stimuli or (),
            robots=robots,
            gestures=gestures,
        )
    console.print(_descriptors(manifest, stimuli))
    console.print("\n".join(f"{file}" for file in drawn))


def _descriptors(manifest: Manifest, stimuli: Sequence[str] | None) -> Table:
    """What describes each motion: everything of the stimuli named, else of all what tells them apart best."""
    from stimuli.descriptors import UNITS

    clips = manifest.clips if not stimuli else {id_: manifest.clips[id_] for id_ in stimuli}
    names = list(dict.fromkeys(name for clip in clips.values() for name in clip.descriptors))
    units = {name: UNITS.get(name, "–") for name in names}
    shown = {name: f"{name.removesuffix(f'_{unit}')} ({unit})" for name, unit in units.items()}
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
def motion(
    path: ProtocolPath,
    stimulus: Annotated[str, typer.Argument(metavar="STIMULUS", help="Whose motion.")],
    out: Annotated[Path, typer.Option("--out", help="File to write.")],
    form: Annotated[
        Literal["csv", "qianim", "naoqi", "naoqi-bezier", "ros"],
        typer.Option("--as", help="Format: a table, Pepper's animation, ALMotion's arguments, or ROS 2."),
    ] = "csv",
) -> None:
    """Write a stimulus' motion for another program or for the robot itself."""
    from stimuli.export import write_motion
    from stimuli.motion import generate
    from stimuli.robots import load_robot
    from study.specs import specs

    protocol = load(path)
    wanted = specs(protocol)
    if stimulus not in wanted:
        raise InputError(f"{stimulus!r} is no stimulus of {protocol.study}; {nearest(stimulus, wanted)}")
    spec = wanted[stimulus]
    robot = load_robot(spec.robot, protocol.folder)
    write_motion(generate(spec, robot).trajectory, robot, out, form)
    console.print(f"{out} is written.")


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
