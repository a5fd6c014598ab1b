"""Pages of a PDF: what belongs together stands together, and nothing overlaps or leaves the page."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path

import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import FigureBase

from analysis.drawing import Drawing
from analysis.line import Line
from analysis.pages import MARGIN_IN, Pages

LONG = "a sentence of many words, some of them iiiiiiii and some WWWWWWWW, p = .014, 95% CI [0.06, 1.03] " * 4
NAMES = ["Rating", "means", "t", "df", "d [95% CI]", "difference [95% CI]"]
FIGURE = Drawing(name="f", paint=lambda figure: None, height_in=2, caption=LONG, alt="")


def lines(pages: Pages) -> list[Line]:
    assert pages.page is not None
    return [artist for artist in pages.page.artists if isinstance(artist, Line)]


def texts(pages: Pages) -> list[str]:
    return [line.get_text() for line in lines(pages)]


@pytest.mark.parametrize("lines", range(20, 56, 7))
def test_a_heading_stands_on_the_page_of_its_figure_and_the_caption_too(tmp_path: Path, lines: int) -> None:
    with Pages(tmp_path / "p.pdf", "T", "footer") as pages:
        for _ in range(lines):
            pages.write("filled")
        before = pages.number
        pages.heading("Effect sizes")
        pages.write("How they were tested.", with_next=True)
        pages.draw(FIGURE)
        here = texts(pages)
        assert "Effect sizes" in here and "How they were tested." in here
        assert any(text.startswith("a sentence") for text in here)
        assert pages.number - before <= 1


def test_a_figure_is_drawn_lower_rather_than_leave_half_a_page_empty(tmp_path: Path) -> None:
    figure = Drawing(name="f", paint=lambda figure: None, height_in=3, caption="Its caption.", alt="")
    with Pages(tmp_path / "p.pdf", "T", "") as pages:
        while pages.y > 4.5:
            pages.write("filled")
        pages.heading("Effect sizes")
        pages.draw(figure)
        assert pages.number == 1
        assert {"Effect sizes", "Its caption."} < set(texts(pages))
        assert pages.y >= MARGIN_IN - 0.01


def named_axis(figure: FigureBase) -> None:
    figure.add_subplot().set_xlabel("Cohen's d, 95% CI")


@pytest.mark.parametrize("room", [6.0, 4.0, 3.5])
def test_a_note_in_a_figure_that_is_drawn_lower_keeps_clear_of_its_axis(tmp_path: Path, room: float) -> None:
    figure = Drawing(name="f", paint=named_axis, height_in=3, caption="Its caption.", alt="")
    with Pages(tmp_path / "p.pdf", "T", "") as pages:
        pages.y = room
        pages.draw(figure.noting("Simulated answers, no data"))
        assert pages.page is not None
        FigureCanvasAgg(pages.page).draw()
        drawn = pages.page.subfigs[0]
        note = next(text for text in drawn.texts if text.get_text().startswith("Simulated"))
        label = drawn.axes[0].xaxis.label
        assert note.get_window_extent().y1 < label.get_window_extent().y0


def test_a_figure_taller_than_a_page_is_drawn_smaller(tmp_path: Path) -> None:
    with Pages(tmp_path / "p.pdf", "T", "footer") as pages:
        pages.heading("Effect sizes")
        pages.draw(Drawing(name="f", paint=lambda figure: None, height_in=20, caption="Many.", alt=""))
        assert {"Effect sizes", "Many."} < set(texts(pages))
        assert pages.number == 1


@pytest.mark.parametrize("columns", [2, 6])
def test_columns_of_a_table_never_touch_and_lines_end_before_the_margin(tmp_path: Path, columns: int) -> None:
    row = ["Anthropomorphism of the robot seen from behind", "14.43 / 13.53", "−13.03", "66", "< .001"]
    with Pages(tmp_path / "p.pdf", "T", "") as pages:
        pages.tabulate(NAMES[:columns], [[*row, "0.90 [−10.24, 11.56] " * 4][:columns]])
        pages.write(LONG)
        assert pages.page is not None
        FigureCanvasAgg(pages.page)
        boxes = [text.get_window_extent() for text in lines(pages) if text.get_text()]
        right = pages.page.bbox.width - boxes[0].width / 2
        for one, other in pairwise(boxes[1 : 1 + 2 * columns]):
            assert other.y0 < one.y0 - 1 or other.x0 > one.x1
        assert max(box.x1 for box in boxes) < right
