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
from evolution.search.scoring import score_population, trials_of

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
    """Fitness [P] of each population, those that meet as many trials in one batch.

    Raises:
        DeviceMemoryError: If the device has too little memory even for one population.
        DeviceLostError: If it does not answer.
    """
    groups = [_group_of(*each) for each in zip(populations, configs, strict=True)]
    fitness: list[NDArray[np.float64]] = [np.empty(0)] * len(groups)
    alike: dict[int, list[int]] = {}
    for run, group in enumerate(groups):
        alike.setdefault(group.n_trials, []).append(run)
    for runs in alike.values():
        for run, scored in zip(runs, laboratory.fitness([groups[run] for run in runs]), strict=True):
            fitness[run] = scored
    return fitness


def _group_of(population: Population, config: RunConfig) -> Group:
    """A population with its trials: the same for all, or for each its own (reading `starts_shared`)."""
    from arm2d.device.groups import Group

    trials, each_own = trials_of(config, population.generation, len(population.genotypes))
    return Group(population.genotypes, trials, config.readings, each_own)
