"""Every draw of the project comes from a generator derived from (seed, purpose, generation).

No generator is ever carried from one generation to the next: a resumed run, or a single generation
computed alone, draws the same numbers as an undisturbed run.
"""

from __future__ import annotations

from enum import IntEnum

import numpy as np


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


def generator(seed: int, purpose: Purpose, generation: int = 0) -> np.random.Generator:
    """The generator of one purpose in one generation of the run with this seed.

    For parents, crossover and mutations, the generation is that of the children.
    """
    sequence = np.random.SeedSequence(seed, spawn_key=(purpose, generation))
    return np.random.Generator(np.random.PCG64(sequence))
