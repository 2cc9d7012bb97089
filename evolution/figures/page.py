"""What all figures share: fonts, colours that are no data, a head; and how a figure becomes a file.

A figure is written as PNG and as an SVG that stays small whatever is drawn. An SVG that would be too large
keeps its words, axes and marks as a drawing; its dense layers (lines, filled areas and collections, such as
6000 generations in a strip) become pixels inside it.
"""

from __future__ import annotations

import io
import re
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Final

from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.colors import LinearSegmentedColormap
from matplotlib.figure import Figure

from arm2d.drawing import INK, look
from evolution.runs.storage import write_atomically

FAINT: Final = "#767676"
STYLE: Final[dict[Any, Any]] = {
    "font.family": "DejaVu Sans",
    "font.size": 10.0,
    "axes.edgecolor": FAINT,
    "axes.labelcolor": INK,
    "text.color": INK,
    "xtick.color": INK,
    "ytick.color": INK,
    "svg.fonttype": "path",
    "svg.hashsalt": "wordarm",
}
# Coordinates of a place at the right end of a panel, at a height of the data.
RIGHT_END: Final = ("axes fraction", "data")
# Paper white at 0 % to deep teal at 100 %, lightness falling evenly.
SUCCESS_MAP: Final = LinearSegmentedColormap.from_list(
    "success", ["#F7F7F4", "#BBD6D2", "#5A9FA0", "#12545F"]
)

# Largest SVG [bytes], unless its words alone take more.
LARGEST_DRAWING: Final = 400_000
# Resolutions of dense layers, tried in turn until the drawing is small enough [dots per inch].
LAYER_RESOLUTIONS: Final = (220, 160, 110, 80)
RESOLUTION: Final = 200  # of a PNG, likewise
PATH: Final = re.compile(rb' (?:d|x|y)="[^"]*"')
INDENT: Final = re.compile(rb"\n +")
DIGITS: Final = re.compile(rb"(\.\d{2})\d+")


def head(figure: Figure, title: str, origin: str, left: float = 0.015) -> None:
    """Title and provenance at the top of a page, at the same distance from its edge on every page."""
    height = figure.get_size_inches()[1]
    figure.text(left, 1 - 0.32 / height, title, fontsize=15, fontweight="bold")
    figure.text(left, 1 - 0.54 / height, origin, fontsize=9, color=FAINT)


def beside(
    axes: Axes, text: str, place: tuple[float, float], offset: tuple[float, float], **style: Any
) -> None:
    """Text so many points away from a place of the data, even where no data are drawn."""
    axes.annotate(text, place, offset, textcoords="offset points", annotation_clip=False, **style)


def ink_on(share: float) -> str:
    """The colour of text on that of a share in `SUCCESS_MAP`."""
    return "white" if share > 0.55 else INK


def save_figure(figure: Figure, stem: Path | str) -> list[Path]:
    """Write a figure as PNG and SVG beside each other; both paths.

    Raises:
        OSError: If they cannot be written; then neither is left half-written.
    """
    paths, stem = [], Path(stem)
    for suffix, data in (("png", png_bytes(figure)), ("svg", svg_bytes(figure))):
        paths.append(stem.with_name(f"{stem.name}.{suffix}"))
        write_atomically(paths[-1], data)
    return paths


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
        layer for axes in figure.axes for layer in (*axes.collections, *axes.patches, *axes.lines)
    ]
    before = [layer.get_rasterized() for layer in layers]
    for layer in layers:
        layer.set_rasterized(True)
    try:
        yield
    finally:
        for layer, old in zip(layers, before, strict=True):
            layer.set_rasterized(old)


def _saved(figure: Figure, kind: str, resolution: int) -> bytes:
    buffer = io.BytesIO()
    # Without a date, the same figure is the same file.
    metadata = {"Date": None} if kind == "svg" else None
    with look(STYLE):
        figure.savefig(buffer, format=kind, dpi=resolution, facecolor="white", metadata=metadata)
    return buffer.getvalue()
