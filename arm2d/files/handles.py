"""Files to be written to in place: logs, tables, locks; neither links nor pipes."""

from __future__ import annotations

import errno
import os
import stat
from pathlib import Path
from typing import Final

from arm2d.files.folders import LinkError, opened_folder

# Not blocking, for a pipe would keep us waiting; files do not mind.
FILE: Final = os.O_NONBLOCK | os.O_CLOEXEC
NOT_FOLLOWED: Final = "is a symbolic link, which is not followed; remove it, or choose another name"
NO_FILE: Final = "is no file; remove it, or choose another name"


def handle_to_append(path: Path) -> int:
    """A handle of a file, made if need be, at whose end is written.

    Raises:
        LinkError: If it is a link or no file.
        OSError: If it cannot be opened.
    """
    return handle_with(path, os.O_APPEND | os.O_CREAT | os.O_WRONLY)


def handle_to_overwrite(path: Path) -> int:
    """A handle of a file, made or emptied; errors as `handle_to_append`."""
    return handle_with(path, os.O_TRUNC | os.O_CREAT | os.O_WRONLY)


def handle_to_rewrite(path: Path) -> int:
    """A handle of a file, made if need be, for reading and writing; errors as `handle_to_append`."""
    return handle_with(path, os.O_CREAT | os.O_RDWR)


def handle_of_new(path: Path) -> int:
    """A handle of a file that was not there; FileExistsError if it was."""
    return handle_with(path, os.O_EXCL | os.O_CREAT | os.O_WRONLY)


def handle_with(path: Path, flags: int) -> int:
    """A handle of a regular file; errors as `handle_to_append`."""
    with opened_folder(path.parent) as folder:
        try:
            return handle_in(folder, path.name, flags)
        except OSError as error:
            if isinstance(error, LinkError):
                raise LinkError(f"{path} {error}") from None
            error.filename = str(path)
            raise


def handle_in(folder: int, name: str, flags: int) -> int:
    """A handle of a regular file in a folder."""
    try:
        # Like every file that Python makes: the user's umask says who may read it.
        handle = os.open(name, flags | FILE | os.O_NOFOLLOW, 0o666, dir_fd=folder)
    except OSError as error:
        if error.errno == errno.ELOOP:
            raise LinkError(NOT_FOLLOWED) from None
        if error.errno == errno.ENXIO:
            raise LinkError(NO_FILE) from None
        raise
    if not stat.S_ISREG(os.fstat(handle).st_mode):
        os.close(handle)
        raise LinkError(NO_FILE)
    return handle
