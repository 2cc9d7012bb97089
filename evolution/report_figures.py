"""Pictures inside a page: as data addresses, so that the page needs no other file."""

from __future__ import annotations

import io
import re
from base64 import b64encode
from pathlib import Path
from typing import Final

import matplotlib as mpl
from matplotlib.figure import Figure

from evolution.figures import STYLE

# Drawings larger than this [bytes] are shown as pixels.
LARGEST_DRAWING: Final = 400_000
DOTS_PER_INCH: Final = 160
PATH: Final = re.compile(rb' d="[^"]*"')
DIGITS: Final = re.compile(rb"(\.\d{2})\d+")


def figure_uri(figure: Figure) -> str:
    """A figure as the address of an SVG, or of a PNG where that would be too large."""
    drawing = _shortened(_saved(figure, "svg"))
    if len(drawing) <= LARGEST_DRAWING:
        return data_uri("image/svg+xml", drawing)
    return data_uri("image/png", _saved(figure, "png"))


def file_uri(path: Path) -> str:
    """The same for a drawing that lies in a file, with its PNG beside it."""
    png = path.with_suffix(".png")
    drawing = _shortened(path.read_bytes())
    if len(drawing) <= LARGEST_DRAWING or not png.is_file():
        return data_uri("image/svg+xml", drawing)
    return data_uri("image/png", png.read_bytes())


def data_uri(kind: str, data: bytes) -> str:
    """An address that is its own content."""
    return f"data:{kind};base64,{b64encode(data).decode()}"


def _shortened(drawing: bytes) -> bytes:
    """A drawing whose paths are exact to a hundredth of a point, which no screen can tell."""
    return PATH.sub(lambda path: DIGITS.sub(rb"\1", path.group()), drawing)


def _saved(figure: Figure, kind: str) -> bytes:
    buffer = io.BytesIO()
    metadata = {"Date": None} if kind == "svg" else None
    with mpl.rc_context(STYLE):
        figure.savefig(buffer, format=kind, dpi=DOTS_PER_INCH, facecolor="white", metadata=metadata)
    return buffer.getvalue()
