"""A generation before it is scored, and the one after it, whatever algorithm asks for them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from arm2d.records import alike, brief
from evolution.search.ask_tell import Algorithm, begin, is_known, maker_of
from evolution.search.config import RunConfig
from evolution.search.handover import handed_over


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
    __eq__ = alike

    def __post_init__(self) -> None:
        for array in (self.genotypes, self.parents, *self.memory.values()):
            array.flags.writeable = False


def first_population(config: RunConfig) -> Population:
    """Generation 0 of a run.

    Raises:
        ValueError: If its algorithm is not known, or asks for what no run can take.
    """
    return Population(0, *handed_over(begin(config), config, 0))


def next_population(population: Population, fitness: NDArray[np.float64], config: RunConfig) -> Population:
    """The generation that follows when this one has scored `fitness`, [P].

    Seeds and fitness are all it needs: any generation can be asked for again, bit by bit, without a trial.

    Raises:
        ValueError: If the algorithm does not go on by one generation, or asks for what no run can take.
    """
    algorithm = algorithm_at(population, config)
    algorithm.tell(fitness.copy())  # what it does to its copy does not reach the record
    due = population.generation + 1
    return Population(due, *handed_over(algorithm, config, due))


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
