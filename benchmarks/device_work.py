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
from evolution.search.evaluation import TRIALS_PER_AREA

AGENTS_OF_A_PART = 500  # the five best of a hundred generations
PATIENCE = 300.0  # [s], until all processes have compiled

# Holds the processes until all of them are ready to be measured.
_ready: Any = None


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
    agents = genotypes[np.arange(n) % len(genotypes)]

    def test() -> None:
        groups = [
            Group(
                each[np.newaxis],
                draw_trials(Condition.WITH_INDICATE.instructions, TRIALS_PER_AREA, readings, rng),
                readings,
            )
            for each in agents
        ]
        laboratory.success(groups).reshape(n, 9, -1).sum(axis=-1)

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
