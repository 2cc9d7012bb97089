import io
import os
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from evolution.runs.storage import DamagedFileError, pack_arrays, read_arrays, write_arrays, write_atomically

ARRAYS = {
    "name": np.array("seed 7"),
    "genes": np.random.default_rng(0).random((3, 84)),
    "none": np.empty((0, 2)),
}
PACKED = pack_arrays(ARRAYS)


def test_arrays_come_back_bit_by_bit(tmp_path):
    write_arrays(tmp_path / "file.npz", ARRAYS)
    read = read_arrays(tmp_path / "file.npz")
    assert list(read) == list(ARRAYS)
    for name, array in ARRAYS.items():
        assert read[name].dtype == array.dtype
        assert read[name].tobytes() == array.tobytes()


def test_numpy_alone_can_read_the_file():
    with np.load(io.BytesIO(PACKED)) as archive:
        assert np.array_equal(archive["genes"], ARRAYS["genes"])


def test_equal_arrays_give_equal_files():
    assert pack_arrays(ARRAYS) == PACKED


@given(st.integers(0, 8 * len(PACKED) - 1))
def test_a_single_flipped_bit_is_noticed(tmp_path_factory, bit):
    damaged = bytearray(PACKED)
    damaged[bit // 8] ^= 1 << bit % 8
    path = tmp_path_factory.mktemp("flipped") / "file.npz"
    path.write_bytes(damaged)
    with pytest.raises(DamagedFileError, match="its checksum does not fit its content"):
        read_arrays(path)


@given(st.integers(0, len(PACKED) - 1))
def test_a_truncated_file_is_noticed(tmp_path_factory, length):
    path = tmp_path_factory.mktemp("truncated") / "file.npz"
    path.write_bytes(PACKED[:length])
    with pytest.raises(DamagedFileError):
        read_arrays(path)


def test_a_failed_write_leaves_the_old_file_and_nothing_else(tmp_path, monkeypatch):
    path = tmp_path / "file"
    write_atomically(path, b"old")

    def fail(handle):
        raise OSError(28, os.strerror(28))

    monkeypatch.setattr(os, "fsync", fail)
    with pytest.raises(OSError, match="file cannot be written: No space left on device"):
        write_atomically(path, b"new")
    assert path.read_bytes() == b"old"
    assert list(tmp_path.iterdir()) == [path]


def test_what_is_written_and_then_its_folder_reach_the_disk(tmp_path, monkeypatch):
    """Without the first flush a power cut may leave an empty file, without the second the old one."""
    path, flushed, flush = tmp_path / "file", [], os.fsync
    path.write_bytes(b"old")

    def spy(handle):
        flushed.append((os.path.realpath(f"/proc/self/fd/{handle}"), path.read_bytes()))
        flush(handle)

    monkeypatch.setattr(os, "fsync", spy)
    write_atomically(path, b"new")
    (temporary, before), (folder, after) = flushed
    assert Path(temporary).parent == tmp_path
    assert Path(temporary).name.startswith(".file.")
    assert (before, folder, after) == (b"old", str(tmp_path), b"new")


def test_objects_are_never_stored():
    with pytest.raises(ValueError, match="Object arrays cannot be saved"):
        pack_arrays({"object": np.array([{}])})
