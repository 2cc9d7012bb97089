"""CPU time of one generation of the paper: 100 genotypes x 28 trials x at most 250 steps.

    python -m benchmarks.kernel

Kernel, numpy peers and, where jax is installed, a JAX peer take the same trials in turn, in one process
bound to one core, so that a busy machine slows all of them alike. CPU time is that of all threads
together. Medians are printed, and beside them the first call, in which JAX compiles (the kernel has run
before: it evolves the second population).
"""

from __future__ import annotations

import importlib.util
import os
import platform
import sys
import time
from collections.abc import Callable
from statistics import median
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from rich.console import Console
from rich.table import Table

from arm2d import Condition, Readings, Trials, TrialScores, draw_trials, run_trials
from arm2d.readings import PLAIN
from benchmarks import numpy_peer
from evolution.search.algorithm import breed, choose_parents, initial_genotypes, mean_in_order
from evolution.search.settings import Settings

GENERATIONS_OF_EVOLVED = 1500
ROUNDS = 15


class Times(NamedTuple):
    """CPU time of one generation [ms]: the first call, and the median of later ones."""

    first: float
    median: float


def populations(
    readings: Readings, generations: int = GENERATIONS_OF_EVOLVED
) -> dict[str, NDArray[np.float64]]:
    """A random population [100, 84] and one evolved for a while."""
    settings, rng = Settings(), np.random.default_rng(2)
    random = evolved = initial_genotypes(settings, rng)
    for _ in range(generations):
        trials = draw_trials(Condition.WITH_INDICATE.experienced, 2, readings, rng)
        fitness = mean_in_order(run_trials(evolved, trials, readings).fitness)
        evolved = breed(evolved, choose_parents(fitness, settings, readings, rng), settings, readings, rng)
    return {"random": random, f"evolved for {generations} generations": evolved}


def contenders(
    genotypes: NDArray, trials: Trials, readings: Readings
) -> dict[str, Callable[[], TrialScores]]:
    """What is compared, by name."""
    runs = {
        "kernel": lambda: run_trials(genotypes, trials, readings),
        "numpy, all trials alike": lambda: numpy_peer.run_trials(genotypes, trials, readings),
        "numpy, contact where it may be": lambda: numpy_peer.run_trials(
            genotypes, trials, readings, sparse=True
        ),
    }
    if importlib.util.find_spec("jax"):
        from benchmarks import jax_peer

        runs["JAX, all trials alike"] = jax_peer.prepare(genotypes, trials, readings)
    return runs


def measure(runs: dict[str, Callable[[], TrialScores]]) -> dict[str, Times]:
    """CPU times of each, taken in turn; the kernel runs more often than the others."""
    firsts = {name: _milliseconds(run) for name, run in runs.items()}
    times: dict[str, list[float]] = {name: [] for name in runs}
    for _ in range(3):
        for name, run in runs.items():
            times[name] += [_milliseconds(run) for _ in range(ROUNDS if name == "kernel" else 1)]
    return {name: Times(firsts[name], median(each)) for name, each in times.items()}


def _milliseconds(run: Callable[[], TrialScores]) -> float:
    start = time.process_time()
    run()
    return 1e3 * (time.process_time() - start)


def bind_to_one_core() -> None:
    """Let this process, and the threads it starts from now on, use one core only, where that can be asked."""
    if hasattr(os, "sched_setaffinity"):
        os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})


def main() -> None:
    """Print a table."""
    bind_to_one_core()
    readings, console = PLAIN, Console(width=None if sys.stdout.isatty() else 110)
    table = Table(title=f"one generation on {platform.processor() or platform.machine()}, one core")
    for heading in (
        "population",
        "implementation",
        "CPU [ms]",
        "times the kernel",
        "first call [ms]",
        "trials alike",
    ):
        table.add_column(heading, justify="left" if heading in ("population", "implementation") else "right")
    for name, genotypes in populations(readings).items():
        trials = draw_trials(Condition.WITH_INDICATE.experienced, 2, readings, np.random.default_rng(3))
        runs = contenders(genotypes, trials, readings)
        times = measure(runs)
        expected = runs["kernel"]()
        for contender, (first, typical) in times.items():
            ratio = typical / times["kernel"].median
            cells = (
                f"{typical:.1f}",
                f"{ratio:.1f}",
                f"{first:.0f}",
                f"{100 * alike(runs[contender](), expected):.2f} %",
            )
            table.add_row(name, contender, *cells)
    console.print(table)


def alike(scores: TrialScores, expected: TrialScores) -> float:
    """Share of trials with the same steps and success, and F1 + F2 + F3 within 1e-9."""
    near = np.isclose(scores.fitness, expected.fitness, rtol=0, atol=1e-9)
    return float(np.mean(near & (scores.success == expected.success) & (scores.steps == expected.steps)))


if __name__ == "__main__":
    main()
