"""A generation before it is scored, and the one after it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from arm2d.records import brief
from evolution.search.algorithm import breed, choose_crossings, choose_parents, initial_genotypes
from evolution.search.config import RunConfig
from evolution.search.randomness import Purpose, generator


@dataclass(frozen=True)
class Population:
    """The genotypes of one generation.

    Attributes:
        generation: Its number, from 0.
        genotypes: [P, 84].
        parents: [P], each genotype's parent as an index into the generation before, where there are two
            (reading `crossover`) the first, whose genes stand before the cut; -1 in generation 0.
    """

    generation: int
    genotypes: NDArray[np.float64]
    parents: NDArray[np.int64]

    __repr__ = brief

    def __post_init__(self) -> None:
        self.genotypes.flags.writeable = False
        self.parents.flags.writeable = False


def first_population(config: RunConfig) -> Population:
    """Generation 0 of a run: random genotypes."""
    genotypes = initial_genotypes(config.settings, generator(config.seed, Purpose.INITIAL_GENOTYPES))
    return Population(0, genotypes, np.full(len(genotypes), -1))


def next_population(population: Population, fitness: NDArray[np.float64], config: RunConfig) -> Population:
    """The generation that follows when this one has scored `fitness`, [P].

    Seeds and fitness are all it needs: any generation can be bred again, bit by bit, without a trial.
    """
    generation = population.generation + 1
    settings, readings = config.settings, config.readings
    draw_parents = generator(config.seed, Purpose.PARENTS, generation)
    draw_mutations = generator(config.seed, Purpose.MUTATION, generation)
    parents = choose_parents(fitness, settings, readings, draw_parents)
    crossings = None
    if readings.crossover > 0.0:
        draw_crossings = generator(config.seed, Purpose.CROSSOVER, generation)
        crossings = choose_crossings(fitness, settings, readings, draw_crossings)
    genotypes = breed(population.genotypes, parents, settings, readings, draw_mutations, crossings)
    return Population(generation, genotypes, parents)
