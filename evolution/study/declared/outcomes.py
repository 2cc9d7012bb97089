"""What the factorial study looks at in a run, and what the paper prints for it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from arm2d import Condition
from evolution.agents.subtasks import SUBTASKS
from evolution.results import published
from evolution.search.settings import LARGEST_FITNESS
from evolution.study.declared.rows import MeasuredRun


@dataclass(frozen=True)
class Outcome:
    """One number of a run.

    Attributes:
        name: For people and tables.
        of_run: Gives it; a share lies in [0, 1].
        published: By condition.
        is_share: Whether it is a share, or yes or no, rather than a fitness.
    """

    name: str
    of_run: Callable[[MeasuredRun], float]
    published: Callable[[Condition], float]
    is_share: bool = True

    def values(self, runs: Sequence[MeasuredRun]) -> NDArray[np.float64]:
        """[runs]."""
        return np.array([self.of_run(run) for run in runs], float)


def _top_share(column: int) -> Outcome:
    return Outcome(
        f"category 10 of {SUBTASKS[column]}",
        lambda run: run.top_shares[column],
        lambda condition: published.TABLE_II[condition][-1, column] / published.AGENTS,
    )


PLATEAU: Final = Outcome("plateau", lambda run: run.plateau, lambda _: LARGEST_FITNESS, is_share=False)
# All published runs end at the largest fitness.
SOLVED: Final = Outcome("solved", lambda run: float(run.solved), lambda _: 1.0)
TOP_SHARES: Final = tuple(_top_share(column) for column in range(len(SUBTASKS)))
OUTCOMES: Final = (PLATEAU, SOLVED, *TOP_SHARES)
# By these a world is near to the paper, or far.
FIGURES: Final = (PLATEAU, *TOP_SHARES)
