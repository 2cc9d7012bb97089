"""Whatever a file, a table or a text holds: it is understood, or refused by a ValueError."""

import bz2
import contextlib
import io
import lzma
import struct
import tracemalloc
import zipfile
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from arm2d import Instruction, Readings
from evolution.experiments.grid import experiment_from_mapping
from evolution.runs.arrays import MOST_ARRAYS, UnreadableError, unpack_archive, unpack_array
from evolution.search.config import RunConfig
from evolution.search.settings import Settings
from evolution.search.toml import DEEPEST, read_toml

KEYS = [
    "format",
    "condition",
    "seed",
    "settings",
    "readings",
    "conditions",
    "seeds",
    "output",
    "variant",
    "name",
]
FIELDS = [*Settings().to_mapping(), *Readings().to_mapping(), *KEYS]
PLAIN = (
    st.none() | st.booleans() | st.integers() | st.integers(-(10**400), 10**400) | st.floats() | st.text()
    | st.sampled_from(["with-indicate", "1-8", "raw", "../x"])
)  # fmt: skip
VALUES = st.recursive(
    PLAIN,
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.sampled_from(FIELDS), inner, max_size=4),
)
TABLES = st.dictionaries(st.sampled_from(FIELDS), VALUES, max_size=5)
SOUND = {"format": 1, "condition": "with-indicate", "seed": 1}


@given(TABLES, st.sampled_from([{}, SOUND]))
def test_a_config_of_any_values_is_a_run_or_refused(values, sound):
    with contextlib.suppress(ValueError):
        config = RunConfig.from_mapping({**values, **sound})
        assert RunConfig.from_toml(config.to_toml()) == config


@given(
    st.sampled_from(["readings", "settings"]), st.sampled_from(FIELDS), PLAIN | st.lists(PLAIN, max_size=4)
)
def test_any_value_of_a_setting_or_reading_is_a_run_or_refused(table, name, value):
    with contextlib.suppress(ValueError):
        config = RunConfig.from_mapping({**SOUND, table: {name: value}})
        assert RunConfig.from_toml(config.to_toml()) == config


@given(TABLES)
def test_an_experiment_of_any_values_is_a_plan_below_its_folder_or_refused(values):
    with contextlib.suppress(ValueError):
        folder = experiment_from_mapping(values, Path("runs") / "x").plan().folder
        assert not folder.is_absolute()
        assert ".." not in folder.parts


@given(st.text() | st.text("[]{}=.,'\"\n a1", max_size=300))
def test_any_text_is_toml_of_bounded_depth_or_refused(text):
    with contextlib.suppress(ValueError):
        assert depth(read_toml(text)) <= DEEPEST


@given(
    st.integers(1, 30_000),
    st.sampled_from(["a = " + "[" * 30_000, "a = " + "{b=" * 9_000, "a" + ".b" * 15_000]),
)
def test_depth_is_refused_however_it_is_written(length, text):
    with contextlib.suppress(ValueError):
        assert depth(read_toml(text[:length])) <= DEEPEST


@given(st.binary(max_size=400) | st.binary(max_size=200).map(lambda data: b"\x93NUMPY\x01\x00" + data))
def test_any_bytes_are_an_array_or_refused(data):
    for unpack in (unpack_array, unpack_archive):
        with contextlib.suppress(UnreadableError):
            unpack(data)


@given(st.text() | st.lists(st.sampled_from(["touch", "MOVE", "green", "red", " ", "\u017f"])).map("".join))
def test_any_text_is_an_instruction_or_refused(text):
    with contextlib.suppress(ValueError):
        assert Instruction.parse(str(Instruction.parse(text))) == Instruction.parse(text)


@pytest.mark.parametrize(
    "kind", ["|O", "[('a', '<f8')]", "[('a', '|O')]", "|V8", "<M8[s]", "|S4", "<U0", "|V0"]
)
def test_an_array_of_anything_but_numbers_and_text_is_refused(kind):
    described = kind if kind.startswith("[") else f"'{kind}'"
    with pytest.raises(UnreadableError, match=r"not numbers or text|does not begin as|items of 0 bytes"):
        unpack_array(npy(described, "(1000000000,)"))


@pytest.mark.parametrize(
    "shape",
    ["(1000000000000,)", "(4294967296, 4294967296)", f"({2**63},)", f"({2**64}, 0)", "(-1,)"],
)
def test_a_shape_that_nothing_follows_is_refused_before_it_is_made(shape):
    tracemalloc.start()
    with pytest.raises(UnreadableError):
        unpack_array(npy("'<f8'", shape))
    assert tracemalloc.get_traced_memory()[1] < 2**20
    tracemalloc.stop()


@pytest.mark.parametrize(
    ("method", "data"),
    [(zipfile.ZIP_LZMA, lzma.compress(bytes(10**6))), (zipfile.ZIP_BZIP2, bz2.compress(bytes(10**6)))],
)
def test_only_the_compression_of_an_npz_is_unpacked(method, data):
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", method) as archive:
        archive.writestr("genotypes.npy", data)
    with pytest.raises(UnreadableError, match=r"its compression is not that of an \.npz"):
        unpack_archive(stream.getvalue())


@pytest.mark.parametrize("name", ["../escape.npy", "/tmp/escape.npy", "a/../../escape.npy"])
def test_a_name_in_an_archive_is_a_name_and_no_place(name, tmp_path, monkeypatch):
    (tmp_path / "here").mkdir()
    monkeypatch.chdir(tmp_path / "here")
    arrays = unpack_archive(archive_of({name: npy("'<f8'", "(1,)", bytes(8))}))
    assert list(arrays) == [name.removesuffix(".npy")]
    assert list(tmp_path.rglob("*")) == [tmp_path / "here"]


def test_an_archive_of_very_many_members_is_refused_before_they_are_listed():
    archive = archive_of({f"{n}.npy": b"" for n in range(MOST_ARRAYS + 1)})
    with pytest.raises(UnreadableError, match="it holds more than 100 arrays"):
        unpack_archive(archive)


def test_a_number_with_very_many_digits_is_refused():
    with pytest.raises(ValueError, match="this is not TOML"):
        read_toml("a = " + "9" * 5000)


def npy(described, shape, content=b""):
    """An .npy by its header's words."""
    header = f"{{'descr': {described}, 'fortran_order': False, 'shape': {shape}}}".encode()
    return b"\x93NUMPY\x01\x00" + len(header).to_bytes(2, "little") + header + content


def archive_of(members):
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w") as archive:
        for name, data in members.items():
            archive.writestr(name, data)
    return stream.getvalue()


def depth(value):
    if isinstance(value, dict):
        return 1 + max(map(depth, value.values()), default=0)
    return 1 + max(map(depth, value), default=0) if isinstance(value, list) else 0


def test_an_archive_that_lies_about_its_size_is_read_no_further_than_it_says():
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("genotypes.npy", bytes(50_000_000))
    data = bytearray(buffer.getvalue())
    struct.pack_into("<I", data, data.rindex(b"PK\x01\x02") + 24, 1000)  # its uncompressed size
    tracemalloc.start()
    try:
        with pytest.raises(UnreadableError, match=r"Bad CRC-32 for file 'genotypes\.npy'"):
            unpack_archive(bytes(data))
        assert tracemalloc.get_traced_memory()[1] < 2_000_000
    finally:
        tracemalloc.stop()


@pytest.mark.parametrize("kind", ["<U0", "<f8"])
def test_items_without_size_are_refused_before_any_is_made(kind):
    buffer = io.BytesIO()
    header = {"descr": kind, "fortran_order": False, "shape": (10**9,)}
    np.lib.format.write_array_header_1_0(buffer, header)
    with pytest.raises(UnreadableError, match=r"items of 0 bytes|but 0 bytes follow"):
        unpack_array(buffer.getvalue())
