"""Files that are whole or as they were: written under a name that cannot be foretold, then renamed."""

from __future__ import annotations

import os
import re
import secrets
from contextlib import suppress
from pathlib import Path
from typing import Final

from arm2d.files.folders import opened_folder
from arm2d.files.handles import handle_in
from arm2d.files.locks import lock_file

ATTEMPTS: Final = 5
TEMPORARY: Final = re.compile(r"\.(.+?)(\.[0-9a-f]{16})?\.tmp")


def write_whole(path: Path, data: bytes) -> None:
    """Write a file so that a kill at any moment leaves either the old one or the new one.

    Of two processes that write the same file the later one wins. What a dead one left unfinished is removed.

    Raises:
        LinkError: As `opened_folder`.
        OSError: If it cannot be written; the old file, if any, is still there.
    """
    with opened_folder(path.parent) as folder:
        for attempt in range(1, ATTEMPTS + 1):
            try:
                _write_and_rename(path.name, data, folder)
                break
            except FileNotFoundError:  # another machine took us for dead
                if attempt == ATTEMPTS:
                    raise
        os.fsync(folder)  # makes the new name survive a power cut
        _remove_leftovers(path.name, folder)


def is_temporary(name: str) -> bool:
    """Whether a file of this name is being written, or was when its writer died."""
    return TEMPORARY.fullmatch(name) is not None


def final_name(name: str) -> str:
    """The name that a file being written will have; of any other file, its name."""
    found = TEMPORARY.fullmatch(name)
    return found[1] if found else name


def _write_and_rename(name: str, data: bytes, folder: int) -> None:
    """Write a new file and give it its name."""
    temporary = f".{name}.{secrets.token_hex(8)}.tmp"
    handle = handle_in(folder, temporary, os.O_EXCL | os.O_CREAT | os.O_WRONLY)
    try:
        with suppress(OSError):
            lock_file(handle)  # so that nobody takes us for dead
        rest = memoryview(data)
        while rest:
            rest = rest[os.write(handle, rest) :]
        os.fsync(handle)
        os.rename(temporary, name, src_dir_fd=folder, dst_dir_fd=folder)
    except BaseException:
        with suppress(OSError):
            os.unlink(temporary, dir_fd=folder)
        raise
    finally:
        os.close(handle)


def _remove_leftovers(name: str, folder: int) -> None:
    """Remove the temporary files that dead writers of a file left."""
    for other in os.listdir(folder):
        if is_temporary(other) and final_name(other) == name:
            with suppress(OSError):
                handle = handle_in(folder, other, os.O_WRONLY)
                try:
                    if lock_file(handle):
                        os.unlink(other, dir_fd=folder)
                finally:
                    os.close(handle)
