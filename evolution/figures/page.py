"""A figure as bytes: PNG, or an SVG that stays small whatever is drawn.

An SVG that would be too large keeps its words, axes and marks as a drawing; its dense layers (lines, filled
areas and collections, such as 6000 generations in a strip) become pixels inside it.
"""

from __future__ import annotations

import io
import re
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Final

import matplotlib as mpl
from matplotlib.artist import Artist
from matplotlib.figure import Figure

from evolution.figures.style import STYLE

# Largest SVG [bytes], unless its words alone take more.
LARGEST_DRAWING: Final = 400_000
# Resolutions of dense layers, tried in turn until the drawing is small enough [dots per inch].
LAYER_RESOLUTIONS: Final = (220, 160, 110, 80)
RESOLUTION: Final = 200  # of a PNG, likewise
PATH: Final = re.compile(rb' (?:d|x|y)="[^"]*"')
INDENT: Final = re.compile(rb"\n +")
DIGITS: Final = re.compile(rb"(\.\d{2})\d+")


def png_bytes(figure: Figure, resolution: int = RESOLUTION) -> bytes:
    """The figure as pixels."""
    return _saved(figure, "png", resolution)


def svg_bytes(figure: Figure) -> bytes:
    """The figure as a drawing of at most `LARGEST_DRAWING` bytes, its dense layers as pixels if need be."""
    drawing = shortened(_saved(figure, "svg", RESOLUTION))
    for resolution in LAYER_RESOLUTIONS:
        if len(drawing) <= LARGEST_DRAWING:
            break
        with _dense_layers_as_pixels(figure):
            drawing = shortened(_saved(figure, "svg", resolution))
    return drawing


def shortened(drawing: bytes) -> bytes:
    """A drawing exact to a hundredth of a point, which no screen can tell, without indents."""
    return INDENT.sub(b"\n", PATH.sub(lambda path: DIGITS.sub(rb"\1", path.group()), drawing))


@contextmanager
def _dense_layers_as_pixels(figure: Figure) -> Iterator[None]:
    """While open, patches, lines and collections of all axes are drawn as pixels."""
    layers: list[Artist] = [
        each for axes in figure.axes for each in (*axes.collections, *axes.patches, *axes.lines)
    ]
    before = [each.get_rasterized() for each in layers]
    for each in layers:
        each.set_rasterized(True)
    try:
        yield
    finally:
        for each, old in zip(layers, before, strict=True):
            each.set_rasterized(old)


def _saved(figure: Figure, kind: str, resolution: int) -> bytes:
    buffer = io.BytesIO()
    # Without a date, the same figure is the same file.
    metadata = {"Date": None} if kind == "svg" else None
    with mpl.rc_context(STYLE):
        figure.savefig(buffer, format=kind, dpi=resolution, facecolor="white", metadata=metadata)
    return buffer.getvalue()
