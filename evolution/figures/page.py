"""What all figures share: colours, a head; and how a figure becomes a file.

Widths, letters and lines stand in `arm2d.drawing`, where the robot's figures find them too.

A figure is written as PNG and as an SVG that stays small whatever is drawn. An SVG that would be too large
keeps its words, axes and marks as a drawing; its dense layers (lines, filled areas and collections, such as
6000 generations in a strip) become pixels inside it.
"""

from __future__ import annotations

import io
import re
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from textwrap import wrap
from typing import Any, Final

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.colors import LinearSegmentedColormap, to_rgb
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from numpy.typing import NDArray

from arm2d import Condition
from arm2d.drawing import INK, QUIET, SMALL, STYLE, TITLE, look
from evolution.agents.subtasks import AgentClass
from evolution.runs.storage import write_atomically

FAINT: Final = QUIET
# What is ours, and what stands in the paper, wherever the two are set side by side.
OURS: Final = "#12545F"
PAPER: Final = INK
PAPER_DASHES: Final = (0, (4, 3))
# Things without an order, such as seeds and experiments; clear of the objects' blue, green and red.
SERIES: Final = (
    OURS, "#C2782B", "#7B5EA7", "#8FB3CC", "#B0296F", "#E3B23C", "#444444", "#5A9FA0", "#A08060", "#C9A5CE",
)  # fmt: skip
CLASS_COLOURS: Final = {
    AgentClass.FULL: "#B0296F",
    AgentClass.PARTIAL: "#E69F00",
    AgentClass.NONE: "#7A7A7A",
}
# What neurons follow. Words are no objects either.
SHARE_COLOURS: Final = {"object": "#A08060", "action": "#5B4B8A", "crossed": "#B58BB8", "rest": "#E6E3DC"}
CONDITION_COLOURS: Final = {Condition.WITH_INDICATE: OURS, Condition.WITH_IGNORE: "#C2782B"}
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
RESOLUTION: Final = 300  # of a PNG, likewise: what printers ask for
POINTS_PER_INCH: Final = 72
PATH: Final = re.compile(rb' (?:d|x|y)="[^"]*"')
INDENT: Final = re.compile(rb"\n +")
DIGITS: Final = re.compile(rb"(\.\d{2})\d+")


def head(figure: Figure, title: str, origin: str, left: float = 0.015) -> None:
    """Title and provenance at the top of a page, at the same distance from its edge on every page.

    Provenance that is too long for a line has a second one, for which every page leaves room.
    """
    width, height = figure.get_size_inches()
    letters = int((1 - left) * width * POINTS_PER_INCH / (0.56 * SMALL))
    figure.text(left, 1 - 0.2 / height, title, fontsize=TITLE, fontweight="bold")
    origin = "\n".join(wrap(origin, letters, max_lines=2, placeholder=" …"))
    figure.text(left, 1 - 0.26 / height, origin, fontsize=SMALL, color=FAINT, va="top", linespacing=1.15)


def headed(figure: Figure, title: str, origin: str) -> None:
    """The same for a page whose layout is found by Matplotlib: it keeps clear of the head."""
    head(figure, title, origin)
    engine = figure.get_layout_engine()
    if engine is not None:
        lines = len(figure.texts[-1].get_text().splitlines())
        taken = (0.3 + 0.11 * lines) / figure.get_size_inches()[1]
        engine.set(rect=(0, 0, 1, 1 - taken))  # pyright: ignore[reportCallIssue] - of a constrained one


def paper_handle(name: str = "the paper") -> Line2D:
    """The legend's entry for the dashed line of a published number."""
    return Line2D([], [], color=PAPER, lw=1.0, ls=PAPER_DASHES, label=name)


def beside(
    axes: Axes, text: str, place: tuple[float, float], offset: tuple[float, float], **style: Any
) -> None:
    """Text so many points away from a place of the data, even where no data are drawn."""
    axes.annotate(text, place, offset, textcoords="offset points", annotation_clip=False, **style)


def draw_alike(axes: Axes, paths: Sequence[NDArray[np.float64]], **style: Any) -> None:
    """Draw paths [K, 2] of one look as one line with gaps: hundreds of lines take most of a page's time."""
    if paths:
        gap = np.full((1, 2), np.nan)
        axes.plot(*np.concatenate([part for path in paths for part in (path, gap)])[:-1].T, **style)


def ink_on(share: float) -> str:
    """The colour of text on that of a share in `SUCCESS_MAP`: what stands out more."""
    ground = SUCCESS_MAP(share)
    return max((INK, "white"), key=lambda ink: contrast(ink, ground))


def contrast(one: Any, other: Any) -> float:
    """Contrast of two colours, from 1 to 21, as WCAG 2.2 defines it."""
    darker, lighter = sorted(_luminance(colour) for colour in (one, other))
    return (lighter + 0.05) / (darker + 0.05)


def _luminance(colour: Any) -> float:
    linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in to_rgb(colour)]
    return sum(weight * c for weight, c in zip((0.2126, 0.7152, 0.0722), linear, strict=True))


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
