"""Files that are either whole or refused: atomic writing, checksums, arrays without pickles.

An `.npz` of this project ends in an archive comment: the SHA-256 of every byte before it, in
hexadecimal. NumPy and unzip pass over it; `read_arrays` verifies it before anything is parsed.
"""

from __future__ import annotations

import hashlib
import io
import zipfile
from collections.abc import Mapping
from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray

from arm2d.files import NoFileError, opened_folder, read_file, write_whole
from evolution.runs.arrays import LARGEST_CONTENT, UnreadableError, unpack_archive

# Length of a SHA-256 in hexadecimal.
DIGEST_LENGTH: Final = 64


class DamagedFileError(ValueError):
    """A file is not what was once written: truncated, altered, or of another run.

    Attributes:
        path: The file.
        found: What is wrong with it.
    """

    def __init__(self, path: Path, found: str, next_move: str = "") -> None:
        self.path, self.found = path, found
        super().__init__(f"{path} is damaged ({found})" + (f"; {next_move}" if next_move else ""))


def make_folder(path: Path) -> None:
    """Make a folder and those above it, as far as they are not there.

    Raises:
        OSError: If that is impossible.
    """
    try:
        with opened_folder(path, make=True):
            pass
    except OSError as error:
        raise OSError(
            f"{path} cannot be made: {_obstacle(path) or error.strerror}; choose another folder"
        ) from None


def _obstacle(path: Path) -> str | None:
    """What stands where a folder should be made, if that can be told."""
    for place in (path, *path.parents):
        if place.is_symlink() and not place.exists():
            return f"{_name(place, path)} is a link to {place.readlink()}, which does not exist"
        if place.is_file():
            return f"{_name(place, path)} is a file"
    return None


def _name(place: Path, path: Path) -> str:
    return "it" if place == path else str(place)


def write_atomically(path: Path, data: bytes) -> None:
    """Write a file so that a kill at any moment leaves either the old file or the new one.

    Raises:
        OSError: If it cannot be written; the old file, if any, is still there.
    """
    try:
        write_whole(path, data)
    except OSError as error:
        raise OSError(
            f"{path} cannot be written: {error.strerror}; what was written before is whole: "
            "put this right, then repeat the command"
        ) from None


def write_arrays(path: Path, arrays: Mapping[str, NDArray]) -> None:
    """Write named arrays as a compressed `.npz` with a checksum, atomically.

    Raises:
        OSError: As `write_atomically`.
    """
    write_atomically(path, pack_arrays(arrays))


def read_arrays(path: Path) -> dict[str, NDArray]:
    """The arrays of a file of `write_arrays`.

    Raises:
        DamagedFileError: If a single bit differs from what was written.
        OSError: If the file cannot be read.
    """
    try:
        return unpack_archive(verified_bytes(path))
    except UnreadableError as error:
        raise DamagedFileError(path, str(error)) from None


def verified_bytes(path: Path) -> bytes:
    """The bytes of such a file, once its checksum is found to fit; raises as `read_arrays`."""
    try:
        data = read_file(path, LARGEST_CONTENT)
    except NoFileError as error:
        raise DamagedFileError(path, str(error)) from None
    content, digest = data[:-DIGEST_LENGTH], data[-DIGEST_LENGTH:]
    if hashlib.sha256(content).hexdigest().encode() != digest:
        raise DamagedFileError(path, "its checksum does not fit its content")
    return data


def pack_arrays(arrays: Mapping[str, NDArray]) -> bytes:
    """The bytes of such a file. Equal arrays give equal bytes."""
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, array in arrays.items():
            with archive.open(f"{name}.npy", "w") as member:
                np.lib.format.write_array(member, np.asarray(array), allow_pickle=False)
        archive.comment = b"-" * DIGEST_LENGTH  # keeps the place
    content = buffer.getvalue()[:-DIGEST_LENGTH]
    return content + hashlib.sha256(content).hexdigest().encode()
