"""Files on a machine shared with others: what is written goes where it was sent, what is read is a file.

Whoever may write in a folder can put a symbolic link or a pipe there, and can take a name that is easily
guessed before we do. So

    a folder that is a link    is entered if the link is ours or root's; this holds for the whole way to it
    a file that is a link      is never written to
    a temporary file           has a random name, and is made anew, never opened
    what is read               is a regular file of at most so many bytes
"""

from __future__ import annotations

import errno
import fcntl
import os
import re
import secrets
import stat
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Final

# A step on the way to a folder: whatever stands there is only named, not opened.
STEP: Final = os.O_PATH | os.O_NOFOLLOW | os.O_CLOEXEC
FOLDER: Final = os.O_RDONLY | os.O_DIRECTORY | os.O_CLOEXEC
# Not blocking, for a pipe would keep us waiting; files do not mind.
FILE: Final = os.O_NONBLOCK | os.O_CLOEXEC
MOST_LINKS: Final = 40
CHUNK: Final = 2**18  # [bytes]
ATTEMPTS: Final = 5
NOT_FOLLOWED: Final = "is a symbolic link, which is not followed; remove it, or choose another name"
NO_FILE: Final = "is no file; remove it, or choose another name"
TEMPORARY: Final = re.compile(r"\.(.+?)(\.[0-9a-f]{16})?\.tmp")


class LinkError(OSError):
    """A symbolic link, or something else that is no file, where we were to write."""

    def __init__(self, sentence: str) -> None:
        super().__init__(errno.ELOOP, sentence)

    def __str__(self) -> str:
        return str(self.strerror)


class NoFileError(ValueError):
    """Something that is no file to be read: a pipe, a device, or larger than anyone wants."""


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


def handle_to_append(path: Path) -> int:
    """A handle of a file, made if need be, at whose end is written.

    Raises:
        LinkError: If it is a link or no file.
        OSError: If it cannot be opened.
    """
    return _handle(path, os.O_APPEND | os.O_CREAT | os.O_WRONLY)


def handle_to_overwrite(path: Path) -> int:
    """A handle of a file, made or emptied; errors as `handle_to_append`."""
    return _handle(path, os.O_TRUNC | os.O_CREAT | os.O_WRONLY)


def handle_to_rewrite(path: Path) -> int:
    """A handle of a file, made if need be, for reading and writing; errors as `handle_to_append`."""
    return _handle(path, os.O_CREAT | os.O_RDWR)


def handle_of_new(path: Path) -> int:
    """A handle of a file that was not there; FileExistsError if it was."""
    return _handle(path, os.O_EXCL | os.O_CREAT | os.O_WRONLY)


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
    handle = os.open(path, FILE | os.O_RDONLY) if links else _handle(path, os.O_RDONLY)
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


def is_temporary(name: str) -> bool:
    """Whether a file of this name is being written, or was when its writer died."""
    return TEMPORARY.fullmatch(name) is not None


def final_name(name: str) -> str:
    """The name that a file being written will have; of any other file, its name."""
    found = TEMPORARY.fullmatch(name)
    return found[1] if found else name


def _walk(path: Path, make: bool) -> int:
    """A handle of a folder that names it only, reached step by step."""
    names, links = [*reversed(path.parts)], 0
    here = os.open(".", STEP)
    try:
        while names:
            name = names.pop()
            there = _step(name, here, make and name != "..")
            mode = os.fstat(there).st_mode
            if stat.S_ISLNK(mode):
                links += 1
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


def _handle(path: Path, flags: int) -> int:
    with opened_folder(path.parent) as folder:
        try:
            return _handle_in(folder, path.name, flags)
        except OSError as error:
            if isinstance(error, LinkError):
                raise LinkError(f"{path} {error}") from None
            error.filename = str(path)
            raise


def _handle_in(folder: int, name: str, flags: int) -> int:
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


def _write_and_rename(name: str, data: bytes, folder: int) -> None:
    """Write a new file and give it its name."""
    temporary = f".{name}.{secrets.token_hex(8)}.tmp"
    handle = _handle_in(folder, temporary, os.O_EXCL | os.O_CREAT | os.O_WRONLY)
    try:
        _lock(handle)  # so that nobody takes us for dead
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
    for each in os.listdir(folder):
        if is_temporary(each) and final_name(each) == name:
            with suppress(OSError):
                handle = _handle_in(folder, each, os.O_WRONLY)
                try:
                    if _lock(handle):
                        os.unlink(each, dir_fd=folder)
                finally:
                    os.close(handle)


def _lock(handle: int) -> bool:
    """Lock a file; False if somebody else does, or the file system keeps no locks."""
    try:
        fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        return False
    return True


def _size(n: int) -> str:
    return f"{n // 2**20} MB" if n >= 2**20 else f"{n:,} bytes"
