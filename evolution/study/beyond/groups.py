"""The measured runs of each cell and condition, put together."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from arm2d import Instruction
from arm2d.tasks.task import AnyTask, task_of
from evolution.study.beyond.cells import CELLS, Cell
from evolution.study.beyond.outcomes import Outcome, Words
from evolution.study.beyond.rows import CellRun
from evolution.study.declared.regression import Estimate


@dataclass(frozen=True)
class Group:
    """The measured runs of a cell in one condition.

    Attributes:
        cell: The cell.
        task: The condition, or the task in its place.
        runs: One or more, by seed.
    """

    cell: Cell
    task: AnyTask
    runs: tuple[CellRun, ...]

    @property
    def held_out(self) -> tuple[Instruction, ...]:
        """What is never met."""
        return task_of(self.task).held_out

    def estimate(self, outcome: Outcome) -> Estimate:
        """What its runs come to, over all that is held out."""
        return outcome.estimate(self.runs, self.held_out)

    def of_obeying(self, words: Words) -> float:
        """Of agents that obey, the share that understands, averaged over runs with such agents; else NaN."""
        shares = [run.share_of_obeying(words) for run in self.runs if run.obeying]
        return float(np.mean(shares)) if shares else np.nan

    @property
    def obeying_runs(self) -> int:
        """How many of its runs have agents that obey all experienced instructions."""
        return sum(run.obeying > 0 for run in self.runs)


def groups_of(runs: Iterable[CellRun]) -> list[Group]:
    """Runs put together, in the order of the cells; a cell and condition without a run is left out."""
    found: dict[tuple[str, AnyTask], list[CellRun]] = {}
    for run in sorted(runs, key=lambda run: run.config.seed):
        found.setdefault((run.cell, run.config.condition), []).append(run)
    return [
        Group(cell, task, tuple(found[cell.name, task]))
        for cell in CELLS
        for task in cell.tasks
        if (cell.name, task) in found
    ]
