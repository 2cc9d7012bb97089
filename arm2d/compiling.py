"""How functions of this project are compiled: by Numba, once per machine.

No option that reorders or fuses floating-point operations is used, so compiled code gives the bits
of plain Python (arm2d.arithmetic says why that matters).

Numba looks only at a function's own file when it decides whether cached machine code is still valid,
and would miss a change in a function called from another file. The cache therefore lives in a folder
named after the sources of the whole package.
"""

from __future__ import annotations

import hashlib
import os
from collections.abc import Callable, Iterator
from functools import cache
from importlib.resources import files
from importlib.resources.abc import Traversable
from pathlib import Path
from typing import Any, Final

import numba

# What can change a number: code, and the descriptions of scenes. A template or a picture cannot.
SUFFIXES: Final = (".py", ".xml")


def compiled(function: Callable | None = None, *, allocates: bool = True, **options: Any) -> Any:
    """Decorator: compile with Numba in its numpy error model, cached.

    Args:
        function: What is decorated.
        allocates: Whether the function makes arrays. One that only works on arrays it is lent is
            compiled without reference counting, whose atomic operations cost a tenth of a trial.
        options: Those of `numba.njit`.
    """
    if function is None:
        return lambda each: compiled(each, allocates=allocates, **options)
    if not allocates:
        options["_nrt"] = False
    folder, previous = cache_folder(), numba.config.CACHE_DIR  # type: ignore[attr-defined]
    try:
        numba.config.CACHE_DIR = folder or previous  # type: ignore[attr-defined] - read while decorating
        return numba.njit(function, error_model="numpy", cache=folder is not None, **options)
    finally:
        numba.config.CACHE_DIR = previous  # type: ignore[attr-defined]


@cache
def cache_folder() -> str | None:
    """Where machine code is kept, below the user's cache folder; None if nothing can be written there."""
    home = os.environ.get("NUMBA_CACHE_DIR") or os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache"
    folder = Path(home) / "wordarm" / f"kernel-{sources_digest('arm2d')}"
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError:
        return None
    return str(folder) if os.access(folder, os.W_OK) else None


def sources_digest(*packages: str) -> str:
    """Twelve hexadecimal digits that change with every source file of these packages, wherever it lies."""
    digest = hashlib.sha256()
    for package in packages:
        for place, source in source_files(files(package), package):
            content = source.read_bytes()
            digest.update(f"{place} {len(content)}\n".encode())
            digest.update(content)
    return digest.hexdigest()[:12]


def source_files(folder: Traversable, place: str) -> Iterator[tuple[str, Traversable]]:
    """(place, file) of each source file in a folder and below it, in alphabetical order."""
    for each in sorted(folder.iterdir(), key=lambda each: each.name):
        name = f"{place}/{each.name}"
        if each.is_dir():
            yield from source_files(each, name)
        elif each.name.endswith(SUFFIXES):
            yield name, each
