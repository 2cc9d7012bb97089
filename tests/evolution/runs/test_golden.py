import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from tests.evolution.runs.golden import BASE, RUNS, STORED, fingerprint

STORED_BITS = json.loads(STORED.read_text())
SHORT_RUNS = [name for name in RUNS if name not in BASE]


@pytest.mark.parametrize("name", RUNS)
def test_a_short_run_gives_the_stored_bits(name):
    """On every x86-64 machine. How the reference is remade stands in golden.py."""
    assert fingerprint(RUNS[name]) == STORED_BITS[name]


def test_every_alternative_is_another_experiment():
    assert list(STORED_BITS) == list(RUNS)
    assert len(set(STORED_BITS.values())) == len(RUNS)


@pytest.mark.slow
def test_compiled_for_the_oldest_x86_64_all_readings_give_the_stored_bits():
    """One process, compiled once; `python -m benchmarks.same_bits` does the same for newer targets."""
    script = (
        "import json; from tests.evolution.runs import golden; "
        f"print(json.dumps(golden.fingerprints({SHORT_RUNS!r})))"
    )
    done = subprocess.run(
        [sys.executable, "-c", script],
        cwd=Path(__file__).parents[3],
        env={**os.environ, "NUMBA_CPU_NAME": "x86-64", "NUMBA_CPU_FEATURES": ""},
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout) == {name: STORED_BITS[name] for name in SHORT_RUNS}
