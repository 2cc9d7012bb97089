"""CPU time of one generation of the paper: 100 genotypes x 28 trials x at most 250 steps.

    python -m benchmarks.kernel

Kernel and numpy peers take the same trials in turn, in one process, so that a busy machine slows all of
them alike; medians are printed. CPU time is that of all threads together; the kernel uses one.
"""

from __future__ import annotations

import platform
import time
from collections.abc import Callable
from statistics import median

import numpy as np
from numpy.typing import NDArray
from rich.console import Console
from rich.table import Table

from arm2d import Condition, Readings, Trials, TrialScores, draw_trials, run_trials
from benchmarks import numpy_peer
from evolution.algorithm import breed, choose_parents, initial_genotypes, mean_in_order
from evolution.settings import Settings

GENERATIONS_OF_EVOLVED = 1500
ROUNDS = 15


def populations(readings: Readings) -> dict[str, NDArray[np.float64]]:
    """A random population [100, 84] and one evolved for a while."""
    settings, rng = Settings(), np.random.default_rng(2)
    random = evolved = initial_genotypes(settings, rng)
    for _ in range(GENERATIONS_OF_EVOLVED):
        trials = draw_trials(Condition.WITH_INDICATE.experienced, 2, readings, rng)
        fitness = mean_in_order(run_trials(evolved, trials, readings).fitness)
        evolved = breed(evolved, choose_parents(fitness, settings, readings, rng), settings, readings, rng)
    return {"random": random, f"evolved for {GENERATIONS_OF_EVOLVED} generations": evolved}


def contenders(
    genotypes: NDArray, trials: Trials, readings: Readings
) -> dict[str, Callable[[], TrialScores]]:
    """What is compared, by name."""
    return {
        "kernel": lambda: run_trials(genotypes, trials, readings),
        "numpy, all trials alike": lambda: numpy_peer.run_trials(genotypes, trials, readings),
        "numpy, contact where it may be": lambda: numpy_peer.run_trials(
            genotypes, trials, readings, sparse=True
        ),
    }


def measure(runs: dict[str, Callable[[], TrialScores]]) -> dict[str, float]:
    """Median CPU time of each in [ms], taken in turn; the kernel runs ten times as often."""
    times: dict[str, list[float]] = {name: [] for name in runs}
    for name, run in runs.items():
        for _ in range(ROUNDS if name == "kernel" else 1):
            run()  # compiled and warm
    for _ in range(3):
        for name, run in runs.items():
            for _ in range(ROUNDS if name == "kernel" else 1):
                start = time.process_time()
                run()
                times[name].append(1e3 * (time.process_time() - start))
    return {name: median(each) for name, each in times.items()}


def main() -> None:
    """Print a table."""
    readings, console = Readings(), Console()
    table = Table(title=f"one generation on {platform.processor() or platform.machine()}, one thread")
    for heading in ("population", "implementation", "CPU [ms]", "times the kernel", "trials alike"):
        table.add_column(heading, justify="right" if heading[0] in "Ct" else "left")
    for name, genotypes in populations(readings).items():
        trials = draw_trials(Condition.WITH_INDICATE.experienced, 2, readings, np.random.default_rng(3))
        runs = contenders(genotypes, trials, readings)
        expected = run_trials(genotypes, trials, readings)
        medians = measure(runs)
        for contender, milliseconds in medians.items():
            alike = np.mean(np.isclose(runs[contender]().fitness, expected.fitness, rtol=0, atol=1e-9))
            ratio = milliseconds / medians["kernel"]
            table.add_row(name, contender, f"{milliseconds:.1f}", f"{ratio:.1f}", f"{100 * alike:.2f} %")
    console.print(table)


if __name__ == "__main__":
    main()
