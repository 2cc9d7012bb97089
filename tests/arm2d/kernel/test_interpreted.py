"""The kernel without the compiler, whose code asks no index whether it lies within its array."""

import os
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[3]
TESTS = ("test_world.py", "kernel/test_camera_at_end.py", "kernel/interpreted.py")


def test_the_interpreted_kernel_stays_within_its_arrays_and_obeys_the_same_rules():
    files = [f"tests/arm2d/{name}" for name in TESTS]
    done = subprocess.run(
        [sys.executable, "-m", "pytest", "-x", "-p", "no:cacheprovider", *files],
        cwd=ROOT,
        env={**os.environ, "NUMBA_DISABLE_JIT": "1"},
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0, done.stdout
