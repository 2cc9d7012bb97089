"""What all pictures share: an empty sheet, its pixels, words, colours, badges and signs."""

from __future__ import annotations

from typing import Any, Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.text import Text
from numpy.typing import NDArray

from arm2d.drawing import FLOOR, INK
from arm2d.video import DPI

FAINT: Final = "#6B6B6B"
NEVER_MET: Final = "never met during evolution"
BADGE: Final = {"boxstyle": "round,pad=0.45", "fc": INK, "ec": "none"}
# Where things stand [px of a panel of 480 x 720], from its upper left corner.
WIDTH, HEIGHT = 480, 720
LEFT, RIGHT = 28, 452
UNLIT: Final = "#E6E3DB"
QUIET: Final = "#8A877F"


def write(axes: Axes, x: float, y: float, words: str, *, size: float, **how: Any) -> Text:
    """Words at a place, in the middle of their line."""
    return axes.text(x, y, words, fontsize=size, va="center", **{"color": INK, **how})


def rule(axes: Axes, top: float, name: str) -> None:
    """A thin line with a heading, over one group."""
    axes.plot([LEFT, RIGHT], [top - 6] * 2, color=UNLIT, lw=0.8)
    write(axes, LEFT, top + 8, name, size=9.5, weight="bold")


def mark(success: bool) -> str:
    """A sign that needs no colour."""
    return "\N{CHECK MARK}" if success else "\N{MULTIPLICATION X}"


def blank(width_px: int, height_px: int, colour: str = FLOOR) -> Figure:
    """An empty figure of this size."""
    return Figure(figsize=(width_px / DPI, height_px / DPI), dpi=DPI, facecolor=colour)


def pixels(figure: Figure) -> NDArray[np.uint8]:
    """A figure as a picture, [height, width, 3]."""
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    return np.asarray(canvas.buffer_rgba())[..., :3].copy()
