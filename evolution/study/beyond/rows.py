"""Measured runs of the study as rows of one file: which run it was, and what its late agents understand.

Axes: A late agents, I instructions of the run's task.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from arm2d import ActionWord, Instruction, ObjectWord
from arm2d.records import brief
from arm2d.tasks.task import read_task
from evolution.agents.firsts import NEVER
from evolution.agents.postevaluation import TRIALS
from evolution.agents.subtasks import carries_out, obeys_experienced
from evolution.results.records import ends_at_largest
from evolution.runs.folder import RunFolder
from evolution.runs.lock import locked
from evolution.search.config import RunConfig
from evolution.search.settings import Settings
from evolution.study.beyond.cells import cell_of
from evolution.study.declared.plan import Measurement
from evolution.study.measures import is_measured, measure
from evolution.study.row_files import COURSE, course_of, read_table, reading_columns, readings_of, write_table

PLATEAU_DIGITS: Final = 6
INSTRUCTIONS: Final = tuple(Instruction(action, object_) for action in ActionWord for object_ in ObjectWord)


@dataclass(frozen=True)
class CellRun:
    """One run in numbers.

    Attributes:
        config: The run.
        plateau: Median best fitness over the last sixth of its generations.
        first_solved: First generation in which one genotype carried out all its trials; -1 if none.
        solved_late: Share of the last third of generations in which one did.
        agents: Late agents that were tested: the five best of every tenth generation of the last third.
        obeying: Those that exceed 75 % on every experienced instruction.
        understood: Those of them that exceed 75 % on a held-out instruction, by instruction,
        all_understood: and on all of them.
        successes: Share of successful trials of all agents, by instruction.
    """

    config: RunConfig
    plateau: float
    first_solved: int
    solved_late: float
    agents: int
    obeying: int
    understood: Mapping[Instruction, int]
    all_understood: int
    successes: Mapping[Instruction, float]

    __repr__ = brief

    @cached_property
    def cell(self) -> str:
        """The name of its cell."""
        return cell_of(self.config).name

    @property
    def solved(self) -> bool:
        """Whether one genotype ever carried out all its trials."""
        return self.first_solved != NEVER

    @property
    def relative_plateau(self) -> float:
        """The plateau as a share of the largest fitness of its task; exact to the digits that rows have.

        18/7 is no number of six digits: without rounding, tasks that end at their limits would differ.
        """
        return round(self.plateau / self.config.task.largest_fitness, PLATEAU_DIGITS)

    @property
    def at_limit(self) -> bool:
        """Whether it ends at the largest fitness of its task."""
        return bool(ends_at_largest(self.plateau, self.config.task.largest_fitness))

    def share_understood(self, instructions: Iterable[Instruction]) -> float:
        """Share of late agents that understand a held-out instruction, on average over these."""
        return float(np.mean([self.understood[each] for each in instructions])) / self.agents

    def share_of_obeying(self, instructions: Iterable[Instruction]) -> float:
        """The same of the agents that obey all experienced instructions; NaN where none does."""
        return self.share_understood(instructions) * self.agents / self.obeying if self.obeying else np.nan


def measured_run(folder: RunFolder) -> CellRun:
    """The numbers of a finished run; what has to be simulated for them is kept beside it.

    Raises:
        ValueError: If the run is not finished, or too short.
        DamagedFileError: If a file of it is damaged.
    """
    found, task = measure(folder), folder.config.condition
    agents, held_out = found.agents, folder.config.task.held_out
    understood = {word: carries_out(agents, task, word) for word in held_out}
    return CellRun(
        config=folder.config,
        plateau=round(found.plateau, PLATEAU_DIGITS),
        first_solved=found.first_solved,
        solved_late=round(found.solved_late, 4),
        agents=len(agents),
        obeying=int(obeys_experienced(agents, task).sum()),
        understood={word: int(each.sum()) for word, each in understood.items()},
        all_understood=int(np.all(list(understood.values()), axis=0).sum()),
        successes=_success(agents, task.instructions),
    )


def _success(agents: NDArray[np.integer], instructions: Iterable[Instruction]) -> dict[Instruction, float]:
    """Share of successful trials of agents [A, I]."""
    shares = (agents.mean(axis=0) / TRIALS).round(4)
    return {word: float(share) for word, share in zip(instructions, shares, strict=True)}


def measure_run(folder: str) -> int:
    """Measure a run in a process of its own."""
    run = RunFolder.open(Path(folder))
    with locked(run.path):
        measure(run)
    return 0


COLUMNS: Final[Mapping[str, Callable[[CellRun], Any]]] = {
    "cell": lambda run: run.cell,
    "condition": lambda run: run.config.task.condition_name,
    "held out": lambda run: ", ".join(map(str, run.config.task.held_out)),
    "words": lambda run: run.config.task.words,
    "places": lambda run: run.config.task.places,
    "inter-neurons": lambda run: run.config.settings.inter_neurons,
    "seed": lambda run: run.config.seed,
    "generations": lambda run: run.config.settings.generations,
    **reading_columns(),
    **COURSE,
    "agents": lambda run: run.agents,
    "obey all experienced": lambda run: run.obeying,
    **{
        f"and understand {word}": lambda run, word=word: run.understood.get(word, "") for word in INSTRUCTIONS
    },
    "and understand all held out": lambda run: run.all_understood,
    **{
        f"success of {word}": lambda run, word=word: (
            f"{run.successes[word]:.4f}" if word in run.successes else ""
        )
        for word in INSTRUCTIONS
    },
}


def write_rows(runs: Iterable[CellRun], path: Path) -> None:
    """Write a file of rows, at once or not at all.

    Raises:
        OSError: If it cannot be written.
    """
    write_table(COLUMNS, runs, path)


def read_rows(path: Path) -> list[CellRun]:
    """The runs of a file of rows; none if it is not there.

    Raises:
        ValueError: If it is no such file, or a row cannot be understood.
    """
    return read_table(path, COLUMNS, _run)


def _run(told: Mapping[str, str]) -> CellRun:
    """A run from its row."""
    task = read_task(
        told["condition"],
        {"held_out": told["held out"].split(", "), "words": told["words"], "places": told["places"]},
    )
    settings = Settings(generations=int(told["generations"]), inter_neurons=int(told["inter-neurons"]))
    config = RunConfig(task, int(told["seed"]), settings, readings_of(told))
    if (name := cell_of(config).name) != told["cell"]:
        raise ValueError(f"a run of {task} with {settings.inter_neurons} inter-neurons is of the cell {name}")
    return CellRun(
        config=config,
        **course_of(told),
        agents=int(told["agents"]),
        obeying=int(told["obey all experienced"]),
        understood=_told_of(told, "and understand {}", config.task.held_out, int),
        all_understood=int(told["and understand all held out"]),
        successes=_told_of(told, "success of {}", config.task.instructions, float),
    )


def _told_of(
    told: Mapping[str, str], column: str, instructions: Iterable[Instruction], kind: Callable[[str], Any]
) -> dict[Instruction, Any]:
    """What a row tells of these instructions."""
    return {word: kind(told[column.format(word)]) for word in instructions}


MEASUREMENT: Final = Measurement(measure_run, is_measured, measured_run, read_rows, write_rows)
