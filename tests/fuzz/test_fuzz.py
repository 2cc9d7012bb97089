"""The fuzzer in short, and the worst inputs in processes of their own."""

import io
import resource
import subprocess
import sys
import zipfile

import numpy as np
import pytest

from tests.fuzz.__main__ import fuzz
from tests.fuzz.inputs import KINDS
from tests.fuzz.mutations import Trap, bomb
from tests.fuzz.places import Place


@pytest.fixture(scope="module")
def place(tmp_path_factory):
    return Place(tmp_path_factory.mktemp("fuzz") / "place")


@pytest.mark.parametrize("kind", KINDS)
def test_malformed_inputs_are_refused_in_one_sentence_or_read(place, kind, capsys):
    assert fuzz(place, [kind], seed=7, first=0, n=25) == 0, capsys.readouterr().err


def claiming(shape):
    """An .npz whose header tells of more numbers than there are bytes."""
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w") as file:
        header = f"{{'descr': '<f8', 'fortran_order': False, 'shape': {shape}, }}".encode()
        file.writestr("genotypes.npy", b"\x93NUMPY\x01\x00" + len(header).to_bytes(2, "little") + header)
    return buffer.getvalue()


def pickled(trap):
    buffer = io.BytesIO()
    np.savez(buffer, genotypes=np.array([Trap(trap)], dtype=object))
    return buffer.getvalue()


@pytest.mark.parametrize(
    ("data", "sentence"),
    [
        (lambda trap: bomb(), "its content is larger than 64 MB"),
        (
            lambda trap: claiming((10**12,)),
            "its header tells of (1000000000000,) of float64, but 0 bytes follow",
        ),
        (pickled, "it holds object, not numbers or text"),
    ],
)
def test_the_worst_files_cost_a_process_neither_memory_nor_its_senses(tmp_path, data, sentence):
    path, trap = tmp_path / "mine.npz", tmp_path / "executed"
    path.write_bytes(data(trap))
    done = subprocess.run(
        [sys.executable, "-m", "evolution", "evaluate", str(path)],
        capture_output=True,
        text=True,
        cwd=tmp_path,
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_DATA, (2**30, 2**30)),
    )
    assert done.returncode == 2
    assert sentence in done.stderr
    assert done.stderr.count("\n") == 1
    assert list(tmp_path.iterdir()) == [path]
