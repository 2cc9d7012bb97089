"""Generations of many runs scored as one batch on a device, with the bits of `score_population`."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from arm2d import Readings, Trials, TrialScores, run_trials
from arm2d.device.errors import DeviceLostError, DeviceMemoryError
from evolution.search.config import RunConfig
from evolution.search.population import Population
from evolution.search.randomness import Purpose, generator
from evolution.search.scoring import draw_evolution_trials, score_population

if TYPE_CHECKING:
    from arm2d.device.groups import Group, Laboratory


class DeviceScoring:
    """Scores on a device, and on the processor once that fails: the bits are the same.

    So runs whose device fails in mid-generation can still be left in good order.

    Attributes:
        laboratory: The device.
        failure: Why it is not asked any more; None while it works.
    """

    def __init__(self, laboratory: Laboratory) -> None:
        self.laboratory = laboratory
        self.failure: DeviceLostError | DeviceMemoryError | None = None

    def fitness(
        self, populations: Sequence[Population], configs: Sequence[RunConfig]
    ) -> list[NDArray[np.float64]]:
        """Fitness [P] of each run's population, whatever generation it is."""
        if self.failure is None:
            try:
                return score_together(populations, configs, self.laboratory)
            except (DeviceLostError, DeviceMemoryError) as error:
                self.failure = error
        return [score_population(*each) for each in zip(populations, configs, strict=True)]

    def run_trials(self, genotypes: ArrayLike, trials: Trials, readings: Readings) -> TrialScores:
        """As `arm2d.run_trials`."""
        if self.failure is None:
            try:
                return self.laboratory.run_trials(np.asarray(genotypes), trials, readings)
            except (DeviceLostError, DeviceMemoryError) as error:
                self.failure = error
        return run_trials(genotypes, trials, readings)


def score_together(
    populations: Sequence[Population], configs: Sequence[RunConfig], laboratory: Laboratory
) -> list[NDArray[np.float64]]:
    """Fitness [P] of each population, runs with groups of one size in one batch.

    Raises:
        DeviceMemoryError: If the device has too little memory even for one population.
        DeviceLostError: If it does not answer.
    """
    groups = [_groups_of(*each) for each in zip(populations, configs, strict=True)]
    fitness: list[NDArray[np.float64]] = [np.empty(0)] * len(groups)
    by_size: dict[tuple[int, int], list[int]] = {}
    for run, of_run in enumerate(groups):
        by_size.setdefault((len(of_run[0].genotypes), len(of_run[0].trials)), []).append(run)
    for runs in by_size.values():
        scored = laboratory.fitness([group for run in runs for group in groups[run]])
        ends = np.cumsum([len(groups[run]) for run in runs])
        for run, of_run in zip(runs, np.split(scored, ends[:-1]), strict=True):
            fitness[run] = of_run.reshape(-1)
    return fitness


def _groups_of(population: Population, config: RunConfig) -> list[Group]:
    """One group where all genotypes meet the same trials, else one for each (reading `starts_shared`)."""
    from arm2d.device.groups import Group

    rng = generator(config.seed, Purpose.TRIALS, population.generation)
    parts = [population.genotypes]
    if config.readings.starts_shared == "genotype":
        parts = [genotype[np.newaxis] for genotype in population.genotypes]
    condition, per_area = config.condition, config.settings.trials_per_area
    return [
        Group(
            genotypes,
            draw_evolution_trials(condition.experienced, condition, per_area, config.readings, rng),
            config.readings,
        )
        for genotypes in parts
    ]
