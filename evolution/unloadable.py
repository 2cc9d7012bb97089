"""Libraries that cannot be loaded: whether an error is theirs rather than ours, and what to do about it.

A library reads its settings while it is imported, from the environment and from files in the current folder
(Numba a `.numba_config.yaml`), and raises whatever it likes if it can make nothing of them.
"""

from __future__ import annotations

import sys
from traceback import walk_tb
from typing import Final

OURS: Final = frozenset({"arm2d", "evolution", "models", "mujoco_port", "wordarm", "__main__"})


def unloadable(error: Exception) -> str | None:
    """One sentence, if a library raised this error while it was imported; None if it did not."""
    library = _library(error)
    if library is None or isinstance(error, MemoryError):
        return None
    reason = f"{type(error).__name__}: {error}"
    return (
        f"{library} cannot be loaded ({reason}); look at its settings: {library.upper()}_... in the "
        "environment, a file in the current folder; `wordarm doctor` tries it by itself"
    )


def _library(error: Exception) -> str | None:
    """The library that was being imported when an error was raised."""
    names = [(_package(frame.f_globals.get("__name__")), frame) for frame, _ in walk_tb(error.__traceback__)]
    ours = max((k for k, (name, _) in enumerate(names) if name in OURS), default=-1)
    loading = [name for name, frame in names[ours + 1 :] if frame.f_code.co_name == "<module>"]
    if loading:
        return loading[-1]
    missing = _package(error.name) if isinstance(error, ImportError) else ""
    return missing if missing and missing not in OURS and missing not in sys.modules else None


def _package(module: str | None) -> str:
    """The outermost package of a module."""
    return (module or "").partition(".")[0]
