"""What all figures have in common: fonts, and the colours of ink that is not data."""

from __future__ import annotations

from typing import Any, Final

from arm2d.drawing import INK

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
