"""Files in some folders, noticed as they are opened: Linux's inotify, so that a kill can hit a write."""

from __future__ import annotations

import ctypes
import os
import select
import struct
from collections.abc import Iterable
from pathlib import Path
from types import TracebackType
from typing import Final

# A file that is made is opened too; so is one that a dead process left behind.
OPENED: Final = 0x20
NOT_BLOCKING: Final = os.O_NONBLOCK | os.O_CLOEXEC
# struct inotify_event: watch, mask, cookie, length of the name that follows.
EVENT: Final = struct.Struct("iIII")
BUFFER: Final = 65536


class OpenedFiles:
    """While open, tells of every file that is made or opened in one of the folders.

    Raises:
        OSError: If the system offers no inotify, or a folder is not there.
    """

    def __init__(self, folders: Iterable[Path]) -> None:
        libc = ctypes.CDLL(None, use_errno=True)
        self._handle = _checked(libc.inotify_init1(NOT_BLOCKING))
        self._folders = {
            _checked(libc.inotify_add_watch(self._handle, os.fsencode(each), OPENED)): each
            for each in folders
        }

    def __enter__(self) -> OpenedFiles:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        os.close(self._handle)

    def wait(self, seconds: float) -> list[Path]:
        """The files opened since the last call; waits for the first one at most so long."""
        ready, _, _ = select.select([self._handle], [], [], seconds)
        return self._parse(os.read(self._handle, BUFFER)) if ready else []

    def _parse(self, data: bytes) -> list[Path]:
        found, at = [], 0
        while at < len(data):
            watch, _, _, length = EVENT.unpack_from(data, at)
            at += EVENT.size
            name = os.fsdecode(data[at : at + length].rstrip(b"\0"))
            at += length
            if watch in self._folders:
                found.append(self._folders[watch] / name)
        return found


def _checked(answer: int) -> int:
    """The answer of a call of the C library, or its error."""
    if answer < 0:
        number = ctypes.get_errno()
        raise OSError(number, os.strerror(number))
    return answer
