"""Every draw of the project comes from a generator derived from (seed, purpose, generation).

No generator is ever carried from one generation to the next: a resumed run, or a single generation
computed alone, draws the same numbers as an undisturbed run. Gaussian numbers have the same bits on every
machine.
"""

from __future__ import annotations

import math
from enum import IntEnum

import numpy as np
from numpy.typing import NDArray

from arm2d.arithmetic import log, sin_cos
from arm2d.compiling import compiled


class Purpose(IntEnum):
    """What numbers are drawn for. A member's number is part of every seed: never change one."""

    INITIAL_GENOTYPES = 0
    TRIALS = 1
    PARENTS = 2
    MUTATION = 3
    CHAMPION = 4
    EVALUATION = 5
    RECORDING = 6
    POST_EVALUATION = 7
    TRANSITIONS = 8
    BEHAVIOUR = 9
    STATISTICS = 10
    CROSSOVER = 11
    CMA_ES = 12
    CMA_ES_MEAN = 13


def generator(seed: int, purpose: Purpose, generation: int = 0) -> np.random.Generator:
    """The generator of one purpose in one generation of the run with this seed.

    For parents, crossover and mutations, the generation is that of the children.
    """
    if seed < 0:
        raise ValueError(f"a seed of {seed} was asked for; give 0 or more")
    sequence = np.random.SeedSequence(seed, spawn_key=(purpose, generation))
    return np.random.Generator(np.random.PCG64(sequence))


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
