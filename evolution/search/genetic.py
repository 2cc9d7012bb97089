"""The paper's genetic algorithm as one that asks and is told (section V; spec section 9).

Its steps are the pure functions of `evolution.search.algorithm`; its state is the generation itself.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from evolution.search.algorithm import breed, choose_crossings, choose_parents, initial_genotypes
from evolution.search.ask_tell import State
from evolution.search.config import RunConfig
from evolution.search.randomness import Purpose, generator
from evolution.search.settings import GENETIC


class GeneticAlgorithm:
    """Rank, keep the elites, choose parents, cross, mutate; raises `ValueError` at a state of another one."""

    def __init__(self, config: RunConfig, generation: int = 0, state: State | None = None) -> None:
        self._config, self.generation = config, generation
        if state is None:
            draws = generator(config.seed, Purpose.INITIAL_GENOTYPES)
            genotypes = initial_genotypes(config.settings, draws)
            state = {"genotypes": genotypes, "parents": np.full(len(genotypes), -1)}
        if state.keys() != {"genotypes", "parents"}:
            raise ValueError(
                f"this is no state of the algorithm {GENETIC}: it holds {', '.join(state)}, "
                "not genotypes, parents"
            )
        self._genotypes, self._parents = state["genotypes"], state["parents"]

    def ask(self) -> NDArray[np.float64]:
        """The generation, [P, G]: random genotypes; later the elites, then the children."""
        return self._genotypes

    def tell(self, fitness: NDArray[np.float64]) -> None:
        """Breed the next generation."""
        self.generation += 1
        seed, settings, readings = self._config.seed, self._config.settings, self._config.readings
        draw_parents = generator(seed, Purpose.PARENTS, self.generation)
        draw_mutations = generator(seed, Purpose.MUTATION, self.generation)
        self._parents = choose_parents(fitness, settings, readings, draw_parents)
        crossings = None
        if readings.crossover > 0.0:
            draw_crossings = generator(seed, Purpose.CROSSOVER, self.generation)
            crossings = choose_crossings(fitness, settings, readings, draw_crossings)
        self._genotypes = breed(self._genotypes, self._parents, settings, readings, draw_mutations, crossings)

    def state(self) -> dict[str, NDArray]:
        """The generation: `genotypes` [P, G] and `parents` [P]."""
        return {"genotypes": self._genotypes, "parents": self._parents}
