"""A figure that can be drawn into a paper's column or onto a page, with the same bytes every time.

Colours are Okabe & Ito's, told apart with any colour vision; no figure relies on colour alone.
"""

from __future__ import annotations

import io
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import cached_property, wraps
from pathlib import Path
from typing import TYPE_CHECKING, Any, ParamSpec, TypeVar

if TYPE_CHECKING:
    from matplotlib.figure import Figure, FigureBase

COLOURS = ("#E69F00", "#56B4E9", "#009E73", "#0072B2", "#D55E00", "#CC79A7", "#000000", "#F0E442")
INK, FAINT, ALARM = "#222222", "#6A6A6A", "#A3301C"
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
    "ps.fonttype": 42,  # matplotlib's PDFs take the size of subsets from here: each font is embedded once
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


def lay_out(figure: Figure) -> None:
    """Place everything, once; a figure with a layout engine would be drawn twice for each file.

    Places are rounded, as the last digits of a layout differ from run to run.
    """
    from matplotlib.layout_engine import ConstrainedLayoutEngine

    if figure.axes:
        ConstrainedLayoutEngine().execute(figure)
    for axes in figure.axes:
        left, bottom, width, height = (round(float(place), 6) for place in axes.get_position().bounds)
        axes.set_position((left, bottom, width, height))


@contextmanager
def _lean_fonts() -> Iterator[None]:
    """Embed fonts without their rules for setting text: it is set already, and reading them takes longest.

    matplotlib hands no choice of tables on to fontTools, so fontTools' default is another meanwhile.
    """
    from fontTools.subset import Options

    dropped = Options._drop_tables_default
    Options._drop_tables_default = [*dropped, "GSUB", "GPOS", "GDEF"]
    try:
        yield
    finally:
        Options._drop_tables_default = dropped


@dataclass(frozen=True)
class Drawing:
    """A figure with what a caption says of it, and what it says to someone who cannot see it."""

    name: str
    paint: Callable[[FigureBase], None]
    height_in: float
    caption: str
    alt: str
    note: str = ""  # what nobody may miss, such as that the data are simulated

    def noting(self, note: str) -> Drawing:
        """The same figure with a note, in the picture and in its words."""
        if not note:
            return self
        return replace(self, note=note, caption=f"{note}. {self.caption}", alt=f"{note}. {self.alt}")

    def onto(self, figure: FigureBase) -> None:
        """Draw onto a figure, or a part of one."""
        self.paint(figure)
        if self.note:
            figure.supxlabel(self.note, fontsize=6, color=ALARM)

    @cached_property
    def figure(self) -> Figure:
        """As a figure of its own, as wide as a column."""
        from matplotlib.figure import Figure

        figure = Figure(figsize=(COLUMN_IN, self.height_in))
        self.onto(figure)
        lay_out(figure)
        return figure

    def write(self, folder: Path) -> None:
        """Write NAME.svg, NAME.pdf and NAME.png, none with a date."""
        (folder / f"{self.name}.svg").write_bytes(self._bytes("svg", {"Date": None, "Title": self.caption}))
        with _lean_fonts():
            (folder / f"{self.name}.pdf").write_bytes(self._bytes("pdf", {"CreationDate": None}))
        (folder / f"{self.name}.png").write_bytes(self._bytes("png", {"Software": None}))

    @styled
    def _bytes(self, form: str, metadata: Mapping[str, str | None]) -> bytes:
        file = io.BytesIO()
        self.figure.savefig(file, format=form, metadata=dict(metadata))
        return file.getvalue()
