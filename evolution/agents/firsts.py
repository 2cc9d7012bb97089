"""When something first happened."""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray

# What stands for a row or a generation where nothing happened in any.
NEVER: Final = -1


def first_row(happened: NDArray[np.bool_]) -> int:
    """The first row of [K] in which it did, or `NEVER`."""
    return int(first_rows(happened))


def first_rows(happened: NDArray[np.bool_]) -> NDArray[np.int64]:
    """The same of every column of [K, C], [C]."""
    return np.where(happened.any(axis=0), happened.argmax(axis=0), NEVER)
