"""Arrays out of bytes that anyone may have written: nothing is executed, and memory stays bounded.

NumPy's own reader believes a header: one that claims 10^12 numbers makes it ask for 8 TB. Here a header is
held against the bytes that are there before anything is made.
"""

from __future__ import annotations

import io
import math
import zipfile
import zlib
from collections.abc import Mapping
from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray

from arm2d.files import NoFileError, read_file

# Far above any file of this project; keeps a mistaken or malicious file from filling the memory.
LARGEST_CONTENT: Final = 64 * 2**20
MOST_ARRAYS: Final = 100
# Truth values, whole numbers, floating-point numbers, text: no objects, records or dates.
KINDS: Final = "biufU"
LAST_CHARACTER: Final = 0x10FFFF
PLAIN_METHODS: Final = (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED)
HEADERS: Final = {
    (1, 0): np.lib.format.read_array_header_1_0,
    (2, 0): np.lib.format.read_array_header_2_0,
}
ENDING: Final = ".npy"
# How an archive's directory begins what it tells of a member.
ENTRY: Final = b"PK\x01\x02"


class UnreadableError(ValueError):
    """Bytes that are no arrays, or more than anyone wants."""


def read_genotype_file(path: Path) -> Mapping[str, NDArray]:
    """The named arrays of an .npz, or the only one of an .npy as "genotypes"; not yet held against anything.

    Raises:
        ValueError: If it is neither, or too large.
        OSError: If it cannot be read.
    """
    refusal = f"{path} is not a genotype file: give an .npz with an array genotypes [P, 84], or an .npy"
    try:
        data = read_file(path, LARGEST_CONTENT)
        if zipfile.is_zipfile(io.BytesIO(data)):
            return unpack_archive(data)
        return {"genotypes": unpack_array(data)}
    except (NoFileError, UnreadableError) as error:
        raise ValueError(f"{refusal} ({error})") from None


def unpack_archive(data: bytes) -> dict[str, NDArray]:
    """The named arrays of an .npz.

    Raises:
        UnreadableError: If it is none, or its content is larger than `LARGEST_CONTENT`.
    """
    if data.count(ENTRY) > MOST_ARRAYS:  # told before a list of them is made
        raise UnreadableError(f"it holds more than {MOST_ARRAYS} arrays")
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            members = archive.infolist()
            _check_members(members)
            return {
                each.filename.removesuffix(ENDING): unpack_array(_content(archive, each)) for each in members
            }
    except UnreadableError:
        raise
    # What a broken or foreign archive brings about in the reader, encryption included.
    except (
        zipfile.BadZipFile,
        zlib.error,
        OSError,
        EOFError,
        ValueError,
        RuntimeError,
        NotImplementedError,
    ) as e:
        raise UnreadableError(f"it is not an archive of arrays: {e}") from None


def unpack_array(data: bytes) -> NDArray:
    """The array of an .npy.

    Raises:
        UnreadableError: If it is none, or holds anything but numbers or text.
    """
    stream = io.BytesIO(data)
    shape, by_columns, dtype = _header(stream)
    if dtype.hasobject or dtype.kind not in KINDS:
        raise UnreadableError(f"it holds {dtype}, not numbers or text")
    if not dtype.itemsize:
        raise UnreadableError("it holds items of 0 bytes, of which any number has no size")
    room = len(data) - stream.tell()
    if any(n < 0 for n in shape) or math.prod(shape) * dtype.itemsize != room:
        raise UnreadableError(f"its header tells of {_shown(shape)} of {dtype}, but {room} bytes follow")
    try:
        # A copy, for these bytes may stand at any address.
        array = np.ndarray(shape, dtype, data, stream.tell(), order="F" if by_columns else "C").copy("K")
    except (ValueError, TypeError, OverflowError) as error:
        raise UnreadableError(f"its shape {_shown(shape)} is impossible: {error}") from None
    if dtype.kind == "U" and not _is_text(array):
        raise UnreadableError("it holds text with characters that do not exist")
    return array


def _content(archive: zipfile.ZipFile, member: zipfile.ZipInfo) -> bytes:
    """The bytes of a member; unpacked no further than its size, which may be a lie."""
    with archive.open(member) as file:
        return file.read(member.file_size)


def _check_members(members: list[zipfile.ZipInfo]) -> None:
    """Refuse an archive that would swell, or whose members are no plain arrays."""
    if len(members) > MOST_ARRAYS:
        raise UnreadableError(f"it holds {len(members)} arrays, more than {MOST_ARRAYS}")
    if sum(each.file_size for each in members) > LARGEST_CONTENT:
        raise UnreadableError(f"its content is larger than {LARGEST_CONTENT // 2**20} MB")
    for member in members:
        if member.compress_type not in PLAIN_METHODS:
            raise UnreadableError("its compression is not that of an .npz")


def _header(stream: io.BytesIO) -> tuple[tuple[int, ...], bool, np.dtype]:
    """Shape, order and kind; the stream then stands at the first number."""
    try:
        version = np.lib.format.read_magic(stream)
        if version not in HEADERS:
            raise UnreadableError(f"version {version[0]}.{version[1]} of .npy is not read here")
        return HEADERS[version](stream)
    except UnreadableError:
        raise
    # NumPy reads the header as a literal of Python: malformed, it fails in as many ways as a source text can.
    except Exception as error:
        raise UnreadableError(f"it does not begin as an .npy does: {error}") from None


def _is_text(array: NDArray) -> bool:
    """Whether all characters of an array of text exist; NumPy would fail on others later."""
    code = np.dtype("u4").newbyteorder(array.dtype.byteorder)  # type: ignore[arg-type]
    return bool((np.frombuffer(array.tobytes(), code) <= LAST_CHARACTER).all())


def _shown(shape: tuple[int, ...]) -> str:
    """A shape, cut short if someone made it long."""
    text = str(shape)
    return text if len(text) < 100 else f"{text[:100]}..."
