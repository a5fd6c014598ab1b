"""Preferences between pairs as a table, for a paper and for programs, and as a figure."""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from analysis.apa import bounded, interval, probability
from analysis.drawing import COLOURS, INK, Drawing
from analysis.plan import Preferences
from analysis.tables import as_csv, escaped, in_math, noted

if TYPE_CHECKING:
    from matplotlib.figure import FigureBase


def preferred_csv(outcome: Preferences, note: str = "") -> str:
    """Counts, shares and exact tests, one row per pair."""
    head = ("pair", "stimulus", "other", "n", "chosen", "share", "ci_low", "ci_high", "p", "p_adjusted")
    rows = []
    for name, one in outcome.results.items():
        test, two = one.test, one.compared
        counted = (test.n, test.k, test.estimate, *(test.ci95 or (None, None)))
        rows.append((name, two.first, two.second, *counted, test.p, one.verdict.p_adjusted))
    return as_csv(head, rows, note)


def preferred_latex(outcome: Preferences, note: str = "") -> str:
    """The same for a paper. Needs the package booktabs."""
    first, second = map(escaped, outcome.compare)
    judging = outcome.judging
    lines = [
        r"% packages: booktabs",
        r"\begin{table}",
        r"  \centering",
        r"  \begin{tabular}{lrrrr}",
        r"    \toprule",
        r"    & $k/N$ & share & 95\% CI & $p$ \\",
        r"    \midrule",
    ]
    for name, one in outcome.results.items():
        p = probability(one.verdict.p_adjusted, judging.alpha).removeprefix("= ")
        cells = (in_math(bounded(one.test.estimate)), in_math(interval(one.test.ci95)), in_math(p))
        counts = f"${one.test.k}/{one.test.n}$"
        lines.append(f"    {escaped(name.capitalize())} & {counts} & {' & '.join(cells)} \\\\")
    return "\n".join([
        *lines,
        r"    \bottomrule",
        r"  \end{tabular}",
        rf"  \caption{{{noted(note)}Share that chose {first} over {second}, side by side, with exact "
        rf"intervals; binomial test against one half, {judging.sides}, $p$ {judging.adjustment}.}}",
        rf"  \label{{tab:{outcome.name}}}",
        r"\end{table}",
    ]) + "\n"  # fmt: skip


def draw_preferences(outcome: Preferences, labels: Mapping[str, str]) -> Drawing:
    """The share of each pair with its exact interval and count."""
    first, second = outcome.compare
    return Drawing(
        name=outcome.name,
        paint=partial(_paint, outcome=outcome, labels=labels),
        height_in=0.75 + 0.22 * len(outcome.results),
        caption=f"Share of participants who chose {first} over {second}, side by side, with exact 95% "
        "intervals and counts.",
        alt="; ".join(f"{name}: {one.test.k} of {one.test.n}" for name, one in outcome.results.items()),
    )


def _paint(figure: FigureBase, *, outcome: Preferences, labels: Mapping[str, str]) -> None:
    axes = figure.add_subplot()
    heights = -np.arange(len(outcome.results), dtype=float)
    for y, one in zip(heights, outcome.results.values(), strict=True):
        share, limits = one.test.estimate, one.test.ci95
        if share is None or limits is None:
            continue
        spread = [[share - limits[0]], [limits[1] - share]]
        axes.errorbar(
            share, y, xerr=spread, color=COLOURS[3], marker="s", markersize=3.4, elinewidth=0.9, capsize=2,
            capthick=0.9, zorder=3,
        )  # fmt: skip
        axes.annotate(
            f"{one.test.k}/{one.test.n}", (share, y), xytext=(0, 4), textcoords="offset points", ha="center",
            fontsize=6, color=INK, bbox={"facecolor": "white", "edgecolor": "none", "pad": 0.5},
        )  # fmt: skip
    axes.axvline(0.5, color=INK, linewidth=0.6, linestyle=(0, (4, 3)), zorder=1)
    axes.set_xlim(-0.02, 1.02)
    axes.set_xticks([0, 0.25, 0.5, 0.75, 1], ["0", ".25", ".50", ".75", "1"])
    axes.set_ylim(heights[-1] - 0.7, 0.7)
    axes.set_yticks(heights, [labels.get(name, name.capitalize()) for name in outcome.results])
    axes.tick_params(axis="y", length=0)
    axes.spines["left"].set_visible(False)
    axes.set_xlabel(f"Share choosing {outcome.compare[0]} over {outcome.compare[1]}, 95% CI")
