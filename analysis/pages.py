"""The report as a PDF to print or send: the main story, drawn onto A4 pages."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cache, partial
from pathlib import Path
from typing import TYPE_CHECKING

from analysis.apa import unbroken
from analysis.drawing import ALARM, FAINT, INK, STYLE, Drawing, lay_out

if TYPE_CHECKING:
    from matplotlib.backends.backend_pdf import PdfPages
    from matplotlib.figure import Figure

WIDTH_IN, HEIGHT_IN, MARGIN_IN = 210 / 25.4, 297 / 25.4, 0.85  # A4
TEXT_IN = WIDTH_IN - 2 * MARGIN_IN
LEADING, ASCENT = 1.42, 0.76  # height of a line, and of a letter above its baseline, in font sizes
FIGURE_IN = 4.7  # width of a figure on a page
BELOW_IN = 0.07  # below a paragraph and a figure
TALLEST_IN = HEIGHT_IN - 2 * MARGIN_IN - 1.5  # a figure that leaves room for its heading and caption
SHRINKS = 0.35  # of its height, which a figure gives up to stand on this page still
TABLE_PT, GAP_IN = 7.5, 0.1  # size of the text of a table; the least between two of its columns


@dataclass(frozen=True)
class Block:
    """Something that is painted in one piece, as high as it is told."""

    height: float  # inches
    paint: Callable[[float], None]
    spare: float = 0.0  # how much lower it may be


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
        self.waiting: list[Block] = []  # blocks kept with what comes next

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

    def write(
        self, text: str, *, size: float = 9, bold: bool = False, colour: str = INK, with_next: bool = False
    ) -> None:
        """A paragraph, wrapped; on the page of what comes next if so told."""
        lines = [*_wrapped(unbroken(text), size=size, bold=bold)]
        height = size / 72 * LEADING

        def paint(_: float) -> None:
            for line in lines:
                self._room(height)
                self._text(MARGIN_IN, line, size=size, bold=bold, colour=colour)
                self.y -= height
            self.y -= BELOW_IN

        self._place(Block(height * len(lines) + BELOW_IN, paint), with_next=with_next)

    def heading(self, text: str, *, size: float = 12.5) -> None:
        """A heading, on the page of what comes next."""
        self._place(Block(0.14, self._down), with_next=True)
        self.write(text, size=size, bold=True, with_next=True)

    def draw(self, drawing: Drawing) -> None:
        """A figure with its caption, lower where it would else leave half a page empty."""
        height = min(drawing.height_in * FIGURE_IN / 3.5 * 0.9, TALLEST_IN)
        self._place(
            Block(height + BELOW_IN, partial(self._paint, drawing), spare=SHRINKS * height), with_next=True
        )
        self.write(drawing.caption, size=7.5, colour=FAINT)

    def tabulate(self, head: Sequence[str], rows: Iterable[Sequence[str]]) -> None:
        """A table as wide as the page; the first column is text, the others numbers."""
        body = [list(row) for row in rows]
        height = TABLE_PT / 72 * 1.75
        widths, size = _columns([head, *body])

        def paint(_: float) -> None:
            self._row(head, widths, size=size, bold=True)
            self._rule()
            for row in body:
                self._room(height)
                self._row(row, widths, size=size)
                self.y -= height
            self.y -= 0.12

        self._place(Block(height * min(len(body) + 2, 12), paint))

    def _place(self, block: Block, *, with_next: bool = False) -> None:
        """Paint a block and those that wait for it, all on one page if a page can hold them."""
        self.waiting.append(block)
        if not with_next:
            for one in self._fitted(self.waiting):
                one.paint(one.height)
            self.waiting.clear()

    def _fitted(self, blocks: Sequence[Block]) -> Sequence[Block]:
        """The blocks as high as this page lets them, if they can spare so much; else whole, on the next."""
        lacking = sum(block.height for block in blocks) - (self.y - MARGIN_IN)
        spare = sum(block.spare for block in blocks)
        if 0 < lacking <= spare:
            return [replace(block, height=block.height - lacking * block.spare / spare) for block in blocks]
        self._room(sum(block.height for block in blocks))
        return blocks

    def _down(self, height: float) -> None:
        self.y -= height

    def _paint(self, drawing: Drawing, room: float) -> None:
        from matplotlib.gridspec import GridSpec

        assert self.page is not None
        height = room - BELOW_IN
        left = (WIDTH_IN - FIGURE_IN) / 2
        grid = GridSpec(
            3, 3, self.page, width_ratios=[left, FIGURE_IN, left],
            height_ratios=[HEIGHT_IN - self.y, height, self.y - height], hspace=0, wspace=0,
        )  # fmt: skip
        part = self.page.add_subfigure(grid[1, 1])
        drawing.onto(part)
        if height < drawing.height_in:  # the margins of the taller figure are too narrow
            lay_out(self.page)
        else:
            for axes, laid_out in zip(part.axes, drawing.figure.axes, strict=True):
                axes.set_position(laid_out.get_position())
        self.y -= room

    def _row(self, cells: Sequence[str], widths: Sequence[float], *, size: float, bold: bool = False) -> None:
        right = MARGIN_IN
        for place, (cell, width) in enumerate(zip(cells, widths, strict=True)):
            left, right = right, right + width
            x, align = (left, "left") if place == 0 else (right, "right")
            self._text(x, cell, size=size, bold=bold, align=align)

    def _rule(self) -> None:
        from matplotlib.lines import Line2D

        assert self.page is not None
        self.y -= TABLE_PT / 72 * 1.6
        level = (self.y + 0.04) / HEIGHT_IN
        self.page.add_artist(
            Line2D([MARGIN_IN / WIDTH_IN, 1 - MARGIN_IN / WIDTH_IN], [level, level], color=INK, linewidth=0.6)
        )
        self.y -= 0.03

    def _text(
        self, x: float, text: str, *, size: float, bold: bool = False, colour: str = INK, align: str = "left"
    ) -> None:
        from analysis.line import Line

        assert self.page is not None
        if align == "right":
            x -= _width_in(text, size=size, bold=bold)
        place = (x / WIDTH_IN, (self.y - size / 72 * ASCENT) / HEIGHT_IN)
        weight = "bold" if bold else "normal"
        self.page.add_artist(Line(*place, text, fontsize=size, fontweight=weight, color=colour))

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
            self.pdf.savefig(self.page)  # type: ignore[no-untyped-call]


def _wrapped(text: str, *, size: float, bold: bool) -> Iterator[str]:
    """The lines of a paragraph, as wide as the page."""
    line, *words = text.split(" ")
    for word in words:
        if _width_in(f"{line} {word}", size=size, bold=bold) > TEXT_IN:
            yield line
            line = word
        else:
            line += f" {word}"
    yield line


def _columns(rows: Sequence[Sequence[str]]) -> tuple[list[float], float]:
    """Widths in inches of the columns, which fill the page, and the size of text that fits them."""
    widths = [
        max(_width_in(cell, size=TABLE_PT, bold=True) for cell in column)
        for column in zip(*rows, strict=True)
    ]
    needed, gaps = sum(widths), GAP_IN * (len(widths) - 1)
    shrunk = min(1, (TEXT_IN - gaps) / needed)
    spare = (TEXT_IN - needed * shrunk) / max(1, len(widths) - 1)
    return [width * shrunk + spare * (place > 0) for place, width in enumerate(widths)], TABLE_PT * shrunk


def _width_in(text: str, *, size: float, bold: bool) -> float:
    """How wide a text is printed."""
    return sum(_advance(character, bold=bold) for character in text) * size / 72


@cache
def _advance(character: str, *, bold: bool) -> float:
    """The width of a character, in sizes of its font."""
    from matplotlib.font_manager import FontProperties, findfont, get_font

    font = get_font(
        findfont(FontProperties(family=STYLE["font.family"], weight="bold" if bold else "normal"))
    )
    font.set_size(100, 72)
    return float(font.load_char(ord(character)).linearHoriAdvance) / 65536 / 100
