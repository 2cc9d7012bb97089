"""Files to be read: regular ones, of at most so many bytes."""

from __future__ import annotations

import os
import stat
from pathlib import Path
from typing import Final

from arm2d.files.handles import FILE, handle_with

CHUNK: Final = 2**18  # [bytes]


class NoFileError(ValueError):
    """Something that is no file to be read: a pipe, a device, or larger than anyone wants."""


def read_file(path: Path, most: int, *, links: bool = True) -> bytes:
    """The content of a regular file.

    Args:
        path: The file.
        most: How many bytes it may have.
        links: Whether it may be reached by symbolic links, whoever made them.

    Raises:
        NoFileError: If it is no regular file, or has more bytes.
        LinkError: If it is reached by a link although it must not be.
        OSError: If it cannot be read.
    """
    return read_with_status(path, most, links=links)[0]


def read_with_status(path: Path, most: int, *, links: bool = True) -> tuple[bytes, os.stat_result]:
    """The same, and what the file system tells of the file that was read."""
    handle = os.open(path, FILE | os.O_RDONLY) if links else handle_with(path, os.O_RDONLY)
    try:
        status = os.fstat(handle)
        if not stat.S_ISREG(status.st_mode):
            raise NoFileError("it is no regular file")
        chunks, room = [], most
        while room >= 0 and (chunk := os.read(handle, min(CHUNK, room + 1))):
            chunks.append(chunk)
            room -= len(chunk)
        if room < 0:
            raise NoFileError(f"it is larger than {_size(most)}")
        return b"".join(chunks), status
    finally:
        os.close(handle)


def _size(n: int) -> str:
    return f"{n // 2**20} MB" if n >= 2**20 else f"{n:,} bytes"
