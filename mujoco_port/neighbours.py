"""`models` and `evolution` are common names: whether a user's own file stands in front of our package.

Python takes what it finds first: in the folder of a script, in the current folder, in PYTHONPATH. A library
cannot share its name, so `check` refuses in one sentence; the command line runs nothing of the user's, so
`come_first` lets it find ours.
"""

from __future__ import annotations

import sys
from importlib.machinery import PathFinder
from importlib.util import find_spec
from pathlib import Path
from typing import Final

HOME: Final = Path(__file__).resolve().parents[1]
COMMON_NAMES: Final = ("models", "evolution")


class ShadowedError(ImportError):
    """A user's own file stands in front of a package of ours."""


def check(name: str = "models") -> None:
    """Refuse to go on with a stranger; what is missing altogether is left to Python to tell.

    Raises:
        ShadowedError: With the file that stands in front, and the next move.
    """
    try:
        spec = find_spec(name)
    except ValueError:  # a module that was made by hand
        spec = None
    file = None if spec is None else spec.origin
    if file is not None and not _is_ours(file):
        raise ShadowedError(
            f"{file} stands in front of the package {name!r} that mujoco_port needs; rename it, or run "
            "where Python does not find it first (neither beside it nor with its folder in PYTHONPATH)",
            name=name,
            path=file,
        )


def come_first() -> None:
    """Let our packages be found before strangers, by this process and by those that it spawns."""
    found = [PathFinder.find_spec(name) for name in COMMON_NAMES]
    if any(spec is not None and spec.origin and not _is_ours(spec.origin) for spec in found):
        sys.path.insert(0, str(HOME))


def _is_ours(file: str) -> bool:
    """Whether the file that a package begins with lies where this one does."""
    return Path(file).resolve().parent.parent == HOME
