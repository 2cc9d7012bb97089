"""Pictures inside a page: as data addresses, so that the page needs no other file."""

from __future__ import annotations

import io
from base64 import b64encode
from pathlib import Path
from typing import Final

from matplotlib.figure import Figure
from PIL import Image

from arm2d.files import read_file
from evolution.figures.page import png_bytes, shortened, svg_bytes
from evolution.report.safety import check_drawing

# Drawings up to this size stay drawings [bytes]; of larger ones the page shows whichever is smaller,
# drawing or pixels, so that it stays a few megabytes with a dozen dense figures in it.
SMALL_DRAWING: Final = 120_000
RESOLUTION: Final = 200  # of pixels [dots per inch]
LARGEST_FILE: Final = 32 * 2**20  # [bytes]
MOST_PIXELS: Final = 30_000_000
COLOURS: Final = 128  # in a page's pixels; figures are flat


def figure_uri(figure: Figure) -> str:
    """A figure as an address."""
    drawing = svg_bytes(figure)
    if len(drawing) <= SMALL_DRAWING:
        return data_uri("image/svg+xml", drawing)
    return _smaller(drawing, flattened(png_bytes(figure, RESOLUTION)))


def file_uri(path: Path) -> str:
    """The same for a drawing that lies in a file, with its PNG beside it; links are not followed.

    Raises:
        ValueError: If it is no drawing, or holds more than one.
        OSError: If it cannot be read, or is a link.
    """
    drawing = shortened(read_file(path, LARGEST_FILE, links=False))
    check_drawing(drawing)
    png = path.with_suffix(".png")
    if len(drawing) <= SMALL_DRAWING or not png.is_file():
        return data_uri("image/svg+xml", drawing)
    return _smaller(drawing, flattened(read_file(png, LARGEST_FILE, links=False)))


def flattened(png: bytes) -> bytes:
    """A PNG with a palette of few colours: a quarter of the size, for figures without a difference.

    Raises:
        ValueError: If it is none, or has more than `MOST_PIXELS`.
    """
    buffer = io.BytesIO()
    try:
        with Image.open(io.BytesIO(png), formats=["PNG"]) as picture:
            if picture.width * picture.height > MOST_PIXELS:
                raise ValueError(f"its PNG has {picture.width} x {picture.height} pixels")
            picture.convert("RGB").quantize(COLOURS).save(buffer, "PNG", optimize=True)
    except (OSError, SyntaxError, Image.DecompressionBombError) as error:
        raise ValueError(f"its PNG cannot be read: {error}") from None
    return buffer.getvalue()


def data_uri(kind: str, data: bytes) -> str:
    """An address that is its own content."""
    return f"data:{kind};base64,{b64encode(data).decode()}"


def _smaller(drawing: bytes, pixels: bytes) -> str:
    if len(pixels) < len(drawing):
        return data_uri("image/png", pixels)
    return data_uri("image/svg+xml", drawing)
