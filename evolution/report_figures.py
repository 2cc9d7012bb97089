"""Pictures inside a page: as data addresses, so that the page needs no other file."""

from __future__ import annotations

from base64 import b64encode
from pathlib import Path

from matplotlib.figure import Figure

from evolution.drawings import LARGEST_DRAWING, png_bytes, shortened, svg_bytes

RESOLUTION = 160  # where pixels are smaller than a drawing [dots per inch]


def figure_uri(figure: Figure) -> str:
    """A figure as the address of an SVG, or of a PNG where that would be too large."""
    drawing = svg_bytes(figure)
    if len(drawing) <= LARGEST_DRAWING:
        return data_uri("image/svg+xml", drawing)
    return data_uri("image/png", png_bytes(figure, RESOLUTION))


def file_uri(path: Path) -> str:
    """The same for a drawing that lies in a file, with its PNG beside it."""
    png = path.with_suffix(".png")
    drawing = shortened(path.read_bytes())
    if len(drawing) <= LARGEST_DRAWING or not png.is_file():
        return data_uri("image/svg+xml", drawing)
    return data_uri("image/png", png.read_bytes())


def data_uri(kind: str, data: bytes) -> str:
    """An address that is its own content."""
    return f"data:{kind};base64,{b64encode(data).decode()}"
