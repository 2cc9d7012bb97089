import json

import pytest
from golden import RUNS, STORED, fingerprint


@pytest.mark.parametrize("name", RUNS)
def test_a_short_run_gives_the_stored_bits(name):
    """On every x86-64 machine. How the reference is remade stands in golden.py."""
    assert fingerprint(RUNS[name]) == json.loads(STORED.read_text())[name]
