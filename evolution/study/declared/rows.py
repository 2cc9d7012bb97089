"""Measured runs as rows of one file: what the declared analysis needs of a run, and which run it was.

Axes: 4 sub-tasks, 3 classes, 2 transition tests, 9 instructions, 2 start areas.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from arm2d import NON_EXPERIENCED, Condition
from arm2d.records import alike, brief
from arm2d.trials import START_AREAS
from evolution.agents.postevaluation import N_INSTRUCTIONS, POST_EVALUATION, TRIALS
from evolution.agents.subtasks import (
    MOVE_BLUE,
    SUBTASKS,
    TOUCH_GREEN,
    categories,
    classify,
    obeys_experienced,
)
from evolution.agents.transitions import TRANSITION_TEST, passes
from evolution.results.records import PLATEAU_TOLERANCE
from evolution.runs.folder import RunFolder
from evolution.search.config import RunConfig
from evolution.search.settings import LARGEST_FITNESS, Settings
from evolution.study.late_transitions import CLASSES, TESTS, passed_transitions
from evolution.study.measures import measure, plateau_of, solved_of
from evolution.study.row_files import COURSE, course_of, read_table, reading_columns, readings_of, write_table
from evolution.study.table import ACTIONS

INSTRUCTION_COLUMNS: Final = tuple(
    f"{action} {thing}, {area}"
    for action in ACTIONS
    for thing in ("Blue", "Green", "Red")
    for area in START_AREAS
)
# Counts of agents, in the order in which they stand in a row.
COUNTS: Final = (
    "agents",
    *(f"category 10 of {name}" for name in SUBTASKS),
    *(f"category 5 of {name}" for name in SUBTASKS),
    "masters",
    "masters that understand MOVE Blue",
    "masters that understand TOUCH Green",
    *(str(kind) for kind in CLASSES),
    *(f"{kind}, pass {test} transitions" for kind in CLASSES for test in TESTS),
)


@dataclass(frozen=True)
class MeasuredRun:
    """One run in numbers.

    Attributes:
        config: The run.
        plateau: Median best fitness over the last sixth of its generations.
        first_solved: First generation in which one genotype carried out all its trials; -1 if none.
        solved_late: Share of the last third of generations in which one did.
        counts: Of late agents, by the names in `COUNTS`.
        successes: Share of late agents' successful trials, [9, 2]; after a whole post-evaluation, which does
            not tell start areas apart, both columns are the same.
    """

    config: RunConfig
    plateau: float
    first_solved: int
    solved_late: float
    counts: Mapping[str, int]
    successes: NDArray[np.float64]

    __repr__ = brief
    __eq__ = alike

    @property
    def solved(self) -> bool:
        """Whether one genotype ever carried out all its trials."""
        return self.first_solved >= 0

    @property
    def at_limit(self) -> bool:
        """Whether it ends at the paper's 2.57."""
        return self.plateau >= LARGEST_FITNESS - PLATEAU_TOLERANCE

    def share(self, count: str) -> float:
        """A count as a share of the late agents."""
        return self.counts[count] / self.counts["agents"]

    @property
    def top_shares(self) -> NDArray[np.float64]:
        """Share of agents in category 10 of the sub-tasks I to IV, [4] (Table II)."""
        return np.array([self.share(f"category 10 of {name}") for name in SUBTASKS])


COLUMNS: Final[Mapping[str, Callable[[MeasuredRun], Any]]] = {
    "condition": lambda run: str(run.config.papers_condition),
    "seed": lambda run: run.config.seed,
    "generations": lambda run: run.config.settings.generations,
    **reading_columns(),
    **COURSE,
    **{name: lambda run, name=name: run.counts[name] for name in COUNTS},
    **{
        name: lambda run, place=place: f"{run.successes.ravel()[place]:.4f}"
        for place, name in enumerate(INSTRUCTION_COLUMNS)
    },
}


def measured_run(folder: RunFolder) -> MeasuredRun:
    """The numbers of a finished run, from a sample; what has to be simulated for them is kept beside it.

    Raises:
        ValueError: If the run is not finished, or too short.
        DamagedFileError: If a file of it is damaged.
    """
    found = measure(folder)
    return MeasuredRun(
        config=folder.config,
        plateau=round(found.plateau, 6),
        first_solved=found.first_solved,
        solved_late=round(found.solved_late, 4),
        counts=_counts(found.agents, passed_transitions(folder, found), folder.config.papers_condition),
        successes=found.success_by_area.round(4),
    )


def post_evaluated_run(folder: RunFolder) -> MeasuredRun:
    """The numbers of a run that was post-evaluated whole; start areas are not told apart there.

    Raises:
        ValueError: If it was not post-evaluated.
        DamagedFileError: If a file of it is damaged.
    """
    agents, tests = POST_EVALUATION.read(folder).agents, TRANSITION_TEST.read(folder)
    first, share = solved_of(folder)
    passed = np.array(
        [
            [passes(test[tests.classes == place]).sum() for test in (tests.action, tests.object)]
            for place in range(len(CLASSES))
        ]
    )
    return MeasuredRun(
        config=folder.config,
        plateau=round(plateau_of(folder), 6),
        first_solved=first,
        solved_late=round(share, 4),
        counts=_counts(agents, passed, folder.config.papers_condition),
        successes=np.repeat(agents.mean(axis=0)[:, np.newaxis] / TRIALS, len(START_AREAS), axis=1).round(4),
    )


def _counts(agents: NDArray[np.integer], passed: NDArray[np.integer], condition: Condition) -> dict[str, int]:
    """What is counted of agents with these successes [A, 9], passed [3, 2] of whom pass the transitions."""
    in_category = categories(agents, condition)  # [A, 4]
    known, order = obeys_experienced(agents, condition), condition.instructions
    understood = {each: 4 * agents[:, order.index(each)].astype(int) > 3 * TRIALS for each in NON_EXPERIENCED}
    numbers = (
        len(agents),
        *(in_category == 10).sum(axis=0),
        *(in_category == 5).sum(axis=0),
        known.sum(),
        (known & understood[MOVE_BLUE]).sum(),
        (known & understood[TOUCH_GREEN]).sum(),
        *(each.sum() for each in classify(agents, condition).values()),
        *passed.ravel(),
    )
    return {name: int(number) for name, number in zip(COUNTS, numbers, strict=True)}


def write_rows(runs: Iterable[MeasuredRun], path: Path) -> None:
    """Write a file of rows, at once or not at all.

    Raises:
        OSError: If it cannot be written.
    """
    write_table(COLUMNS, runs, path)


def read_rows(path: Path) -> list[MeasuredRun]:
    """The runs of a file of rows; none if it is not there.

    Raises:
        ValueError: If it is no such file, or a row cannot be understood.
    """
    return read_table(path, COLUMNS, _run)


def _run(told: Mapping[str, str]) -> MeasuredRun:
    """A run from its row."""
    settings = Settings(generations=int(told["generations"]))
    successes = np.array([float(told[name]) for name in INSTRUCTION_COLUMNS])
    return MeasuredRun(
        config=RunConfig(Condition.parse(told["condition"]), int(told["seed"]), settings, readings_of(told)),
        **course_of(told),
        counts={name: int(told[name]) for name in COUNTS},
        successes=successes.reshape(N_INSTRUCTIONS, len(START_AREAS)),
    )
