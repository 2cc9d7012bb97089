"""Exit codes that mean one thing each: Ctrl-C at any moment, and output that nobody reads."""

import os
import subprocess
import sys

import pytest

from evolution.answers import BROKEN_PIPE, INTERRUPTED
from tests.evolution.small_runs import SMALL_FLAGS

CLOSED = "wordarm: nobody reads the output any more, so the command ended; repeat it to go on\n"
INTERRUPT = """
import sys
moment = sys.argv.pop(1)
class Interrupt:
    @staticmethod
    def find_spec(name, path=None, target=None):
        if name == moment:
            raise KeyboardInterrupt
sys.meta_path.insert(0, Interrupt)
from evolution.__main__ import main
sys.exit(main())
"""


@pytest.mark.parametrize("moment", ["evolution.cli", "tyro", "numpy", "numba", "evolution.runs.run"])
def test_interrupted_while_it_loads_it_ends_with_130_and_one_line(moment, tmp_path):
    command = [
        sys.executable,
        "-c",
        INTERRUPT,
        moment,
        "evolve",
        *SMALL_FLAGS,
        f"--output={tmp_path / 'run'}",
    ]
    done = subprocess.run(command, capture_output=True, text=True)
    assert (done.returncode, done.stderr) == (INTERRUPTED, "wordarm: stopped by Ctrl-C\n")
    assert "Traceback" not in done.stdout
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    "arguments", [["--help"], ["status", "{run}"], ["verify", "{run}"], ["verify", "{run}", "--repair"]]
)
def test_output_that_nobody_reads_has_an_exit_code_of_its_own(arguments, run_copy):
    reading, writing = os.pipe()
    os.close(reading)
    command = [sys.executable, "-m", "evolution", *(each.format(run=run_copy) for each in arguments)]
    done = subprocess.run(command, stdout=writing, stderr=subprocess.PIPE, text=True)
    os.close(writing)
    assert (done.returncode, done.stderr) == (BROKEN_PIPE, CLOSED)


def test_a_run_whose_output_nobody_reads_ends_and_can_be_gone_on_with(tmp_path):
    reading, writing = os.pipe()
    os.close(reading)
    command = [sys.executable, "-m", "evolution", "evolve", *SMALL_FLAGS, f"--output={tmp_path / 'run'}"]
    done = subprocess.run(command, stdout=writing, stderr=subprocess.PIPE, text=True)
    os.close(writing)
    assert (done.returncode, done.stderr) == (BROKEN_PIPE, CLOSED)
    assert subprocess.run(command, capture_output=True).returncode == 0
