"""Whatever a file, a table or a text holds: it is understood, or refused by a ValueError."""

import contextlib
import io
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
from evolution.runs.arrays import UnreadableError, unpack_archive, unpack_array
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
