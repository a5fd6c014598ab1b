"""Figures for a paper: drawn once, written as SVG, PDF and PNG with the same bytes every time.

Colours are Okabe & Ito's, told apart with any colour vision; no figure relies on colour alone.
"""

from __future__ import annotations

import io
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property, wraps
from pathlib import Path
from typing import TYPE_CHECKING, Any, ParamSpec, TypeVar

import numpy as np

from analysis.dataset import FloatArray
from analysis.plan import Levels, Targets
from analysis.statistics.wilson import wilson

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

COLOURS = ("#E69F00", "#56B4E9", "#009E73", "#0072B2", "#D55E00", "#CC79A7", "#000000", "#F0E442")
INK, FAINT = "#222222", "#8A8A8A"
COLUMN_IN = 3.5  # width of a column of a two-column paper
STYLE: Any = {  # of matplotlib
    "font.family": "DejaVu Sans",
    "font.size": 7,
    "axes.labelsize": 7,
    "axes.linewidth": 0.6,
    "axes.edgecolor": INK,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "xtick.labelsize": 7,
    "ytick.labelsize": 7,
    "xtick.major.width": 0.6,
    "ytick.major.width": 0.6,
    "legend.fontsize": 6.5,
    "legend.frameon": False,
    "svg.hashsalt": "analysis",
    "svg.fonttype": "path",
    "pdf.fonttype": 42,
    "savefig.dpi": 300,
}


P = ParamSpec("P")
R = TypeVar("R")


def styled(function: Callable[P, R]) -> Callable[P, R]:
    """Do it in our style, whatever matplotlib's settings are."""

    @wraps(function)
    def within(*args: P.args, **kwargs: P.kwargs) -> R:
        from matplotlib import rc_context

        with rc_context(STYLE):
            return function(*args, **kwargs)

    return within


@dataclass(frozen=True)
class Drawing:
    """A figure with what a caption says of it, and what it says to someone who cannot see it."""

    name: str
    figure: Figure
    caption: str
    alt: str

    @cached_property
    def svg(self) -> str:
        """As SVG, without a date."""
        return self._bytes("svg", {"Date": None, "Title": self.caption}).decode()

    def write(self, folder: Path) -> None:
        """Write NAME.svg, NAME.pdf and NAME.png."""
        (folder / f"{self.name}.svg").write_text(self.svg, encoding="utf-8")
        (folder / f"{self.name}.pdf").write_bytes(self._bytes("pdf", {"CreationDate": None}))
        (folder / f"{self.name}.png").write_bytes(self._bytes("png", {"Software": None}))

    @styled
    def _bytes(self, form: str, metadata: Mapping[str, str | None]) -> bytes:
        file = io.BytesIO()
        self.figure.savefig(file, format=form, metadata=dict(metadata))
        return file.getvalue()


@styled
def draw_targets(outcome: Targets, labels: Mapping[str, str]) -> Drawing:
    """Mean ± SE of every item for every stimulus, with all ratings behind and the target marked."""
    answers, scale = outcome.answers, outcome.answers.scale
    assert scale is not None
    figure, axes = _canvas(height_in=2.35)
    width = 0.84 / len(answers.items)
    for s, stimulus in enumerate(answers.stimuli):
        for i, item in enumerate(answers.items):
            x = s + (i - (len(answers.items) - 1) / 2) * width
            target = stimulus in outcome.results and outcome.results[stimulus].item == item
            _strip(axes, answers.ratings[:, s, i], x=x, width=width, colour=COLOURS[i % len(COLOURS)])
            _mean(axes, outcome, stimulus, item, x=x, colour=COLOURS[i % len(COLOURS)], target=target)
    level = next(iter(outcome.results.values())).against.null
    if scale[0] <= level <= scale[1]:
        axes.axhline(level, color=INK, linewidth=0.6, linestyle=(0, (4, 3)), zorder=1)
        axes.annotate(
            f"chance\n({outcome.chance})", (1, level), xycoords=("axes fraction", "data"), xytext=(2, 0),
            textcoords="offset points", ha="left", va="center", fontsize=5.5, color=INK,
        )  # fmt: skip
    axes.set_xlim(-0.5, len(answers.stimuli) - 0.5)
    axes.set_ylim(scale[0] - 0.25, scale[1] + 0.25)
    axes.set_yticks(np.arange(scale[0], scale[1] + 1))
    axes.set_xticks(range(len(answers.stimuli)), [labels.get(s, s.capitalize()) for s in answers.stimuli])
    axes.tick_params(axis="x", length=0)
    axes.set_xlabel("Intended expression")
    axes.set_ylabel("Rating, mean ± SE")
    for s in range(1, len(answers.stimuli)):
        axes.axvline(s - 0.5, color="#DDDDDD", linewidth=0.5, zorder=0)
    _legend(figure, answers.items, labels)
    n = len(answers.participants)
    return Drawing(
        name=outcome.part,
        figure=figure,
        caption=f"Perceived expression of each clip: mean rating and standard error (N = {n}); "
        "bars behind show how many gave each rating, black diamonds mark the intended expression.",
        alt="; ".join(
            f"{labels.get(stimulus, stimulus)}: "
            + ", ".join(
                f"{labels.get(item, item)} {'–' if m.mean is None else f'{m.mean:.1f}'}"
                for item, m in items.items()
            )
            for stimulus, items in outcome.means.items()
        ),
    )


def _strip(axes: Axes, ratings: FloatArray, *, x: float, width: float, colour: str) -> None:
    """A bar per rating, as wide as its share of participants."""
    values, counts = np.unique(ratings[~np.isnan(ratings)], return_counts=True)
    if counts.size:
        shares = counts / counts.sum() * width * 0.95
        axes.barh(
            values, shares, left=x - shares / 2, height=0.3, color=colour, alpha=0.4, linewidth=0, zorder=2
        )


def _mean(
    axes: Axes, outcome: Targets, stimulus: str, item: str, *, x: float, colour: str, target: bool
) -> None:
    summary = outcome.means[stimulus][item]
    if summary.mean is None:
        return
    axes.errorbar(
        x,
        summary.mean,
        yerr=summary.se or 0,
        color=INK,
        elinewidth=0.7,
        capsize=1.2,
        capthick=0.7,
        fmt="none",
        zorder=4,
    )
    axes.plot(
        x, summary.mean, marker="D" if target else "o", markersize=4.2 if target else 2.6, zorder=5,
        markerfacecolor=colour, markeredgecolor="black" if target else colour,
        markeredgewidth=0.9 if target else 0,
    )  # fmt: skip


def _legend(figure: Figure, items: Sequence[str], labels: Mapping[str, str]) -> None:
    from matplotlib.lines import Line2D

    handles = [
        Line2D(
            [],
            [],
            linestyle="",
            marker="o",
            markersize=4,
            color=COLOURS[i % len(COLOURS)],
            label=labels.get(item, item),
        )
        for i, item in enumerate(items)
    ]
    handles.append(
        Line2D([], [], linestyle="", marker="D", markersize=4, markerfacecolor="white",
               markeredgecolor="black", label="intended")
    )  # fmt: skip
    figure.legend(handles=handles, loc="outside upper center", ncols=min(len(handles), 4), columnspacing=0.8,
                  handletextpad=0.1)  # fmt: skip


@styled
def draw_levels(outcome: Levels, labels: Mapping[str, str]) -> Drawing:
    """Share of the outcome at both levels of each principle, with Wilson intervals and counts."""
    from matplotlib.lines import Line2D

    figure, axes = _canvas(height_in=1.9)
    looks = (("o", COLOURS[4], 1), ("v", COLOURS[3], -1))
    names = list(outcome.results)
    for x, one in enumerate(outcome.results.values()):
        if one.choices is None:
            continue
        for (k, other), (marker, colour, side) in zip(one.choices.counts.values(), looks, strict=True):
            limits = wilson(k, k + other)
            if limits is None:
                continue
            share = k / (k + other)
            axes.errorbar(
                x - 0.12 * side, share, yerr=[[share - limits[0]], [limits[1] - share]], color=colour,
                marker=marker, markersize=4, elinewidth=0.9, capsize=2, capthick=0.9, zorder=3,
                linestyle="",
            )  # fmt: skip
            axes.annotate(
                f"{k}/{k + other}", (x - 0.12 * side, share), xytext=(-5 * side, 0),
                textcoords="offset points", ha="right" if side > 0 else "left", va="center",
                fontsize=5, color=INK,
            )  # fmt: skip
    axes.axhline(0.5, color=INK, linewidth=0.6, linestyle=(0, (4, 3)), zorder=1)
    axes.set_ylim(-0.04, 1.04)
    axes.set_xlim(-0.75, len(names) - 0.4)
    axes.set_yticks([0, 0.25, 0.5, 0.75, 1], ["0", ".25", ".50", ".75", "1"])
    axes.set_xticks(range(len(names)), [labels.get(name, name.capitalize()) for name in names])
    axes.tick_params(axis="x", length=0)
    axes.set_ylabel(f"Share “{outcome.comparison.outcome}”, 95% CI")
    first, second = outcome.comparison.levels
    handles = [
        Line2D([], [], linestyle="", marker=marker, markersize=4, color=colour, label=level)
        for level, (marker, colour, _) in zip((first, second), looks, strict=True)
    ]
    figure.legend(handles=handles, loc="outside upper center", ncols=2, handletextpad=0.1)
    return Drawing(
        name=outcome.part,
        figure=figure,
        caption=f"Share of participants who answered “{outcome.comparison.outcome}” by intended level, "
        "with 95% Wilson intervals and counts.",
        alt="; ".join(
            f"{name}: {first} {one.choices.counts[first][0]} of {sum(one.choices.counts[first])}, "
            f"{second} {one.choices.counts[second][0]} of {sum(one.choices.counts[second])}"
            for name, one in outcome.results.items()
            if one.choices is not None
        ),
    )


def _canvas(height_in: float, width_in: float = COLUMN_IN) -> tuple[Figure, Axes]:
    from matplotlib.figure import Figure

    figure = Figure(figsize=(width_in, height_in), layout="constrained")
    return figure, figure.add_subplot()
