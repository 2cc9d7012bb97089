"""Where compiled code is kept: in a folder that is the user's own, and that nobody else can write to.

Whatever lies in the cache is run. A folder that belongs to somebody else, or that others can change, is
therefore not used, with the reason in a warning; a folder of the user's own among temporary files takes its
place, and if that is not possible either, nothing is kept.
"""

from __future__ import annotations

import hashlib
import os
import shutil
import stat
import tempfile
import time
import warnings
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from importlib.resources.abc import Traversable
from pathlib import Path
from typing import Final

SEAL: Final = hashlib.sha256
N_SEAL: Final = SEAL().digest_size
# What is written to see whether there is room, in bytes: as much as the code of a function takes.
PROBE: Final = bytes(64 * 1024)
# What can change a number: code, and the descriptions of scenes. A template or a picture cannot.
SOURCES: Final = (".py", ".xml")
KEPT_DAYS: Final = 30


class CacheWarning(RuntimeWarning):
    """Compiled code is not kept where it should be."""


@dataclass(frozen=True)
class Place:
    """Where compiled code is kept.

    Attributes:
        folder: None if nothing is kept.
        refusals: A sentence for each place that came before it and is not used.
    """

    folder: Path | None
    refusals: tuple[str, ...] = ()

    @property
    def note(self) -> str:
        """What a user should know; nothing if all is as usual."""
        if not self.refusals:
            return ""
        instead = (
            f"it is kept in {self.folder}"
            if self.folder
            else "every process compiles anew, which takes some 10 s"
        )
        return f"compiled code: {'; '.join(self.refusals)}; {instead}"


@cache
def cache_folder() -> str | None:
    """Where compiled code is kept; None if there is no place for it. What is unusual is told in a warning."""
    place = find_place()
    if place.note:
        warnings.warn(place.note, CacheWarning, stacklevel=2)
    return None if place.folder is None else str(place.folder)


def find_place() -> Place:
    """The folder for these sources, made if it was not there."""
    refusals = []
    for base in (_users_base, _temporary_base):
        try:
            return Place(_own_folder(base()), tuple(refusals))
        except OSError as error:
            refusals.append(str(error))
    return Place(None, tuple(refusals))


def damaged_files(folder: Path) -> list[Path]:
    """The files of a cache that are not as they were written; they are made again when they are needed."""
    kept = [path for path in sorted(folder.rglob("*")) if path.suffix in (".nbi", ".nbc")]
    return [path for path in kept if unsealed(path) is None]


def lack_of_room(folder: Path) -> str:
    """Why nothing more can be kept in a folder; nothing if there is room."""
    try:
        with tempfile.TemporaryFile(dir=folder) as file:
            file.write(PROBE)
    except OSError as error:
        return str(error.strerror)
    return ""


def sealed(content: bytes) -> bytes:
    """Content with its checksum before it."""
    return SEAL(content).digest() + content


def unsealed(path: Path) -> bytes | None:
    """The content of a sealed file; None if it is missing, damaged, or was written by something else."""
    try:
        data = path.read_bytes()
    except OSError:
        return None
    content = data[N_SEAL:]
    return content if content and SEAL(content).digest() == data[:N_SEAL] else None


def _users_base() -> Path:
    """`wordarm` in the user's cache folder."""
    named = os.environ.get("NUMBA_CACHE_DIR") or os.environ.get("XDG_CACHE_HOME")
    try:
        return Path(named or Path.home() / ".cache").absolute() / "wordarm"
    except RuntimeError:
        raise OSError("no home folder is known, nor NUMBA_CACHE_DIR set") from None


def _temporary_base() -> Path:
    """A folder of the user's among temporary files."""
    return Path(tempfile.gettempdir()).absolute() / f"wordarm-{os.geteuid()}"


def _own_folder(base: Path) -> Path:
    """The folder below a base for these sources.

    Raises:
        OSError: If it cannot be used, with the reason.
    """
    folder = base / f"kernel-{sources_digest('arm2d')}"
    _told(lambda: base.parent.mkdir(parents=True, exist_ok=True), base)
    for above in base.parents:
        if _is_open_to_others(above.stat()):
            raise OSError(f"{base} is not used, since others can change {above}")
    is_new = not folder.exists()
    for own in (base, folder):
        _told(lambda own=own: own.mkdir(mode=0o700, exist_ok=True), own)
        _check_own(own)
    _told(lambda: _try_to_write(folder), folder)
    _told(lambda: os.utime(folder), folder)  # used today
    if is_new:
        _forget_unused(base)
    return folder


def _forget_unused(base: Path) -> None:
    """Remove what other versions compiled that were not started for `KEPT_DAYS`."""
    for folder in base.glob("kernel-*"):
        try:
            if time.time() - folder.lstat().st_mtime > KEPT_DAYS * 86_400 and not folder.is_symlink():
                shutil.rmtree(folder, ignore_errors=True)
        except OSError:
            continue  # somebody else was sooner


def _told(attempt: Callable[[], None], path: Path) -> None:
    """Try something with a folder, and name it if that fails."""
    try:
        attempt()
    except OSError as error:
        raise OSError(f"{path} cannot be used ({error.strerror})") from None


def _check_own(folder: Path) -> None:
    """Refuse a folder in which somebody else may have left something, and close it to others."""
    found = folder.lstat()
    if not stat.S_ISDIR(found.st_mode):
        raise OSError(f"{folder} is not used, since it is no folder but a link")
    if found.st_uid != os.geteuid():
        raise OSError(f"{folder} is not used, since it belongs to another user (number {found.st_uid})")
    if found.st_mode & (stat.S_IWGRP | stat.S_IWOTH):
        raise OSError(f"{folder} is not used, since others could write to it; remove it")
    if stat.S_IMODE(found.st_mode) != 0o700:
        _told(lambda: folder.chmod(0o700), folder)


def _is_open_to_others(found: os.stat_result) -> bool:
    """Whether others could put a folder of their own in the place of one in here."""
    if found.st_mode & stat.S_ISVTX:
        return False
    by_group = found.st_mode & stat.S_IWGRP and found.st_gid not in _private_groups()
    return bool(found.st_mode & stat.S_IWOTH or by_group)


def _private_groups() -> set[int]:
    """The group that has the user's name, as is the custom where everybody has one of their own."""
    import grp
    import pwd

    try:
        user = pwd.getpwuid(os.geteuid())
        return {user.pw_gid} if grp.getgrgid(user.pw_gid).gr_name == user.pw_name else set()
    except KeyError:
        return set()


def _try_to_write(folder: Path) -> None:
    """Make and remove an empty file. Whether there is room does not matter here: what is kept can be read."""
    with tempfile.TemporaryFile(dir=folder):
        pass


def sources_digest(*packages: str) -> str:
    """Twelve hexadecimal digits that change with every source file of these packages, wherever it lies.

    Whoever continues numbers, or runs what was compiled before, has to have the sources they began with.
    Numba looks only at a function's own file and would miss a change in one that it calls elsewhere.
    """
    digest = hashlib.sha256()
    for package in packages:
        for place, source in source_files(files(package), package):
            content = source.read_bytes()
            digest.update(f"{place} {len(content)}\n".encode())
            digest.update(content)
    return digest.hexdigest()[:12]


def source_files(folder: Traversable, place: str) -> Iterator[tuple[str, Traversable]]:
    """(place, file) of each source file in a folder and below it, in alphabetical order."""
    for entry in sorted(folder.iterdir(), key=lambda entry: entry.name):
        name = f"{place}/{entry.name}"
        if entry.is_dir():
            yield from source_files(entry, name)
        elif entry.name.endswith(SOURCES):
            yield name, entry
