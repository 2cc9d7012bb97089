"""The way to a folder, step by step: links of ours and of root are followed, those of others are not."""

from __future__ import annotations

import errno
import os
import stat
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Final

# A step on the way to a folder: whatever stands there is only named, not opened.
STEP: Final = os.O_PATH | os.O_NOFOLLOW | os.O_CLOEXEC
FOLDER: Final = os.O_RDONLY | os.O_DIRECTORY | os.O_CLOEXEC
MOST_LINKS: Final = 40


class LinkError(OSError):
    """A symbolic link, or something else that is no file, where we were to write."""

    def __init__(self, sentence: str) -> None:
        super().__init__(errno.ELOOP, sentence)

    def __str__(self) -> str:
        return str(self.strerror)


@contextmanager
def opened_folder(path: Path, *, make: bool = False) -> Iterator[int]:
    """A handle of a folder; names used with it cannot be led elsewhere while it is open.

    Args:
        path: The folder.
        make: Whether to make it, and those above it, as far as they are not there.

    Raises:
        LinkError: If a link of somebody else stands on the way.
        OSError: If it cannot be opened or made.
    """
    try:
        last = _walk(path, make)
        try:
            handle = os.open(".", FOLDER, dir_fd=last)
        finally:
            os.close(last)
    except OSError as error:
        if error.filename is not None:
            error.filename = str(path)
        raise
    try:
        yield handle
    finally:
        os.close(handle)


def _walk(path: Path, make: bool) -> int:
    """A handle of a folder that names it only, reached step by step."""
    names, links = [*reversed(path.parts)], 0
    of_a_link = len(names)  # from so many names left on, they are those of a link, where nothing is made
    here = os.open(".", STEP)
    try:
        while names:
            name = names.pop()
            there = _step(name, here, make and name != ".." and len(names) < of_a_link)
            mode = os.fstat(there).st_mode
            if stat.S_ISLNK(mode):
                links += 1
                of_a_link = min(of_a_link, len(names))
                try:
                    names += reversed(_target(there, name, path, links).parts)
                finally:
                    os.close(there)
            else:
                os.close(here)
                here = there
                if not stat.S_ISDIR(mode):
                    raise NotADirectoryError(errno.ENOTDIR, os.strerror(errno.ENOTDIR), str(path))
    except BaseException:
        os.close(here)
        raise
    return here


def _step(name: str, here: int, make: bool) -> int:
    """A handle of what has a name in a folder."""
    try:
        return os.open(name, STEP, dir_fd=here)
    except FileNotFoundError:
        if not make:
            raise
    with suppress(FileExistsError):  # another process was quicker
        os.mkdir(name, dir_fd=here)
    return os.open(name, STEP, dir_fd=here)


def _target(link: int, name: str, path: Path, links: int) -> Path:
    """Where a link leads, if it is to be trusted."""
    owner = os.fstat(link).st_uid
    if owner not in (0, os.geteuid()):
        raise LinkError(
            f"{name!r} on the way to {path} is a symbolic link that belongs to another user, number {owner}; "
            "give the path that it leads to"
        )
    if links > MOST_LINKS:
        raise LinkError(f"{name!r} on the way to {path} is a symbolic link that leads nowhere")
    return Path(os.readlink("", dir_fd=link))
