"""What `benchmarks.device` has processes do: trials on a device, or on one core, for some seconds."""

from __future__ import annotations

import multiprocessing
import time
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from typing import Any

import numpy as np
from numpy.typing import NDArray

from arm2d import Condition, Readings, draw_trials, run_trials
from evolution.experiments.device.late_tests import laboratory_on
from evolution.search.algorithm import breed, choose_parents, initial_genotypes
from evolution.search.evaluation import TRIALS_PER_AREA
from evolution.search.settings import N_BEST, Settings

AGENTS_OF_A_PART = 500  # the five best of a hundred generations
PATIENCE = 300.0  # [s], until all processes have compiled

# Holds the processes until all of them are ready to be measured.
_ready: Any = None


def populations_on(device: str, generations: int) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """A random population [100, 84], and one evolved for some generations on a device."""
    laboratory = laboratory_on(device)
    from arm2d.device.groups import Group

    settings, readings, rng = Settings(), Readings(), np.random.default_rng(2)
    random = evolved = initial_genotypes(settings, rng)
    for _ in range(generations):
        trials = draw_trials(Condition.WITH_INDICATE.experienced, 2, readings, rng)
        (fitness,) = laboratory.fitness([Group(evolved, trials, readings)])
        evolved = breed(evolved, choose_parents(fitness, settings, readings, rng), settings, readings, rng)
    return random, evolved


def rate_of_all(processes: int, work: Callable[..., Any], *arguments: Any) -> float:
    """What so many processes do at once: the sum of the rates that `work` answers with."""
    context = multiprocessing.get_context("spawn")
    ready = context.Barrier(processes)
    with ProcessPoolExecutor(processes, mp_context=context, initializer=_wait_for, initargs=(ready,)) as pool:
        return sum(pool.map(work, *([each] * processes for each in arguments)))


def _wait_for(ready: Any) -> None:
    """Let this process wait for the others before it is measured."""
    global _ready
    _ready = ready


def generations_on_a_core(seconds: float, genotypes: NDArray[np.float64]) -> float:
    """Generations a second that the processor's kernel scores in this process, all else left out."""
    rng, readings = np.random.default_rng(1), Readings()
    trials = draw_trials(Condition.WITH_INDICATE.experienced, 2, readings, rng)
    return _rate(seconds, lambda: run_trials(genotypes, trials, readings))


def agents_on_a_core(seconds: float, genotypes: NDArray[np.float64]) -> float:
    """Agents a second that are post-evaluated in this process by the processor's kernel."""
    rng, readings, n = np.random.default_rng(1), Readings(), 5

    def test() -> None:
        for genotype in genotypes[:n]:
            run_trials(
                genotype, draw_trials(Condition.WITH_INDICATE.instructions, 40, readings, rng), readings
            )

    return n * _rate(seconds, test)


def agents_on_a_device(seconds: float, genotypes: NDArray[np.float64], device: str, n: int) -> float:
    """Agents a second that are post-evaluated by this process on a device, part after part of n agents.

    Trials are drawn and successes counted, as `evolution.experiments.device.late_tests` does.
    """
    laboratory = laboratory_on(device)
    from arm2d.device.groups import Group

    rng, readings = np.random.default_rng(1), Readings()
    generations = genotypes[np.arange(n) % len(genotypes)].reshape(-1, N_BEST, genotypes.shape[1])
    instructions = Condition.WITH_INDICATE.instructions * N_BEST

    def test() -> None:
        groups = [
            Group(best, draw_trials(instructions, TRIALS_PER_AREA, readings, rng), readings, each_own=True)
            for best in generations
        ]
        np.array(laboratory.success(groups)).reshape(n, 9, -1).sum(axis=-1)

    return n * _rate(seconds, test)


def _rate(seconds: float, work: Callable[[], Any]) -> float:
    """How often a second something is done, after a first time that compiles."""
    work()
    if _ready is not None:
        _ready.wait(PATIENCE)
    began, n = time.perf_counter(), 0
    while (spent := time.perf_counter() - began) < seconds:
        work()
        n += 1
    return n / spent if n else 1.0 / spent
