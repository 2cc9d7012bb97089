"""Gaussian numbers with the same bits on every machine."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from arm2d.arithmetic import log, sin_cos
from arm2d.compiling import compiled


@compiled(allocates=False)
def fill_gaussian(
    radial: NDArray[np.float64], angular: NDArray[np.float64], out: NDArray[np.float64]
) -> None:
    """Standard normal numbers from pairs of uniform ones, by the cosine half of Box and Muller.

        out = sqrt(-2 ln(1 - radial)) cos(2 pi angular)

    NumPy's own `normal` asks the C library for logarithms, whose last bit differs between machines.

    Args:
        radial: [N], uniform in [0, 1).
        angular: [N], uniform in [0, 1), independent of `radial`.
        out: [N], to be filled.
    """
    for i in range(out.shape[0]):
        _, cosine = sin_cos(360.0 * angular[i])
        out[i] = math.sqrt(-2.0 * log(1.0 - radial[i])) * cosine


def draw_gaussian(n: int, rng: np.random.Generator) -> NDArray[np.float64]:
    """Independent standard normal numbers, [n]."""
    uniform = rng.random((2, n))
    out = np.empty(n)
    fill_gaussian(uniform[0], uniform[1], out)
    return out
