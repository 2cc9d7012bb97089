"""What the tests of several packages share."""

import os
from pathlib import Path

import numpy as np
import pytest
from hypothesis import settings

# The same examples every time, and no deadline: a busy machine is no fault.
settings.register_profile("wordarm", derandomize=True, deadline=None)
settings.load_profile("wordarm")


@pytest.fixture(scope="session")
def evolved() -> np.ndarray:
    """Genotypes [60, 84] of evolved agents: random ones seldom touch anything."""
    with np.load(Path(__file__).with_name("evolved.npz"), allow_pickle=False) as stored:
        return stored["genotypes"]


@pytest.fixture(scope="session")
def evolved_agent(evolved) -> np.ndarray:
    """The best [84] of the With-Indicate run that got furthest."""
    return evolved[15]


@pytest.fixture
def other_user() -> int:
    """The number of another user, to whom only root can give files."""
    if os.geteuid():
        pytest.skip("only root can give files to another user")
    return 65534
