"""A line of text on a page, drawn without being measured first, which would take as long again."""

from __future__ import annotations

from matplotlib.backend_bases import RendererBase
from matplotlib.text import Text


class Line(Text):
    """Horizontal text that starts where its baseline is told to: nothing is left to find out."""

    def draw(self, renderer: RendererBase) -> None:
        """Write it."""
        x, baseline = self.get_transform().transform(self.get_position())
        colour = renderer.new_gc()
        colour.set_foreground(self.get_color())
        renderer.draw_text(colour, x, baseline, self.get_text(), self.get_fontproperties(), 0)
        colour.restore()
