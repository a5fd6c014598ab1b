"""Figures of a study as a whole: who was counted, and how large every effect is."""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from analysis.drawing import COLOURS, FAINT, INK, Drawing
from analysis.exclusions import Flow
from analysis.plan import Findings, Levels, Targets
from analysis.statistics.t_test import TTest

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import FigureBase

ROW_IN = 0.17  # height of a row of the forest


def draw_flow(flow: Flow) -> Drawing:
    """Participants from answering to being analysed, after the CONSORT diagram."""
    left_out = [f"{flow.count(rule)} {rule}" for rule in flow.rules]
    return Drawing(
        name="participants",
        paint=partial(_paint_flow, flow=flow, left_out=left_out),
        height_in=1.3 + 0.13 * len(left_out),
        caption="Participants from their first answer to the analysis, by the rules declared beforehand.",
        alt=f"{flow.answered} answered; {len(flow.excluded)} left out ({'; '.join(left_out) or 'no rules'}); "
        f"{flow.analysed} analysed.",
    )


def _paint_flow(figure: FigureBase, *, flow: Flow, left_out: list[str]) -> None:
    axes = figure.add_subplot()
    axes.set_axis_off()
    axes.set_xlim(0, 1)
    axes.set_ylim(0, 1)
    arrow = {"arrowstyle": "-|>", "color": INK, "linewidth": 0.7, "shrinkA": 0, "shrinkB": 0}
    axes.annotate("", (0.2, 0.18), (0.2, 0.8), arrowprops=arrow | {"shrinkB": 14})  # at the box's edge
    axes.annotate("", (0.4, 0.5), (0.2, 0.5), arrowprops=arrow)
    reasons = "".join(f"\n{line}" for line in left_out)
    for x, y, text, align in (
        (0.2, 0.82, f"Answered\nn = {flow.answered}", "center"),
        (0.2, 0.18, f"Analysed\nn = {flow.analysed}", "center"),
        (0.42, 0.5, f"Left out, n = {len(flow.excluded)}{reasons}", "left"),
    ):
        axes.text(
            x, y, text, ha=align, va="center", fontsize=6.5, wrap=True, linespacing=1.4,
            bbox={"boxstyle": "round,pad=0.5", "facecolor": "white", "edgecolor": INK, "linewidth": 0.7},
        )  # fmt: skip


def draw_forest(findings: Findings, labels: Mapping[str, str]) -> Drawing | None:
    """Cohen's d of every test with its interval; None where there is none."""
    rows: list[tuple[str, TTest | None]] = []
    for name, outcome in findings.outcomes.items():
        if isinstance(outcome, Targets):
            tests = {key: one.against.t_test for key, one in outcome.results.items()}
        elif isinstance(outcome, Levels) and outcome.mirrors is None:
            tests = {key: one.deciding_t for key, one in outcome.results.items()}
        else:
            continue
        rows.append((name, None))
        rows += [(labels.get(key, key.capitalize()), test) for key, test in tests.items()]
    if all(test is None or test.d is None for _, test in rows):
        return None
    return Drawing(
        name="effects",
        paint=partial(_paint_forest, rows=rows),
        height_in=0.62 + ROW_IN * len(rows),
        caption="Size of every effect: Cohen's d with its exact 95% interval. "
        "An effect without variance has no d; its exact test decides.",
        alt="; ".join(
            f"{label} {'undefined' if test.d is None else f'{test.d:.2f}'}" for label, test in rows if test
        ),
    )


def _paint_forest(figure: FigureBase, *, rows: list[tuple[str, TTest | None]]) -> None:
    axes = figure.add_subplot()
    heights = -np.arange(len(rows), dtype=float)
    shown = [
        (test.d, test.d - test.d_ci95[0], test.d_ci95[1] - test.d, y)
        for (_, test), y in zip(rows, heights, strict=True)
        if test and test.d is not None and test.d_ci95
    ]
    if shown:
        d, below, above, at = np.array(shown).T
        axes.errorbar(
            d, at, xerr=[below, above], linestyle="", marker="s", markersize=3.2, color=COLOURS[3],
            elinewidth=0.9, capsize=1.8, capthick=0.9, zorder=3,
        )  # fmt: skip
    axes.axvline(0, color=INK, linewidth=0.6, linestyle=(0, (4, 3)), zorder=1)
    _name_rows(axes, rows, heights)
    axes.set_ylim(heights[-1] - 0.7, 0.7)
    axes.set_xlabel("Cohen's d, 95% CI")
    axes.margins(x=0.08)


def _name_rows(axes: Axes, rows: list[tuple[str, TTest | None]], heights: np.ndarray) -> None:
    axes.set_yticks(heights, [label for label, _ in rows])
    axes.tick_params(axis="y", length=0)
    axes.spines["left"].set_visible(False)
    for (_, test), tick, y in zip(rows, axes.get_yticklabels(), heights, strict=True):
        if test is None:
            tick.set_fontweight("bold")
        elif test.d is None:
            axes.annotate(
                str(test.reason), (0, y), xytext=(4, 0), textcoords="offset points", va="center",
                fontsize=6, color=FAINT,
            )  # fmt: skip
