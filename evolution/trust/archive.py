"""Many files as one archive: the same files are the same bytes, and every byte is vouched for.

An archive is a .tar.gz with one folder in it. The folder's first file is SHA256SUMS, with a line for every
other file, as `sha256sum -c SHA256SUMS` reads them once it is unpacked. What is read here is a stranger's:
nothing but plain files with plain names below that folder is taken, and not more than `LARGEST` bytes.
"""

from __future__ import annotations

import gzip
import hashlib
import io
import re
import shutil
import tarfile
import tempfile
import zlib
from collections.abc import Iterator, Mapping
from pathlib import Path, PurePosixPath
from typing import Final

from arm2d.files import read_file
from evolution.runs.storage import DamagedFileError, make_folder, write_atomically

SUMS: Final = "SHA256SUMS"
SUFFIX: Final = ".tar.gz"
COMPRESSED: Final = b"\x1f\x8b"  # how gzip begins
# Of an archive, and of all files in it [bytes].
LARGEST: Final = 2**30
MOST_FILES: Final = 20_000
NAME: Final = re.compile(r"[A-Za-z0-9][A-Za-z0-9._+-]*(/[A-Za-z0-9][A-Za-z0-9._+-]*)*")
SUM: Final = re.compile(r"([0-9a-f]{64})  (\S+)")


def pack(folder: str, files: Mapping[str, bytes]) -> bytes:
    """An archive with these files, by their path below the folder; the same files give the same bytes.

    Raises:
        ValueError: If a name is none that would be unpacked again.
    """
    for name in (folder, *files):
        if not NAME.fullmatch(name):
            raise ValueError(
                f"{name!r} cannot be a file's name in an archive; use letters, digits and . _ + - /"
            )
    sums = "".join(f"{_digest(data)}  {name}\n" for name, data in sorted(files.items()))
    buffer = io.BytesIO()
    with tarfile.open(fileobj=buffer, mode="w", format=tarfile.USTAR_FORMAT) as tar:
        for name, data in ((SUMS, sums.encode()), *sorted(files.items())):
            member = tarfile.TarInfo(f"{folder}/{name}")  # no time, no owner
            member.size, member.mode = len(data), 0o644
            tar.addfile(member, io.BytesIO(data))
    return gzip.compress(buffer.getvalue(), mtime=0)


def is_archive(path: Path) -> bool:
    """Whether a file is an archive by its name, or by its first bytes."""
    if path.name.endswith(SUFFIX):
        return True
    with path.open("rb") as file:
        return file.read(len(COMPRESSED)) == COMPRESSED


def read_archive(path: Path) -> dict[str, bytes]:
    """The files of an archive, SHA256SUMS first, by their path in it; every one is as it was packed.

    Raises:
        DamagedFileError: If it is not whole, with the first file that is damaged, missing or not vouched for.
        OSError: If it cannot be read.
    """
    files: dict[str, bytes] = {}
    sums: dict[str, str] = {}
    for name, data in _members(path):
        folder, _, inner = name.partition("/")
        if not files:
            if inner != SUMS:
                raise DamagedFileError(path, f"it begins with {name}, not with {SUMS}")
            sums = _read_sums(path, folder, data)
        elif name not in sums:
            raise DamagedFileError(path, f"{name} is not in its {SUMS}")
        elif _digest(data) != sums.pop(name):
            raise DamagedFileError(path, f"{name} is not what was packed")
        files[name] = data
    if not files:
        raise DamagedFileError(path, "it is empty")
    if sums:
        raise DamagedFileError(path, f"{next(iter(sums))} is missing")
    return files


def unpack(files: Mapping[str, bytes], target: Path) -> Path:
    """Write files that were read from an archive; the folder that they came to.

    They are written beside it first, so that the folder is there with all of them or not at all.

    Raises:
        ValueError: If there is something where they would go.
        OSError: If they cannot be written.
    """
    (folder,) = {PurePosixPath(name).parts[0] for name in files}
    final = target / folder
    if final.exists() or final.is_symlink():
        raise ValueError(f"{final} exists already; nothing was unpacked: remove it, or name another folder")
    make_folder(target)
    beside = Path(tempfile.mkdtemp(prefix=f".{folder}-", dir=target))
    try:
        for name, data in files.items():
            path = beside / PurePosixPath(name).relative_to(folder)
            make_folder(path.parent)
            write_atomically(path, data)
        beside.chmod(0o755)
        beside.rename(final)
    except BaseException:
        shutil.rmtree(beside, ignore_errors=True)
        raise
    return final


def _members(path: Path) -> Iterator[tuple[str, bytes]]:
    """Name and content of every file, in the order of the archive."""
    packed = read_file(path, LARGEST)
    last, size, n_files = "its beginning", 0, 0
    try:
        with tarfile.open(fileobj=io.BytesIO(packed), mode="r|gz") as tar:
            for member in tar:
                last = f"what follows {member.name}"
                if not member.isreg() or not NAME.fullmatch(member.name) or "/" not in member.name:
                    raise DamagedFileError(path, f"{member.name!r} is no plain file below one folder")
                size, n_files = size + member.size, n_files + 1
                if size > LARGEST or n_files > MOST_FILES:
                    raise DamagedFileError(path, f"it holds more than {LARGEST} bytes or {MOST_FILES} files")
                content = tar.extractfile(member)
                data = content.read() if content is not None else b""
                if len(data) < member.size:
                    raise DamagedFileError(path, f"{member.name} is cut off")
                yield member.name, data
    except (tarfile.TarError, EOFError, zlib.error, gzip.BadGzipFile) as error:
        raise DamagedFileError(path, f"{last} cannot be read: {error}") from None
    # A stream ends with what `tarfile` wants; the rest of the file is checked here.
    try:
        gzip.decompress(packed)
    except (EOFError, zlib.error, gzip.BadGzipFile) as error:
        raise DamagedFileError(path, f"its end cannot be read: {error}") from None


def _read_sums(path: Path, folder: str, data: bytes) -> dict[str, str]:
    """Digests by the path of the file in the archive."""
    sums = {}
    for line in data.decode("ascii", "replace").splitlines():
        found = SUM.fullmatch(line)
        if found is None or not NAME.fullmatch(found[2]) or found[2] == SUMS:
            raise DamagedFileError(path, f"its {SUMS} has the line {line[:80]!r}")
        sums[f"{folder}/{found[2]}"] = found[1]
    return sums


def _digest(data: bytes) -> str:
    return hashlib.sha256(data).hexdigest()
