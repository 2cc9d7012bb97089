"""Where a run can go on: its next population, what its algorithm knows, and generations not yet in a part."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray

from evolution.runs.folder import CHECKPOINT, RunFolder
from evolution.runs.history import History, check_array, check_range, history_from_arrays
from evolution.runs.storage import DamagedFileError
from evolution.search.config import RunConfig
from evolution.search.population import Population, check_population

# Before the names of the arrays of the algorithm's state.
NEXT: Final = "next_"


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
    with folder.repairable(path):
        return _checked(folder, path, folder.read_arrays(path))


def _checked(folder: RunFolder, path: Path, arrays: Mapping[str, NDArray]) -> Checkpoint:
    """A checkpoint from its arrays; refused if they are not those of a checkpoint of the run."""
    settings = folder.config.settings
    n_genotypes = settings.population
    check_array(path, arrays, "generation", (), np.dtype(np.int64))
    check_array(path, arrays, "next_genotypes", (n_genotypes, settings.n_genes), np.dtype(np.float64))
    check_array(path, arrays, "next_parents", (n_genotypes,), np.dtype(np.int64))
    check_range(path, arrays, "generation", 0, settings.generations)
    check_range(path, arrays, "next_genotypes", 0.0, 1.0)
    check_range(path, arrays, "next_parents", -1, n_genotypes - 1)
    generation = int(arrays["generation"])
    population = _population(path, generation, arrays, folder.config)
    # Once the run is over, its last generation stands in a part, and nothing is unfinished.
    first = next((span.start for span in folder.spans if generation in span), generation)
    return Checkpoint(population, history_from_arrays(path, arrays, range(first, generation), folder.config))


def _population(path: Path, generation: int, arrays: Mapping[str, NDArray], config: RunConfig) -> Population:
    """The next population; refused if it is not one that the run's algorithm has asked for."""
    state = {name.removeprefix(NEXT): each for name, each in arrays.items() if name.startswith(NEXT)}
    population = Population(generation, state.pop("genotypes"), state.pop("parents"), state)
    try:
        check_population(population, config)
    except ValueError as error:
        raise DamagedFileError(path, str(error)) from None
    return population


def save_checkpoint(folder: RunFolder, checkpoint: Checkpoint) -> None:
    """Replace the checkpoint of a run."""
    population = checkpoint.population
    arrays = {
        "generation": np.array(population.generation),
        "next_genotypes": population.genotypes,
        "next_parents": population.parents,
        **{f"{NEXT}{name}": array for name, array in sorted(population.memory.items())},
        **checkpoint.unfinished.arrays(),
    }
    folder.write_arrays(folder.path / CHECKPOINT, arrays)
