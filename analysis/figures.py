"""Figures of what was answered: ratings of every item, and choices at every level."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from analysis.drawing import COLOURS, INK, Drawing
from analysis.plan import Levels, Targets
from analysis.statistics.wilson import wilson

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import FigureBase

DASHED = (0, (4, 3))


def draw_targets(outcome: Targets, labels: Mapping[str, str]) -> Drawing:
    """Mean ± SE of every item for every stimulus, with all ratings behind and the target marked."""
    return Drawing(
        name=outcome.name,
        paint=partial(_paint_targets, outcome=outcome, labels=labels),
        height_in=2.35,
        caption=f"Perceived expression of each clip: mean rating and standard error "
        f"(N = {len(outcome.answers.participants)}); bars behind show how many gave each rating, "
        "diamonds mark the intended expression.",
        alt="; ".join(
            f"{labels.get(stimulus, stimulus)}: "
            + ", ".join(
                f"{labels.get(item, item)} {'–' if m.mean is None else f'{m.mean:.1f}'}"
                for item, m in items.items()
            )
            for stimulus, items in outcome.means.items()
        ),
    )


def _paint_targets(figure: FigureBase, *, outcome: Targets, labels: Mapping[str, str]) -> None:
    answers, scale = outcome.answers, outcome.answers.scale
    assert scale is not None
    axes = figure.add_subplot()
    width = 0.84 / len(answers.items)
    for i, item in enumerate(answers.items):
        places = np.arange(len(answers.stimuli)) + (i - (len(answers.items) - 1) / 2) * width
        colour = COLOURS[i % len(COLOURS)]
        columns = zip(places, answers.ratings[:, :, i].T, strict=True)
        _strips(axes, columns, width=width, colour=colour)
        _means(axes, outcome, item, places=places, colour=colour)
    if outcome.definition.on_scale:
        level = next(iter(outcome.results.values())).against.null
        axes.axhline(level, color=INK, linewidth=0.6, linestyle=DASHED, zorder=1)
        axes.annotate(
            f"chance\n({outcome.chance})", (1, level), xycoords=("axes fraction", "data"), xytext=(2, 0),
            textcoords="offset points", ha="left", va="center", fontsize=6, color=INK,
        )  # fmt: skip
    axes.set_xlim(-0.5, len(answers.stimuli) - 0.5)
    _scale(axes, scale)
    axes.set_xticks(range(len(answers.stimuli)), [labels.get(s, s.capitalize()) for s in answers.stimuli])
    axes.tick_params(axis="x", length=0)
    axes.set_xlabel("Intended expression")
    axes.set_ylabel("Rating, mean ± SE")
    borders = np.arange(1, len(answers.stimuli)) - 0.5
    axes.vlines(borders, *axes.get_ylim(), color="#DDDDDD", linewidth=0.5, zorder=0)
    _legend(figure, answers.items, labels)


def _scale(axes: Axes, scale: tuple[float, float]) -> None:
    """The whole scale as the vertical axis, and nothing beyond it."""
    low, high = scale
    margin = (high - low) / 16
    axes.set_ylim(low - margin, high + margin)
    axes.set_yticks(np.arange(low, high + 1) if high - low <= 10 else np.linspace(low, high, 5))


def _strips(
    axes: Axes,
    columns: Iterable[tuple[float, np.ndarray]],
    *,
    width: float,
    colour: str,
    height: float = 0.3,
) -> None:
    """Behind each mean a bar per rating, as wide as its share; columns are (place, ratings)."""
    from matplotlib.collections import PolyCollection

    corners = []
    for x, ratings in columns:
        values, counts = np.unique(ratings[~np.isnan(ratings)], return_counts=True)
        for value, share in zip(values, counts / max(1, counts.sum()), strict=True):
            w, h = share * width * 0.95 / 2, height / 2
            corners.append([(x - w, value - h), (x + w, value - h), (x + w, value + h), (x - w, value + h)])
    axes.add_collection(PolyCollection(corners, facecolor=colour, alpha=0.4, linewidth=0, zorder=2))


def _means(axes: Axes, outcome: Targets, item: str, *, places: np.ndarray, colour: str) -> None:
    for target, marker, size in ((False, "o", 2.6), (True, "D", 4.2)):
        shown = [
            (x, one.mean, one.se or 0)
            for x, (stimulus, items) in zip(places, outcome.means.items(), strict=True)
            for one in [items[item]]
            if one.mean is not None and target == _is_target(outcome, stimulus, item)
        ]
        if shown:
            x, y, se = np.array(shown).T
            axes.errorbar(x, y, yerr=se, fmt="none", ecolor=INK, elinewidth=0.7, capsize=1.2, capthick=0.7)
            axes.plot(
                x, y, linestyle="", marker=marker, markersize=size, markerfacecolor=colour, zorder=5,
                markeredgecolor="black" if target else colour, markeredgewidth=0.9 if target else 0,
            )  # fmt: skip


def _is_target(outcome: Targets, stimulus: str, item: str) -> bool:
    return stimulus in outcome.results and outcome.results[stimulus].item == item


def _legend(figure: FigureBase, items: Sequence[str], labels: Mapping[str, str]) -> None:
    from matplotlib.lines import Line2D

    handles = [
        Line2D([], [], linestyle="", marker="o", markersize=4, color=COLOURS[i % len(COLOURS)],
               label=labels.get(item, item))
        for i, item in enumerate(items)
    ]  # fmt: skip
    handles.append(
        Line2D([], [], linestyle="", marker="D", markersize=4, markerfacecolor="white",
               markeredgecolor="black", label="intended")
    )  # fmt: skip
    figure.legend(handles=handles, loc="outside upper center", ncols=min(len(handles), 4), columnspacing=0.8,
                  handletextpad=0.1)  # fmt: skip


def draw_levels(outcome: Levels, labels: Mapping[str, str]) -> Drawing:
    """Share of the outcome at both levels of every principle, with Wilson intervals and counts."""
    first, second = outcome.comparison.levels
    return Drawing(
        name=outcome.name,
        paint=partial(_paint_levels, outcome=outcome, labels=labels),
        height_in=2.3,
        caption=f"Share of participants who answered “{outcome.comparison.outcome}” by intended level, "
        "with 95% Wilson intervals and counts.",
        alt="; ".join(
            f"{name}: {first} {one.choices.counts[first][0]} of {sum(one.choices.counts[first])}, "
            f"{second} {one.choices.counts[second][0]} of {sum(one.choices.counts[second])}"
            for name, one in outcome.results.items()
            if one.choices is not None
        ),
    )


def _paint_levels(figure: FigureBase, *, outcome: Levels, labels: Mapping[str, str]) -> None:
    from matplotlib.lines import Line2D

    axes = figure.add_subplot()
    names = list(outcome.results)
    looks = [*zip(outcome.comparison.levels, "^v", (COLOURS[4], COLOURS[3]), (-0.12, 0.12), strict=True)]
    for row, (level, marker, colour, aside) in enumerate(looks):
        shown = []
        _below(axes, -0.52, level, row=row, colour=colour, align="right")
        for x, one in enumerate(outcome.results.values()):
            k, other = one.choices.counts[level] if one.choices else (0, 0)
            _below(axes, x, f"{k}/{k + other}", row=row, colour=colour)
            if limits := wilson(k, k + other):
                share = k / (k + other)
                shown.append((x + aside, share, share - limits[0], limits[1] - share))
        if shown:
            places, shares, below, above = np.array(shown).T
            axes.errorbar(
                places, shares, yerr=[below, above], color=colour, marker=marker, markersize=4,
                elinewidth=0.9, capsize=2, capthick=0.9, zorder=3, linestyle="",
            )  # fmt: skip
    axes.axhline(0.5, color=INK, linewidth=0.6, linestyle=DASHED, zorder=1)
    axes.set_ylim(-0.04, 1.04)
    axes.set_xlim(-0.5, len(names) - 0.5)
    axes.set_yticks([0, 0.25, 0.5, 0.75, 1], ["0", ".25", ".50", ".75", "1"])
    axes.set_xticks(range(len(names)), [labels.get(name, name.capitalize()) for name in names])
    axes.tick_params(axis="x", length=0)
    axes.set_ylabel(f"Share “{outcome.comparison.outcome}”, 95% CI")
    handles = [
        Line2D([], [], linestyle="", marker=marker, markersize=4, color=colour, label=level)
        for level, marker, colour, _ in looks
    ]
    figure.legend(handles=handles, loc="outside upper center", ncols=2, handletextpad=0.1)


def _below(axes: Axes, x: float, text: str, *, row: int, colour: str, align: str = "center") -> None:
    """Write in a row under the names on the horizontal axis."""
    axes.annotate(
        text, (x, 0), xycoords=("data", "axes fraction"), xytext=(0, -14 - 8 * row), annotation_clip=False,
        textcoords="offset points", ha=align, va="top", fontsize=6, color=colour,
    )  # fmt: skip


def draw_compared(outcome: Levels, labels: Mapping[str, str]) -> Drawing:
    """Mean ± SE of the compared ratings at both levels, with all ratings behind."""
    first, second = outcome.comparison.levels
    item = outcome.comparison.item
    return Drawing(
        name=outcome.name,
        paint=partial(_paint_compared, outcome=outcome, labels=labels),
        height_in=2.1,
        caption=f"Rating of {labels.get(item, item)}, {first} against {second}: mean and standard error; "
        "bars behind show how many gave each rating.",
        alt="; ".join(
            f"{labels.get(name, name)}: "
            + ", ".join(
                f"{level} {'–' if m.mean is None else f'{m.mean:.2f}'} (n = {m.n})"
                for level, m in one.summaries.items()
            )
            for name, one in outcome.results.items()
        ),
    )


def _paint_compared(figure: FigureBase, *, outcome: Levels, labels: Mapping[str, str]) -> None:
    answers, comparison = outcome.answers, outcome.comparison
    assert answers.scale is not None
    axes = figure.add_subplot()
    values = answers.on(comparison.item)
    low, high = answers.scale
    items = len(answers.series.get(comparison.item, (comparison.item,)))
    bar = max(0.3 / items, (high - low) / 80)
    places, names = [], []
    for x, (name, stimuli) in enumerate(comparison.pairs.items()):
        for level, stimulus, colour, marker, aside in zip(
            comparison.levels, stimuli, (COLOURS[4], COLOURS[3]), "^v", (-0.2, 0.2), strict=True
        ):
            one = outcome.results[name].summaries[level]
            column = (x + aside, values[:, answers.stimuli.index(stimulus)])
            _strips(axes, [column], width=0.36, colour=colour, height=bar)
            if one.mean is not None:
                axes.errorbar(
                    x + aside, one.mean, yerr=one.se or 0, color=colour, ecolor=INK, marker=marker,
                    markersize=4.5, markeredgecolor="black", markeredgewidth=0.6, elinewidth=0.8, capsize=1.8,
                    capthick=0.8, zorder=5,
                )  # fmt: skip
            places.append(x + aside)
            names.append(f"{labels.get(level, level)}\nn = {one.n}")
    _scale(axes, answers.scale)
    axes.set_xlim(-0.5, len(comparison.pairs) - 0.5)
    axes.set_xticks(places, names)
    axes.tick_params(axis="x", length=0)
    judged = labels.get(comparison.item, comparison.item.capitalize())
    alone = judged if len(comparison.pairs) == 1 else ""
    axes.set_ylabel(f"{alone or 'Rating'}, mean ± SE")
    for x, name in enumerate(() if alone else comparison.pairs):
        axes.annotate(
            labels.get(name, name.capitalize()), (x, 1), xycoords=("data", "axes fraction"), ha="center",
            va="bottom",
        )  # fmt: skip
