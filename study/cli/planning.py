"""Commands before the first participant: write, check and plan a study."""

from __future__ import annotations

import shlex
import sys
from dataclasses import asdict
from datetime import date
from itertools import chain, islice
from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console
from rich.markup import escape

from study.cli.command import (
    AsJson,
    ProtocolPath,
    app,
    console,
    load,
    print_json,
    progress,
)


@app.command()
def new(folder: Annotated[Path, typer.Argument(metavar="FOLDER", help="Where the study is to be.")]) -> None:
    """Write a new study from the template; it runs as it is."""
    from study.new import new_study

    protocol = new_study(folder)
    where = shlex.quote(str(folder))
    console.print(f"{protocol} is written. Change it, then: study check {where}, and: study run {where}")


@app.command()
def check(path: ProtocolPath, as_json: AsJson = False) -> None:
    """Check everything that can be known before the first participant comes."""
    from study.check import check as check_protocol

    protocol = load(path)
    with progress("checking motions", None) as advance:
        report = check_protocol(protocol, advance, today=date.today())
    if as_json:
        print_json(report.as_json())
    else:
        console.print(escape(str(report)))
    raise typer.Exit(0 if report.good else 1)


@app.command()
def orders(
    path: ProtocolPath,
    n: Annotated[int | None, typer.Option("-n", min=1, help="Participants; as planned unless told.")] = None,
    as_json: AsJson = False,
) -> None:
    """Print who sees what when as CSV, and how well that is balanced."""
    from study.balance import DRAWN, balance, balance_table, write_orders
    from study.orders import draw_plan

    protocol = load(path)
    wanted = n or protocol.participants.planned
    plans = (draw_plan(protocol, slot) for slot in range(wanted))
    if as_json:
        print_json([asdict(plan) for plan in plans])
        return
    counted = list(islice(plans, DRAWN))
    write_orders(protocol, chain(counted, plans), sys.stdout)
    sys.stdout.flush()
    screen = Console(stderr=True, highlight=False, soft_wrap=True)
    if wanted > DRAWN:
        screen.print(f"Of the first {DRAWN} participants:")
    screen.print(balance_table(balance(protocol, counted)))


@app.command()
def design(path: ProtocolPath, as_json: AsJson = False) -> None:
    """Show the design on one screen: factors, blocks, orders and balance."""
    from study.design import design as design_of

    found = design_of(load(path))
    if as_json:
        print_json(found.as_json())
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
    protocol = load(path)
    if simulate is None:
        from study.power import power as power_of

        for found in power_of(protocol):
            console.print(f"{found.hypothesis}: {found} {found.level}; {found.planning}")
        return
    from analysis.simulated_power import simulated_power

    with progress("simulating", simulate) as advance:
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

    protocol = load(path)
    _write(methods_latex(protocol) if latex else draft(protocol), out)


@app.command()
def preregister(
    path: ProtocolPath,
    out: Annotated[Path | None, typer.Option("--out", help="File to write; the screen unless told.")] = None,
) -> None:
    """Write the preregistration that follows from the protocol, in Markdown."""
    from study.preregister import preregister as preregistration

    _write(preregistration(load(path)), out)


@app.command()
def schema(
    out: Annotated[Path | None, typer.Option("--out", help="File to write; the screen unless told.")] = None,
) -> None:
    """Write the protocol language as a JSON Schema, for completion in editors."""
    from study.protocol.schema import schema_text

    _write(schema_text(), out)


def _write(text: str, out: Path | None) -> None:
    if out is None:
        sys.stdout.write(text)
        return
    out.write_text(text, encoding="utf-8")
    console.print(f"{out} is written.")
