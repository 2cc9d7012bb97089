"""The trials of a generation, and the fitness they give (section V; spec section 9)."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from arm2d import Instruction, Readings, Trials, check_genotypes, draw_trials, run_trials
from arm2d.tasks.task import AnyTask, task_of
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
    # Few objects, again and again for each genotype: told apart as objects, they need not be compared.
    for instruction in {id(each): each for each in instructions}.values():
        if instruction not in experienced:
            raise ValueError(
                f"non-experienced instruction {instruction.action.name} {instruction.object.name} "
                "was drawn for evolution; this would spoil the result"
            )
    return draw_trials(instructions, per_area, readings, rng, condition)


def score_population(population: Population, config: RunConfig) -> NDArray[np.float64]:
    """Fitness of each genotype: the mean of F1 + F2 + F3 over the generation's trials, [P].

    All genotypes meet the same trials, or each its own (reading `starts_shared`).

    Raises:
        ValueError: If an algorithm has asked for networks of another size than the run's.
    """
    check_genotypes(population.genotypes, config.settings.inter_neurons)
    trials, each_own = trials_of(config, population.generation, len(population.genotypes))
    scores = run_trials(population.genotypes, trials, config.readings, each_own=each_own)
    return mean_in_order(scores.fitness)


def first_genotypes_trials(config: RunConfig, generation: int) -> Trials:
    """The trials in which the first genotype of a generation was scored."""
    if task_of(config.condition).places != "dealt" or config.readings.starts_shared != "genotype":
        return trials_of(config, generation)[0]
    # Dealt at once, the colours of its trials depend on how many genotypes there are.
    trials, _ = trials_of(config, generation, config.settings.population)
    return trials[: len(trials) // config.settings.population]


def trials_of(config: RunConfig, generation: int, n_genotypes: int = 1) -> tuple[Trials, bool]:
    """Fresh trials of a generation, and whether each genotype has its own.

    If so, they are those of the first `n_genotypes`, one after the other's.
    """
    rng = generator(config.seed, Purpose.TRIALS, generation)
    condition, per_area = config.condition, config.settings.trials_per_area
    each_own = config.readings.starts_shared == "genotype"
    # Drawn at once: the numbers that drawing for one after the other gives, unless places are dealt.
    instructions = condition.experienced * (n_genotypes if each_own else 1)
    return draw_evolution_trials(instructions, condition, per_area, config.readings, rng), each_own
