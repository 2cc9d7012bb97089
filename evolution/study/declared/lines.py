"""Tables of the declared studies as comma-separated lines, the names of the columns first."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable, Sequence


def to_csv(lines: Iterable[Sequence[object]]) -> str:
    """Comma-separated lines of a header and rows."""
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerows(lines)
    return text.getvalue()
