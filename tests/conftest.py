"""What the tests of several packages share."""

import gc
import os
import shutil
import signal
import subprocess
import sys
import threading
from pathlib import Path

import numpy as np
import pytest
from hypothesis import settings

# The same examples every time, and no deadline: a busy machine is no fault.
settings.register_profile("wordarm", derandomize=True, deadline=None)
settings.load_profile("wordarm")

# Whoever starts the tests in the background lets them ignore Ctrl-C and its kin; the programs that are tried
# here must not inherit that.
if threading.current_thread() is threading.main_thread():
    for number in (signal.SIGINT, signal.SIGQUIT, signal.SIGHUP, signal.SIGXCPU):
        if signal.getsignal(number) is signal.SIG_IGN:
            signal.signal(number, signal.default_int_handler if number == signal.SIGINT else signal.SIG_DFL)


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_auto_num_workers() -> int:
    """One more worker than there are processors: some tests wait for programs, and others can go on then."""
    return len(os.sched_getaffinity(0)) + 1


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_setupnodes(config: pytest.Config) -> None:
    """Compile what was changed since set-up for all workers; whoever is sooner compiles for itself."""
    command = [sys.executable, "-m", "scripts.warm_up"]
    compiling = subprocess.Popen(
        command, cwd=config.rootpath, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
    )
    config.add_cleanup(compiling.wait)


def pytest_collection_finish() -> None:
    """Let the collector pass over what stays to the end: modules, tests, and all that belongs to them.

    Looking through it again and again took a fifth of the time of the tests.
    """
    gc.collect()
    gc.freeze()
    gc.set_threshold(50_000)


@pytest.fixture(scope="session")
def evolved() -> np.ndarray:
    """Genotypes [60, 84] of evolved agents: random ones seldom touch anything."""
    with np.load(Path(__file__).with_name("evolved.npz"), allow_pickle=False) as stored:
        return stored["genotypes"]


@pytest.fixture(scope="session")
def evolved_plain() -> np.ndarray:
    """Genotypes [60, 84] that were evolved under the plain readings: for worlds that depart from these."""
    with np.load(Path(__file__).with_name("evolved-plain.npz"), allow_pickle=False) as stored:
        return stored["genotypes"]


@pytest.fixture(scope="session")
def evolved_agent(evolved) -> np.ndarray:
    """The best [84] of the With-Indicate run that got furthest."""
    return evolved[15]


@pytest.fixture(scope="session")
def git() -> str:
    """The program; who does not have it is told."""
    found = shutil.which("git")
    if found is None:
        pytest.skip("needs git: apt-get install git")
    return found


@pytest.fixture
def other_user() -> int:
    """The number of another user, to whom only root can give files."""
    if os.geteuid():
        pytest.skip("only root can give files to another user")
    return 65534
