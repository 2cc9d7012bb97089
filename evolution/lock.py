"""One process at a time works on a run."""

from __future__ import annotations

import fcntl
import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TextIO

from evolution.folder import LOCK


class RunInUseError(ValueError):
    """Another process works on the run."""


@contextmanager
def locked(folder: Path) -> Iterator[None]:
    """Hold the folder's lock. The kernel gives it back when the process ends, however it ends.

    Raises:
        RunInUseError: If another process holds it.
        OSError: If the lock file cannot be written.
    """
    with _open(folder / LOCK) as file:
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            file.seek(0)
            holder = file.read().strip() or "unknown"
            raise RunInUseError(
                f"another process (number {holder}) works on {folder}; "
                "wait until it ends, or choose another folder"
            ) from None
        file.truncate(0)
        file.write(f"{os.getpid()}\n")
        file.flush()
        yield


def _open(path: Path) -> TextIO:
    """The lock file, made if need be, for reading and writing."""
    try:
        return path.open("a+", encoding="utf-8")
    except OSError as error:
        raise OSError(f"{path.parent} cannot be written: {error.strerror}; choose another folder") from None
