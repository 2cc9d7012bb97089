"""One process at a time works on a run, of however many machines."""

from __future__ import annotations

import errno
import fcntl
import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Final, TextIO

from arm2d.files import LinkError, handle_to_append
from evolution.runs.folder import LOCK
from evolution.runs.lease import RunInUseError, leased

__all__ = ["RunInUseError", "locked"]

LONGEST_NUMBER: Final = 20
# What file systems answer that keep no locks.
NO_LOCKS: Final = (errno.ENOSYS, errno.ENOLCK, errno.ENOTSUP)


@contextmanager
def locked(folder: Path) -> Iterator[None]:
    """Hold the folder's lock and lease. The kernel gives the lock back, however the process ends.

    Raises:
        RunInUseError: If another process holds one of them.
        OSError: If they cannot be written.
    """
    with _open(folder / LOCK) as file:
        held = _lock(file, folder)
        with leased(folder, lock_held=held):
            file.truncate(0)
            file.write(f"{os.getpid()}\n")
            file.flush()
            yield


def _lock(file: TextIO, folder: Path) -> bool:
    """Lock the file; False if its file system keeps no locks, so that the lease must do."""
    try:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        file.seek(0)
        holder = file.read(LONGEST_NUMBER).strip() or "unknown"
        raise RunInUseError(
            f"another process (number {holder}) works on {folder}; "
            "wait until it ends, or choose another folder"
        ) from None
    except OSError as error:
        if error.errno not in NO_LOCKS:
            raise
        return False
    return True


def _open(path: Path) -> TextIO:
    """The lock file, made if need be, for reading and writing."""
    try:
        return os.fdopen(handle_to_append(path, read=True), "a+", encoding="utf-8")
    except LinkError as error:
        raise OSError(str(error)) from None
    except OSError as error:
        raise OSError(f"{path.parent} cannot be written: {error.strerror}; choose another folder") from None
