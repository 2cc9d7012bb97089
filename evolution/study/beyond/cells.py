"""The cells of the study: the paper's task, and what differs from it in one thing at a time.

Which cells, seeds and runs there are was declared before the first run (docs/beyond.md).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, Final

from arm2d import Condition, Readings, Task
from arm2d.tasks.task import AnyTask, as_paper, task_of
from evolution.search.config import RunConfig
from evolution.search.settings import Settings
from evolution.study.declared.parts import DeclaredPart

NAME: Final = "beyond"
SEEDS: Final = range(201, 221)
GENERATIONS: Final = 6000
WITH_BOTH: Final = Task(third="both")


@dataclass(frozen=True)
class Cell:
    """Runs that differ in condition and seed only.

    Attributes:
        name: In files.
        title: In the picture.
        differs: What is not the paper's of the task, as the fields of `arm2d.Task`.
        inter_neurons: Of every network.
        bases: The tasks that it differs from: both conditions, or twelve instructions.
    """

    name: str
    title: str
    differs: Mapping[str, Any] = field(default_factory=dict, hash=False)
    inter_neurons: int = Settings.inter_neurons
    bases: tuple[AnyTask, ...] = tuple(Condition)

    @cached_property
    def tasks(self) -> tuple[AnyTask, ...]:
        """One for each condition in which it is run."""
        return tuple(as_paper(Task(third=task_of(base).third, **self.differs)) for base in self.bases)


# MOVE and TOUCH are then met with red alone; blue and green are known from the third action.
FOUR: Final = ("move blue", "move green", "touch blue", "touch green")
PAPER: Final = Cell("paper", "the paper's task")
CELLS: Final = (
    PAPER,
    Cell("twelve", "twelve instructions", bases=(WITH_BOTH,)),
    Cell("dealt", "colours change places", {"places": "dealt"}),
    Cell("object-first", "object word first", {"words": "object-first"}),
    Cell("action-first", "action word first", {"words": "action-first"}),
    Cell("five-neurons", "5 inter-neurons", inter_neurons=5),
    Cell("eight-neurons", "8 inter-neurons", inter_neurons=8),
    Cell("without-move-blue", "MOVE Blue alone held out", {"held_out": ("move blue",)}),
    Cell("without-touch-green", "TOUCH Green alone held out", {"held_out": ("touch green",)}),
    Cell("without-four", "four held out", {"held_out": FOUR}),
)
BY_NAME: Final = {cell.name: cell for cell in CELLS}


def beyond(generations: int = GENERATIONS) -> DeclaredPart:
    """All runs under the default readings of the day, seed by seed.

    So the runs done at any time are a study by themselves.
    """
    configs = [
        config_of(cell, task, seed, generations) for seed in SEEDS for cell in CELLS for task in cell.tasks
    ]
    return DeclaredPart(NAME, tuple(configs))


def config_of(
    cell: Cell, task: AnyTask, seed: int, generations: int, readings: Readings | None = None
) -> RunConfig:
    """A run of a cell."""
    settings = Settings(generations=generations, inter_neurons=cell.inter_neurons)
    return RunConfig(task, seed, settings, readings or Readings())


def cell_of(config: RunConfig) -> Cell:
    """The cell that a run belongs to.

    Raises:
        ValueError: If it belongs to none.
    """
    for cell in CELLS:
        if config.condition in cell.tasks and config.settings.inter_neurons == cell.inter_neurons:
            return cell
    n = config.settings.inter_neurons
    raise ValueError(f"no cell has the task {config.condition} and {n} inter-neurons")
