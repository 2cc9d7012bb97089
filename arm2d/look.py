"""How pictures look: the same on every machine, whatever a `matplotlibrc` of the user or of a folder says.

Such a file may ask for LaTeX, cut pages, or colour them; and Matplotlib reads one from the current folder.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from typing import Any

import matplotlib as mpl


@contextmanager
def look(style: Mapping[str, Any] | None = None) -> Iterator[None]:
    """While open, what is drawn looks as Matplotlib comes, but for a style."""
    with mpl.rc_context():
        mpl.rcdefaults()
        mpl.rcParams.update(style or {})
        yield
