"""The report as a PDF to print or send: the main story, drawn onto A4 pages."""

from __future__ import annotations

import textwrap
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from analysis.drawing import ALARM, FAINT, INK, STYLE, Drawing, lay_out

if TYPE_CHECKING:
    from matplotlib.backends.backend_pdf import PdfPages
    from matplotlib.figure import Figure

WIDTH_IN, HEIGHT_IN, MARGIN_IN = 210 / 25.4, 297 / 25.4, 0.85  # A4
TEXT_IN = WIDTH_IN - 2 * MARGIN_IN
LEADING = 1.42  # line height, in font sizes
FIGURE_IN = 5.2  # width of a figure on a page
STEPS_IN = {"title": 0.12, "heading": 0.09, "text": 0.07}  # below each


class Pages:
    """A PDF written from top to bottom; a new page begins where a block no longer fits."""

    def __init__(self, path: Path, title: str, footer: str, alarm: str = "") -> None:
        from matplotlib import rc_context

        # type 3 is enough for a screen and a printer
        self._style = rc_context({**STYLE, "pdf.fonttype": 3, "ps.fonttype": 3})
        self.path, self.title, self.footer, self.alarm = path, title, footer, alarm
        self.page: Figure | None = None
        self.number = 0
        self.y = 0.0  # inches above the lower edge

    def __enter__(self) -> Pages:
        from matplotlib.backends.backend_pdf import PdfPages

        self._style.__enter__()
        self.pdf: PdfPages = PdfPages(
            self.path, metadata={"Title": self.title, "CreationDate": None, "ModDate": None}
        )
        self._turn()
        return self

    def __exit__(self, *fault: object) -> None:
        self._finish()
        self.pdf.close()  # type: ignore[no-untyped-call]
        self._style.__exit__(None, None, None)

    def write(self, text: str, *, size: float = 9, bold: bool = False, colour: str = INK) -> None:
        """A paragraph, wrapped."""
        widest = int(TEXT_IN * 72 / size / (0.58 if bold else 0.505))
        lines = textwrap.wrap(text, widest) or [""]
        height = size / 72 * LEADING
        for line in lines:
            self._room(height)
            self._text(MARGIN_IN, line, size=size, bold=bold, colour=colour)
            self.y -= height
        self.y -= STEPS_IN["text"]

    def heading(self, text: str, *, size: float = 12.5) -> None:
        """A heading, never alone at the foot of a page."""
        self._room(1.2)
        self.y -= 0.14
        self.write(text, size=size, bold=True)

    def draw(self, drawing: Drawing) -> None:
        """A figure with its caption."""
        from matplotlib.gridspec import GridSpec

        height = drawing.height_in * FIGURE_IN / 3.5 * 0.9
        self._room(height + 0.6)
        assert self.page is not None
        left = (WIDTH_IN - FIGURE_IN) / 2
        grid = GridSpec(
            3, 3, self.page, width_ratios=[left, FIGURE_IN, left],
            height_ratios=[HEIGHT_IN - self.y, height, self.y - height], hspace=0, wspace=0,
        )  # fmt: skip
        drawing.onto(self.page.add_subfigure(grid[1, 1]))
        self.y -= height + 0.08
        self.write(drawing.caption, size=7.5, colour=FAINT)

    def tabulate(self, head: Sequence[str], rows: Iterable[Sequence[str]], widths: Sequence[float]) -> None:
        """A table; the first column is text, the others numbers. `widths` are shares of the page."""
        body = [list(row) for row in rows]
        height = 7.5 / 72 * 1.75
        self._room(height * min(len(body) + 1, 12))
        self._row(head, widths, bold=True)
        self._rule()
        for row in body:
            self._room(height)
            self._row(row, widths)
            self.y -= height
        self.y -= 0.12

    def _row(self, cells: Sequence[str], widths: Sequence[float], *, bold: bool = False) -> None:
        right = MARGIN_IN
        for place, (cell, width) in enumerate(zip(cells, widths, strict=True)):
            left, right = right, right + width * TEXT_IN
            x, align = (left, "left") if place == 0 else (right, "right")
            self._text(x, cell, size=7.5, bold=bold, align=align)

    def _rule(self) -> None:
        from matplotlib.lines import Line2D

        assert self.page is not None
        self.y -= 7.5 / 72 * 1.6
        level = (self.y + 0.04) / HEIGHT_IN
        self.page.add_artist(
            Line2D([MARGIN_IN / WIDTH_IN, 1 - MARGIN_IN / WIDTH_IN], [level, level], color=INK, linewidth=0.6)
        )
        self.y -= 0.03

    def _text(
        self, x: float, text: str, *, size: float, bold: bool = False, colour: str = INK, align: str = "left"
    ) -> None:
        assert self.page is not None
        self.page.text(
            x / WIDTH_IN, self.y / HEIGHT_IN, text, fontsize=size, fontweight="bold" if bold else "normal",
            color=colour, ha=align, va="top", parse_math=False,
        )  # fmt: skip

    def _room(self, height: float) -> None:
        if self.y - height < MARGIN_IN:
            self._turn()

    def _turn(self) -> None:
        from matplotlib.figure import Figure

        self._finish()
        self.page = Figure(figsize=(WIDTH_IN, HEIGHT_IN))
        self.number += 1
        self.y = 0.55
        self._text(MARGIN_IN, self.footer, size=6.5, colour=FAINT)
        self._text(WIDTH_IN - MARGIN_IN, str(self.number), size=6.5, colour=FAINT, align="right")
        self.y = HEIGHT_IN - 0.35
        if self.alarm:
            self._text(MARGIN_IN, self.alarm, size=9, bold=True, colour=ALARM)
        self.y = HEIGHT_IN - MARGIN_IN

    def _finish(self) -> None:
        if self.page is not None:
            lay_out(self.page)
            self.pdf.savefig(self.page)  # type: ignore[no-untyped-call]
