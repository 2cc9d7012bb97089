"""How inputs are malformed: bytes, texts, numbers, arrays, archives."""

import hashlib
import io
import os
import pickle
import random
import warnings
import zipfile
from functools import cache

import numpy as np

from evolution.runs.storage import DIGEST_LENGTH, pack_arrays

HOSTILE_TEXTS = (
    "", " ", "\n", "\0", "\x1b[31m", "../../escape", "/etc/passwd", "~", "-", "--", "nan", "inf", "-1",
    "9" * 400, "9" * 5000, "٣", "é" * 300, "\ud800", "\u202e", "{0}", "%s%n", "$(touch executed)",
    "`touch executed`", "a" * 5000, "None", "true", "[]", "touch green", "with-indicate", "x\ny", "0x10",
    "1_000", "2**63", "1e999", "'", '"',
)  # fmt: skip
HOSTILE_NUMBERS = (
    "0", "-1", "1.5", "nan", "inf", "-inf", "1e999", "1e-400", "9223372036854775808", "1" + "0" * 400,
    "-9223372036854775809", "true", '"3"', "[]", "{}", "2024-01-01", "[[[]]]", "0x7f", "1_0", "''", "+1",
    "[1, 2, 3]", "[30, 90, 1" + "0" * 400 + "]", "'1-99999999999'", "[1, 1]",
)  # fmt: skip
HOSTILE_NAMES = (
    "genotypes.npy", "../../escape.npy", "/escape.npy", "config.npy", "genotypes", "fitness.npy",
)  # fmt: skip
DTYPES = (
    "<f8", ">f8", "<f4", "<i8", "<u1", "<U3", "|b1", "<c16", "<M8[s]", "|S4", "|V8", "<f2", "<U0", "|V0",
)  # fmt: skip
SHAPES = (
    "(1000000000000,)", "(10, 84)", "(-1, 84)", "(-1, -84)", "()", "(84,)", "(0, 10000000000000000000)",
    "(2.0,)", "(True,)", "'84'", "(" * 900 + ")" * 900, "(" + "1, " * 3000 + ")", "(9" + "9" * 4000 + ",)",
    "__import__('os').mkdir('executed')",
)  # fmt: skip
DESCRIPTIONS = (
    "'<f8'", "'|O'", "'<U2000000000'", "[('a', '<f8')]", "'<f9'", "1", "('<f8', (10**9,))", "''", "'O'",
    "[('a', '|O')]", "'<M8'", "'" + "x" * 5000 + "'",
)  # fmt: skip
VERSIONS = ((b"\x01\x00", 2), (b"\x02\x00", 4), (b"\x03\x00", 4), (b"\x09\x09", 2))


class Trap:
    """Unpickled, it makes a file: whoever finds that file has found a parser that executes its input."""

    def __init__(self, path):
        self.path = str(path)

    def __reduce__(self):
        return os.mkdir, (self.path,)


def mangled(rng: random.Random, data: bytes) -> bytes:
    """Bytes cut, flipped, doubled, overwritten or replaced."""
    if not data:
        return rng.randbytes(rng.randrange(1, 200))
    at, n = rng.randrange(len(data)), min(1 + int(rng.expovariate(0.1)), len(data))
    changes = (
        lambda: data[:at],
        lambda: data[:at] + data[at + n :],
        lambda: data[:at] + rng.randbytes(n) + data[at + n :],
        lambda: data[:at] + bytes(n) + data[at + n :],
        lambda: data[:at] + data[max(at - n, 0) : at] * rng.randrange(1, 50) + data[at:],
        lambda: data[:at] + bytes([data[at] ^ 1 << rng.randrange(8)]) + data[at + 1 :],
        lambda: rng.randbytes(n),
        lambda: data + rng.randbytes(n),
    )
    return rng.choice(changes)()


def sealed(data: bytes) -> bytes:
    """The same with a checksum that fits, so that whoever reads it must look at the content."""
    content = data[:-DIGEST_LENGTH] if len(data) > DIGEST_LENGTH else data
    return content + hashlib.sha256(content).hexdigest().encode()


def toml_text(rng: random.Random, sound: str) -> str:
    """A config.toml that is malformed, in its values, its keys or its letters."""
    lines = sound.splitlines()
    at = rng.randrange(len(lines))
    key = lines[at].partition("=")[0].strip() or "seed"
    changes = (
        lambda: [*lines[:at], f"{key} = {rng.choice(HOSTILE_NUMBERS)}", *lines[at + 1 :]],
        lambda: [*lines[:at], f"{key} = {rng.choice(HOSTILE_TEXTS)!r}", *lines[at + 1 :]],
        lambda: [*lines[:at], f"{rng.choice(HOSTILE_TEXTS)!r} = 1", *lines[at:]],
        lambda: [*lines[:at], f"[{'.'.join('a' * rng.randrange(1, 4000))}]", *lines[at:]],
        lambda: [*lines[:at], f"{key} = {'[' * rng.randrange(1, 9000)}", *lines[at:]],
        lambda: [*lines[:at], f"{key} = {'{a=' * rng.randrange(1, 3000)}", *lines[at:]],
        lambda: [*lines[:at], f"{key}{'.a' * rng.randrange(1, 15000)} = 1", *lines[at + 1 :]],
        lambda: lines[:at] + lines[at + 1 :],
        lambda: rng.sample(lines, len(lines)),
        lambda: lines * rng.randrange(2, 200),
        lambda: [mangled(rng, sound.encode()).decode(errors="replace")],
    )
    return "\n".join(rng.choice(changes)())


def mistaken_arrays(rng: random.Random, arrays: dict, trap) -> bytes:
    """An archive with a fitting checksum whose arrays are not what they should be."""
    changed, name = dict(arrays), rng.choice(sorted(arrays))
    array = np.asarray(arrays[name])
    changes = (
        lambda: changed.pop(name),
        lambda: changed.update({name: array.reshape(-1)[: rng.randrange(array.size + 1)]}),
        lambda: changed.update({name: array[np.newaxis]}),
        lambda: changed.update({name: np.zeros(array.shape, rng.choice(DTYPES))}),
        lambda: changed.update({name: np.array(rng.choice(("", "seed", "format = 1", "x" * 1000)))}),
        lambda: changed.update({name: _with_hostile_numbers(rng, array)}),
        lambda: changed.update({rng.choice(HOSTILE_TEXTS[5:9]): array}),
    )
    kind = rng.randrange(len(changes) + 1)
    if kind == len(changes):
        return sealed(archive(rng, array, trap))
    changes[kind]()
    return pack_arrays(changed)


def archive(rng: random.Random, array, trap) -> bytes:
    """An .npz as nobody should write one: pickles, bombs, headers that lie, members with paths."""
    name = rng.choice(HOSTILE_NAMES)
    method = rng.choice((zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED, zipfile.ZIP_BZIP2, zipfile.ZIP_LZMA))
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", method) as file, warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of names that stand twice
        for _ in range(rng.choice((1, 1, 2, 200))):
            file.writestr(name, npy(rng, array, trap))
        file.comment = b"-" * rng.choice((0, DIGEST_LENGTH))
    return buffer.getvalue()


@cache
def bomb() -> bytes:
    """A small archive of one array that would fill the memory, if 128 MB did."""
    buffer = io.BytesIO()
    with (
        zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as file,
        file.open("genotypes.npy", "w") as member,
    ):
        member.write(
            b"\x93NUMPY\x01\x00\x76\x00{'descr': '|u1', 'fortran_order': False, 'shape': (134217728,) , }"
        )
        for _ in range(8):
            member.write(bytes(2**24))
    return buffer.getvalue()


def npy(rng: random.Random, array, trap) -> bytes:
    """An .npy whose header lies, or which holds what must not be loaded."""
    kind, buffer = rng.randrange(5), io.BytesIO()
    if kind == 0:
        np.save(buffer, np.array([Trap(trap)], dtype=object), allow_pickle=True)
        return buffer.getvalue()
    if kind == 1:
        return pickle.dumps(Trap(trap))
    if kind == 2:
        np.save(buffer, array)
        return mangled(rng, buffer.getvalue())
    order = rng.choice(("False", "True", "1", "x"))
    header = (
        f"{{'descr': {rng.choice(DESCRIPTIONS)}, 'fortran_order': {order}, 'shape': {rng.choice(SHAPES)}, }}"
    )
    version, width = rng.choice(VERSIONS)
    length = min(len(header), 2 ** (8 * width) - 1).to_bytes(width, "little")
    return b"\x93NUMPY" + version + length + header.encode() + rng.randbytes(rng.choice((0, 8, 672, 6720)))


def _with_hostile_numbers(rng: random.Random, array):
    """The same with some numbers that cannot be."""
    if array.dtype.kind not in "fiu" or not array.size:
        return np.full(array.shape, np.nan)
    changed = array.copy().reshape(-1)
    limits = np.finfo(array.dtype) if array.dtype.kind == "f" else np.iinfo(array.dtype)
    extremes = (np.nan, np.inf) if array.dtype.kind == "f" else (81, 7)
    value = rng.choice((limits.max, limits.min, 0, 1, *extremes))
    changed[rng.randrange(changed.size) :: rng.randrange(1, changed.size + 1)] = value
    return changed.reshape(array.shape)
