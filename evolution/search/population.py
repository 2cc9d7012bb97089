"""A generation before it is scored, and the one after it, whatever algorithm asks for them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from arm2d.records import brief
from evolution.search.ask_tell import Algorithm, begin, is_known, maker_of
from evolution.search.config import RunConfig


@dataclass(frozen=True)
class Population:
    """The genotypes of one generation, and what the algorithm that asked for them has learnt so far.

    Attributes:
        generation: Its number, from 0.
        genotypes: [P, G].
        parents: [P], each genotype's parent as an index into the generation before, where there are two
            (reading `crossover`) the first, whose genes stand before the cut; -1 where there is none.
        memory: The other arrays of the algorithm's state, by name; the genetic algorithm has none.
    """

    generation: int
    genotypes: NDArray[np.float64]
    parents: NDArray[np.int64]
    memory: Mapping[str, NDArray] = field(default_factory=dict)

    __repr__ = brief

    def __post_init__(self) -> None:
        for array in (self.genotypes, self.parents, *self.memory.values()):
            array.flags.writeable = False


def first_population(config: RunConfig) -> Population:
    """Generation 0 of a run."""
    return _asked_for(begin(config))


def next_population(population: Population, fitness: NDArray[np.float64], config: RunConfig) -> Population:
    """The generation that follows when this one has scored `fitness`, [P].

    Seeds and fitness are all it needs: any generation can be asked for again, bit by bit, without a trial.
    """
    algorithm = algorithm_at(population, config)
    algorithm.tell(fitness)
    return _asked_for(algorithm)


def algorithm_at(population: Population, config: RunConfig) -> Algorithm:
    """The algorithm of a run when it has asked for a population.

    Raises:
        ValueError: If the population is another algorithm's.
    """
    state = {"genotypes": population.genotypes, "parents": population.parents, **population.memory}
    return maker_of(config)(config, population.generation, state)


def check_population(population: Population, config: RunConfig) -> None:
    """Refuse a population of another algorithm than the run's, if that is known here; raises `ValueError`."""
    if is_known(config):
        algorithm_at(population, config)


def _asked_for(algorithm: Algorithm) -> Population:
    state = algorithm.state()
    return Population(algorithm.generation, state.pop("genotypes"), state.pop("parents"), state)
