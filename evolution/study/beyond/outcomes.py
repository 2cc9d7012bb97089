"""What a run comes to: one number for each question, its mean over runs and the difference of two means.

As declared in docs/beyond.md. Axes: R runs.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from arm2d import Instruction
from evolution.results.statistics import (
    bootstrap_interval,
    difference_of_means,
    mean_interval,
    proportion_interval,
    proportions_interval,
)
from evolution.search.randomness import Purpose, generator
from evolution.study.beyond.rows import CellRun
from evolution.study.declared.regression import Estimate

Words = Sequence[Instruction]


@dataclass(frozen=True)
class Outcome:
    """One number for each run, of which more is better.

    Attributes:
        name: In files.
        title: In the picture.
        value: From a run, and the held-out instructions that are asked for.
        counts_runs: Whether it is 0 or 1, so that its mean is a share of runs.
    """

    name: str
    title: str
    value: Callable[[CellRun, Words], float]
    counts_runs: bool = False

    def values(self, runs: Iterable[CellRun], words: Words) -> NDArray[np.float64]:
        """Of these runs, [R]."""
        return np.array([self.value(run, words) for run in runs], float)

    def estimate(self, runs: Sequence[CellRun], words: Words) -> Estimate:
        """The mean over runs with its 95 % interval: Wilson's of a share of runs, else a bootstrap."""
        values = self.values(runs, words)
        if self.counts_runs:
            ends = proportion_interval(int(values.sum()), len(values))
        else:
            ends = mean_interval(values, generator(0, Purpose.STATISTICS))
        return Estimate(float(values.mean()), *ends)

    def difference(self, first: NDArray[np.float64], second: NDArray[np.float64]) -> Estimate:
        """Of the means, first less second, with its 95 % interval: Newcombe's of shares, else a bootstrap."""
        if self.counts_runs:
            ends = proportions_interval((int(first.sum()), len(first)), (int(second.sum()), len(second)))
        else:
            ends = bootstrap_interval([first, second], difference_of_means, generator(0, Purpose.STATISTICS))
        return Estimate(float(first.mean() - second.mean()), *ends)


SOLVED: Final = Outcome("solved", "runs that solve\nall trials [%]", lambda run, _: run.solved, True)
PLATEAU: Final = Outcome(
    "plateau", "plateau, of the\nlargest fitness [%]", lambda run, _: run.relative_plateau
)
UNDERSTOOD: Final = Outcome(
    "understood",
    "late agents that\nunderstand what is\nheld out [%]",
    lambda run, words: run.share_understood(words),
)
# Told and drawn, not tested: it depends on how many instructions are held out.
ALL_UNDERSTOOD: Final = Outcome(
    "all understood",
    "runs with an agent\nthat understands\nall held out [%]",
    lambda run, _: run.all_understood > 0,
    True,
)
TESTED: Final = (SOLVED, PLATEAU, UNDERSTOOD)
OUTCOMES: Final = (*TESTED, ALL_UNDERSTOOD)
