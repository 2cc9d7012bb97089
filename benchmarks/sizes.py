"""CPU time of one generation for networks of other sizes than the paper's, beside three inter-neurons.

    python -m benchmarks.sizes

A generation is that of `benchmarks.kernel`: 100 random genotypes x 28 trials x at most 250 steps. All sizes
take turns in one process bound to one core, so that a busy machine slows all of them alike; medians are
printed. The first call compiles the kernel for a size, or reads it where it has been compiled before.
"""

from __future__ import annotations

import time
from functools import partial
from statistics import median
from typing import Final

import numpy as np
from rich.console import Console
from rich.table import Table

from arm2d import Condition, Readings, draw_trials, run_trials
from arm2d.constants import N_INTER
from arm2d.network.genes import genes_of
from benchmarks.kernel import bind_to_one_core
from evolution.search.algorithm import initial_genotypes
from evolution.search.settings import Settings

SIZES: Final = (1, 2, 3, 5, 8, 12, 16)
ROUNDS: Final = 15


def main() -> None:
    """Print a table."""
    bind_to_one_core()
    readings = Readings()
    trials = draw_trials(Condition.WITH_INDICATE.experienced, 2, readings, np.random.default_rng(3))
    runs, firsts = {}, {}
    for size in SIZES:
        genotypes = initial_genotypes(Settings(inter_neurons=size), np.random.default_rng(2))
        runs[size] = partial(run_trials, genotypes, trials, readings)
        start = time.process_time()
        runs[size]()
        firsts[size] = time.process_time() - start
    times: dict[int, list[float]] = {size: [] for size in SIZES}
    for _ in range(ROUNDS):
        for size, run in runs.items():
            start = time.process_time()
            run()
            times[size].append(1e3 * (time.process_time() - start))
    table = Table("inter-neurons", "genes", "CPU [ms]", "times three", "first call, CPU [s]")
    three = median(times[N_INTER])
    for size in SIZES:
        own = median(times[size])
        cells = (genes_of(size).count, f"{own:.1f}", f"{own / three:.2f}", f"{firsts[size]:.1f}")
        table.add_row(str(size), *map(str, cells))
    Console().print(table)


if __name__ == "__main__":
    main()
