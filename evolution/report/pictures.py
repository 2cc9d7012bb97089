"""Pictures inside a page: as data addresses, so that the page needs no other file."""

from __future__ import annotations

import io
from base64 import b64encode
from pathlib import Path
from typing import Final

from matplotlib.figure import Figure
from PIL import Image

from evolution.figures.page import png_bytes, shortened, svg_bytes

# Drawings up to this size stay drawings [bytes]; of larger ones the page shows whichever is smaller,
# drawing or pixels, so that it stays a few megabytes with a dozen dense figures in it.
SMALL_DRAWING: Final = 120_000
RESOLUTION: Final = 150  # of pixels [dots per inch]
COLOURS: Final = 128  # in a page's pixels; figures are flat


def figure_uri(figure: Figure) -> str:
    """A figure as an address."""
    drawing = svg_bytes(figure)
    if len(drawing) <= SMALL_DRAWING:
        return data_uri("image/svg+xml", drawing)
    return _smaller(drawing, flattened(png_bytes(figure, RESOLUTION)))


def file_uri(path: Path) -> str:
    """The same for a drawing that lies in a file, with its PNG beside it."""
    png = path.with_suffix(".png")
    drawing = shortened(path.read_bytes())
    if len(drawing) <= SMALL_DRAWING or not png.is_file():
        return data_uri("image/svg+xml", drawing)
    return _smaller(drawing, flattened(png.read_bytes()))


def flattened(png: bytes) -> bytes:
    """A PNG with a palette of few colours: a quarter of the size, for figures without a difference."""
    buffer = io.BytesIO()
    Image.open(io.BytesIO(png)).convert("RGB").quantize(COLOURS).save(buffer, "PNG", optimize=True)
    return buffer.getvalue()


def data_uri(kind: str, data: bytes) -> str:
    """An address that is its own content."""
    return f"data:{kind};base64,{b64encode(data).decode()}"


def _smaller(drawing: bytes, pixels: bytes) -> str:
    if len(pixels) < len(drawing):
        return data_uri("image/png", pixels)
    return data_uri("image/svg+xml", drawing)
