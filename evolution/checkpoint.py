"""Where a run can go on: its next population, and the generations not yet in a part."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from arm2d.constants import N_GENES
from evolution.folder import CHECKPOINT, RunFolder
from evolution.history import History, check_array, history_from_arrays
from evolution.population import Population


@dataclass(frozen=True)
class Checkpoint:
    """Where a run can go on.

    Attributes:
        population: The next generation to be scored.
        unfinished: The generations scored since the last part was written.
    """

    population: Population
    unfinished: History

    @property
    def first(self) -> int:
        """The generation after the last part: the first of the unfinished ones."""
        return self.population.generation - len(self.unfinished)


def load_checkpoint(folder: RunFolder) -> Checkpoint | None:
    """The checkpoint of a run, if there is one.

    Raises:
        DamagedFileError: If it is not what was written.
    """
    path = folder.path / CHECKPOINT
    if not path.exists():
        return None
    arrays = folder.read_arrays(path)
    n_genotypes = folder.config.settings.population
    check_array(path, arrays, "generation", (), np.dtype(np.int64))
    check_array(path, arrays, "next_genotypes", (n_genotypes, N_GENES), np.dtype(np.float64))
    check_array(path, arrays, "next_parents", (n_genotypes,), np.dtype(np.int64))
    generation = int(arrays["generation"])
    population = Population(generation, arrays["next_genotypes"], arrays["next_parents"])
    # Once the run is over, its last generation stands in a part, and nothing is unfinished.
    first = next((span.start for span in folder.spans if generation in span), generation)
    return Checkpoint(population, history_from_arrays(path, arrays, range(first, generation), n_genotypes))


def save_checkpoint(folder: RunFolder, checkpoint: Checkpoint) -> None:
    """Replace the checkpoint of a run."""
    arrays = {
        "generation": np.array(checkpoint.population.generation),
        "next_genotypes": checkpoint.population.genotypes,
        "next_parents": checkpoint.population.parents,
        **checkpoint.unfinished.arrays(),
    }
    folder.write_arrays(folder.path / CHECKPOINT, arrays)
