"""A full disk and a read-only one, real ones, in a mount namespace of their own: root may do that."""

import subprocess
import sys

import pytest

from tests.evolution.small_runs import SMALL_FLAGS, contents

pytestmark = pytest.mark.slow
BEGIN = """
import shutil, subprocess, sys
path, *command = sys.argv[1:]
def mount(*arguments):
    subprocess.run(["mount", *arguments, path], check=True)
def evolve():
    done = subprocess.run([sys.executable, "-m", "evolution", *command], capture_output=True, text=True)
    print(done.returncode, done.stderr, end="")
"""


def in_a_namespace(script, path):
    command = ["evolve", *SMALL_FLAGS, f"--output={path}"]
    start = ["unshare", "--mount", "--", sys.executable, "-c", BEGIN + script, str(path), *command]
    return subprocess.run(start, capture_output=True, text=True)


@pytest.fixture(scope="module", autouse=True)
def may_mount(tmp_path_factory):
    path = tmp_path_factory.mktemp("disk")
    if in_a_namespace("mount('-t', 'tmpfs', 'tmpfs')", path).returncode:
        pytest.skip("this system does not let us mount a file system")


def test_a_run_that_filled_its_disk_goes_on_when_there_is_room(finished_run, tmp_path):
    (tmp_path / "run").mkdir()
    script = """
mount("-t", "tmpfs", "-o", "size=60k", "tmpfs")
evolve()
mount("-o", "remount,size=64m")
print(subprocess.run(["find", path, "-name", ".*.tmp"], capture_output=True, text=True).stdout, end="")
evolve()
shutil.copytree(path, path + "-kept")
"""
    done = in_a_namespace(script, tmp_path / "run")
    full, again = done.stdout.splitlines()
    assert full.startswith(f"2 wordarm: {tmp_path / 'run'}/"), done.stderr
    assert "cannot be written: No space left on device; what was written before is whole" in full
    assert again == "0 "
    assert contents(tmp_path / "run-kept") == contents(finished_run)


def test_a_read_only_disk_costs_a_sentence_and_nothing_else(finished_run, run_copy):
    (run_copy / "checkpoint.npz").unlink()
    (run_copy / "parts" / "gen-000200-000229.npz").unlink()
    before = contents(run_copy)
    done = in_a_namespace("mount('--bind', path)\nmount('-o', 'remount,bind,ro')\nevolve()", run_copy)
    assert done.stdout.startswith(f"2 wordarm: {run_copy} cannot be written: Read-only file system;")
    assert done.stdout.count("\n") == 1
    assert contents(run_copy) == before
