"""Every genotype of every generation again, from seeds and recorded fitness, without a trial.

Only five genotypes of each generation are kept in files. The run's algorithm is told the recorded fitness and
asks for the others again, bit by bit.
"""

from __future__ import annotations

import numpy as np

from evolution.runs.folder import RunFolder
from evolution.runs.history import History
from evolution.runs.recorded import recorded_histories
from evolution.search.algorithm import rank
from evolution.search.config import RunConfig
from evolution.search.population import Population, first_population, next_population
from evolution.search.settings import N_BEST


class ContradictionError(ValueError):
    """A history cannot have come from its run: its algorithm asks for other genotypes."""


def replay(population: Population, history: History, config: RunConfig) -> Population:
    """The population after the last generation of a history.

    Args:
        population: A generation of the history, from which to go on.
        history: Generations in a row.
        config: The run.

    Raises:
        ContradictionError: If parents or best genotypes are not those that the run breeds.
    """
    for row in range(population.generation - int(history.generations[0]), len(history)):
        best = population.genotypes[rank(history.fitness[row], config.readings)[:N_BEST]]
        if not (
            np.array_equal(population.parents, history.parents[row])
            and np.array_equal(best, history.best_genotypes[row])
        ):
            raise ContradictionError(f"generation {population.generation} is not bred from the one before")
        population = next_population(population, history.fitness[row], config)
    return population


def replay_part(folder: RunFolder, span: range, population: Population) -> Population:
    """The population after a part; raises `DamagedFileError` if the part is unsound in any way."""
    history = folder.read_part(span)
    try:
        return replay(population, history, folder.config)
    except ContradictionError as error:
        raise folder.damaged(span, str(error)) from None


def population_at(folder: RunFolder, generation: int) -> Population:
    """All genotypes of one generation of a run.

    Raises:
        ValueError: If the run has not come so far.
        DamagedFileError: If a part up to that generation is damaged.
    """
    population = first_population(folder.config)
    for history in recorded_histories(folder):
        if population.generation == generation:
            return population
        population = replay(population, history[: generation - population.generation], folder.config)
    if population.generation != generation:
        raise ValueError(
            f"{folder.path} has no generation {generation}; "
            f"its {population.generation} generations are numbered from 0"
        )
    return population
