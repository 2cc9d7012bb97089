"""Real processes, killed and stopped from outside."""

import random
import resource
import signal
import subprocess
import sys
import time

import pytest

from tests.evolution.small_runs import SMALL_FLAGS, contents

pytestmark = pytest.mark.slow
COMMAND = [sys.executable, "-m", "evolution", "evolve", *SMALL_FLAGS]


def start(path, *, limit=None):
    """Start the small run as a process and wait until it scores its first generation."""
    process = subprocess.Popen(
        [*COMMAND, f"--output={path}"],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        preexec_fn=limit,
    )
    line = process.stdout.readline()
    assert "from generation" in line or "finished" in line
    return process


def test_a_run_killed_again_and_again_equals_an_undisturbed_one(finished_run, tmp_path):
    rng, path, outcomes = random.Random(0), tmp_path / "run", []
    for _ in range(6):
        process = start(path)
        time.sleep(rng.uniform(0.0, 0.12))
        process.kill()
        process.communicate()
        outcomes.append(process.returncode)
    assert -signal.SIGKILL in outcomes  # else the run was over before the first kill
    last = subprocess.run([*COMMAND, f"--output={path}"], capture_output=True, text=True)
    assert last.returncode == 0, last.stderr
    assert contents(path) == contents(finished_run)


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_run_asked_to_stop_says_how_to_go_on_and_loses_nothing(finished_run, tmp_path, number):
    process = start(tmp_path / "run")
    time.sleep(0.05)
    process.send_signal(number)
    output, errors = process.communicate(timeout=120)
    assert process.returncode == 130, errors
    assert "of 230 generations; go on with the same command" in output
    assert errors == ""
    assert (tmp_path / "run" / "checkpoint.npz").exists()
    again = subprocess.run([*COMMAND, f"--output={tmp_path / 'run'}"], capture_output=True, text=True)
    assert again.returncode == 0, again.stderr
    assert contents(tmp_path / "run") == contents(finished_run)


def test_a_full_disk_costs_a_sentence_and_nothing_else(finished_run, tmp_path):
    def tiny_files():
        resource.setrlimit(resource.RLIMIT_FSIZE, (20_000, 20_000))

    process = start(tmp_path / "run", limit=tiny_files)
    _, errors = process.communicate(timeout=120)
    assert process.returncode == 2
    assert errors.startswith("wordarm: ")
    assert errors.count("\n") == 1
    assert "gen-000000-000099.npz cannot be written: File too large" in errors
    assert list((tmp_path / "run" / "parts").iterdir()) == []
    again = subprocess.run([*COMMAND, f"--output={tmp_path / 'run'}"], capture_output=True, text=True)
    assert again.returncode == 0, again.stderr
    assert contents(tmp_path / "run") == contents(finished_run)
