"""Whether a worker's machine would compute the same: the same sources and packages, the same folder."""

from __future__ import annotations

import platform
from collections.abc import Mapping
from dataclasses import dataclass
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Final

from arm2d.cache import sources_digest

PACKAGES: Final = ("numpy", "numba", "dask", "distributed")
SOURCES: Final = "wordarm's sources"


@dataclass(frozen=True)
class Order:
    """What all tasks of one call have in common.

    Attributes:
        token: Names the call.
        folder: Of the experiment, by the path that all machines know it by.
        fingerprint: What computes: sources and versions.
    """

    token: str
    folder: Path
    fingerprint: Mapping[str, str]

    @property
    def mark(self) -> Path:
        """A file that is in the folder while the call lasts: who does not see it sees another folder."""
        return self.folder / f".cluster-{self.token}.tmp"


def fingerprint() -> dict[str, str]:
    """Sources and versions that must be the same everywhere."""
    found = {
        SOURCES: sources_digest("arm2d", "evolution"),
        "Python": ".".join(platform.python_version_tuple()[:2]),
    }
    for name in PACKAGES:
        try:
            found[name] = version(name)
        except PackageNotFoundError:
            found[name] = "none"
    return found


def disagreement(order: Order) -> str:
    """Why this machine cannot take part, in words that follow a name; nothing if it can."""
    mine = fingerprint()
    for name, wanted in order.fingerprint.items():
        if mine.get(name) != wanted:
            return f"has {name} {mine.get(name)}, where the command has {wanted}; install the same on both"
    if not order.mark.exists():
        return (
            f"does not see {order.folder} as the command's machine does; "
            "choose an --output on a file system that all machines share, mounted at the same place"
        )
    return ""
