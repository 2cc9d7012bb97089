"""Many runs that advance together, so that their generations can be scored in one go.

Every run is the one of `evolution.runs.run`, with its own folder, lock, parts and checkpoints; only
who scores its generations differs. Runs that were left at different generations advance side by side
all the same.
"""

from __future__ import annotations

from collections.abc import Callable, Generator, Mapping, Sequence
from contextlib import ExitStack, closing
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from evolution.runs.run import Watcher, evolving
from evolution.search.config import RunConfig
from evolution.search.population import Population

# Fitness [P] of each of some populations of as many runs.
Score = Callable[[Sequence[Population], Sequence[RunConfig]], list[NDArray[np.float64]]]


@dataclass(frozen=True)
class BatchResult:
    """What became of the runs of a batch.

    Attributes:
        generations: Scored, of each run that was not given up.
        troubles: A sentence for each run that was.
    """

    generations: dict[Path, int] = field(default_factory=dict)
    troubles: dict[Path, str] = field(default_factory=dict)


def evolve_together(
    runs: Mapping[Path, RunConfig], score: Score, watcher: Watcher | None = None
) -> BatchResult:
    """Start runs, or go on with them, until their last generations or until stopped.

    A run that cannot be gone on with, such as one with a damaged part, does not hold up the others.

    Args:
        runs: By folder.
        score: Scores a generation of all runs that are still at work.
        watcher: Is told of the progress of all runs, and may stop them.
    """
    watcher, result = watcher or Watcher(), BatchResult()
    shared = replace(watcher, cpu_seconds=lambda: watcher.cpu_seconds() / len(runs))
    with ExitStack() as stack:
        at_work: dict[Path, Generator[Population, NDArray[np.float64], int]] = {}
        populations: dict[Path, Population] = {}

        def advance(path: Path, fitness: NDArray[np.float64] | None) -> None:
            """Let a run take its fitness, if it has a population to be scored, and go on to the next one."""
            try:
                populations[path] = next(at_work[path]) if fitness is None else at_work[path].send(fitness)
                return
            except StopIteration as end:
                result.generations[path] = end.value
            except (ValueError, OSError) as error:
                result.troubles[path] = str(error)
            del at_work[path]
            populations.pop(path, None)

        for path, config in runs.items():
            at_work[path] = stack.enter_context(closing(evolving(path, config, shared)))
            advance(path, None)
        while at_work:
            paths = list(at_work)
            scored = score([populations[path] for path in paths], [runs[path] for path in paths])
            for path, fitness in zip(paths, scored, strict=True):
                advance(path, fitness)
    return result
