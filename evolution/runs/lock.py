"""One process at a time works on a run, of however many machines; it says who it is and how far it has come.

lock    4711              the process
1234 2.103451     generations scored, and the best fitness of the last; for whoever watches
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from arm2d.files import LinkError, handle_to_rewrite, lock_file
from evolution.runs.folder import CONFIG, LOCK
from evolution.runs.lease import RunInUseError, leased

__all__ = ["Hold", "RunInUseError", "Word", "in_use", "last_word", "locked"]

LONGEST: Final = 200  # [bytes]
PATTERN: Final = re.compile(rb"(\d{1,10})\n(?:(\d{1,7}) (\d{1,3}\.\d{6})\n)?")


@dataclass(frozen=True)
class Word:
    """What the process that holds a run says, or said before it ended.

    Attributes:
        process: Its number; 0 if none is known.
        generations: Scored so far; 0 if that was not said.
        best: Best fitness of the last of them; NaN if that was not said.
    """

    process: int = 0
    generations: int = 0
    best: float = float("nan")


@dataclass(frozen=True)
class Hold:
    """A folder that is ours for the time being.

    Attributes:
        descriptor: Of its open lock file.
    """

    descriptor: int

    def tell(self, generations: int, best: float) -> None:
        """Say how far the run has come: so many generations are scored, the last with this best fitness."""
        _write(self.descriptor, f"{os.getpid()}\n{generations} {best:.6f}\n")


@contextmanager
def locked(folder: Path) -> Iterator[Hold]:
    """Hold the folder's lock and lease. The kernel gives the lock back, however the process ends.

    Raises:
        RunInUseError: If another process holds one of them.
        OSError: If they cannot be written.
    """
    with _opened(folder / LOCK) as descriptor:
        held = _lock(descriptor, folder)
        with leased(folder, lock_held=held):
            _write(descriptor, f"{os.getpid()}\n")
            yield Hold(descriptor)


def in_use(folder: Path) -> bool:
    """Whether another process works on a run, such as one left over when its parent was killed."""
    if not (folder / CONFIG).exists():
        return False
    try:
        with locked(folder):
            return False
    except RunInUseError:
        return True


def last_word(folder: Path) -> Word:
    """What the process that holds a folder, or held it last, has said."""
    try:
        descriptor = os.open(folder / LOCK, os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK | os.O_CLOEXEC)
    except OSError:
        return Word()
    try:
        return _word(descriptor)
    except OSError:
        return Word()
    finally:
        os.close(descriptor)


def _word(descriptor: int) -> Word:
    found = PATTERN.fullmatch(os.pread(descriptor, LONGEST, 0))
    if not found:
        return Word()
    process, generations, best = found.groups()
    return Word(int(process)) if best is None else Word(int(process), int(generations), float(best))


def _write(descriptor: int, text: str) -> None:
    """Replace what the file says in one stroke; it is no result, so it need not survive a power cut."""
    data = text.encode()
    os.pwrite(descriptor, data, 0)
    os.ftruncate(descriptor, len(data))


def _lock(descriptor: int, folder: Path) -> bool:
    """Lock the file; False if its file system keeps no locks, so that the lease must do."""
    try:
        return lock_file(descriptor)
    except BlockingIOError:
        raise RunInUseError(
            f"another process (number {_word(descriptor).process or 'unknown'}) works on {folder}; "
            "wait until it ends, or choose another folder"
        ) from None


@contextmanager
def _opened(path: Path) -> Iterator[int]:
    """The lock file, made if need be, for reading and writing."""
    try:
        descriptor = handle_to_rewrite(path)
    except LinkError as error:
        raise OSError(str(error)) from None
    except OSError as error:
        raise OSError(f"{path.parent} cannot be written: {error.strerror}; choose another folder") from None
    try:
        yield descriptor
    finally:
        os.close(descriptor)
