"""Commands from responses to statistics."""

from __future__ import annotations

from datetime import datetime
from pathlib import Path
from typing import Annotated, Any

import typer
from rich.markup import escape

from stimuli.errors import InputError
from study.cli.command import (
    Out,
    app,
    console,
    load,
)


@app.command()
def analyse(
    responses: Annotated[Path, typer.Argument(metavar="RESPONSES.csv", help="Answers, one row per item.")],
    protocol: Annotated[Path, typer.Option("--protocol", help="Protocol folder, or its YAML file.")],
    out: Out = Path("report"),
    column: Annotated[
        list[str] | None,
        typer.Option("--column", metavar="OURS=THEIRS", help="A column of another name: participant=PID."),
    ] = None,
    time: Annotated[
        datetime | None,
        typer.Option(
            formats=["%Y-%m-%d", "%Y-%m-%dT%H:%M", "%Y-%m-%dT%H:%M%z"],
            help="The time of the analysis, for the report; without, equal answers give equal files.",
        ),
    ] = None,
) -> None:
    """Carry out the protocol's plan of analysis: statistics, tables, figures and the report."""
    from analysis.report import analyse as analyse_responses

    columns = {ours: theirs for ours, _, theirs in (said.partition("=") for said in column or ())}
    analysed = time.isoformat(timespec="minutes") if time else None
    analyse_responses(responses, load(protocol), out, columns, analysed=analysed)
    console.print(f"The report is {out / 'report.html'}; all numbers are in {out / 'results.json'}.")


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
    from analysis.paper import check_paper
    from analysis.published import verify as verify_table

    if paper.suffix.lower() == ".csv":
        if n is None:
            raise InputError(f"{paper}: say how many participants are behind the table, as in -n 34")
        found: Any = verify_table(paper, n, items=items)
    else:
        found = check_paper(paper, n, items=items)
    console.print(escape(str(found)))
    raise typer.Exit(1 if found.faults else 0)
