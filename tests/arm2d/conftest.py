"""What the tests of the planar world share."""

from pathlib import Path

import numpy as np
import pytest


@pytest.fixture(scope="session")
def evolved() -> np.ndarray:
    """Genotypes [60, 84] of evolved agents: random ones seldom touch anything."""
    with np.load(Path(__file__).with_name("evolved.npz")) as stored:
        return stored["genotypes"]
