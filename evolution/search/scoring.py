"""The trials of a generation, and the fitness they give (section V; spec section 9)."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from arm2d import Instruction, Readings, Trials, draw_trials, run_trials
from arm2d.tasks.task import AnyTask
from evolution.search.algorithm import mean_in_order
from evolution.search.config import RunConfig
from evolution.search.population import Population
from evolution.search.randomness import Purpose, generator


def draw_evolution_trials(
    instructions: Sequence[Instruction],
    condition: AnyTask,
    per_area: int,
    readings: Readings,
    rng: np.random.Generator,
) -> Trials:
    """Trials for evolution: as `arm2d.draw_trials`, but of experienced instructions only.

    Raises:
        ValueError: If an instruction is not among those the condition lets agents experience.
    """
    experienced = condition.experienced
    for instruction in dict.fromkeys(instructions):
        if instruction not in experienced:
            raise ValueError(
                f"non-experienced instruction {instruction.action.name} {instruction.object.name} "
                "was drawn for evolution; this would spoil the result"
            )
    return draw_trials(instructions, per_area, readings, rng, condition)


def score_population(population: Population, config: RunConfig) -> NDArray[np.float64]:
    """Fitness of each genotype: the mean of F1 + F2 + F3 over the generation's trials, [P].

    All genotypes meet the same trials, or each its own (reading `starts_shared`).
    """
    rng = generator(config.seed, Purpose.TRIALS, population.generation)
    if config.readings.starts_shared == "genotype":
        scores = [_score(genotype[np.newaxis], config, rng) for genotype in population.genotypes]
        return np.concatenate(scores)
    return _score(population.genotypes, config, rng)


def _score(
    genotypes: NDArray[np.float64], config: RunConfig, rng: np.random.Generator
) -> NDArray[np.float64]:
    """Fitness [P] of genotypes that meet the same fresh trials."""
    condition, readings = config.condition, config.readings
    trials = draw_evolution_trials(
        condition.experienced, condition, config.settings.trials_per_area, readings, rng
    )
    return mean_in_order(run_trials(genotypes, trials, readings).fitness)
