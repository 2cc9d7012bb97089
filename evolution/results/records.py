"""What an analysed experiment is: records of numbers, without a word on how they are computed or shown.

Axes: R runs, G generations, L late generations (4000 to 5999 in the paper), 5 ranks, 9 instructions.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from arm2d import Condition
from arm2d.records import alike, brief
from evolution.agents.firsts import NEVER
from evolution.agents.subtasks import SUBTASKS, AgentClass
from evolution.experiments.experiment import Experiment
from evolution.results.generalisers import Generalisers
from evolution.results.statistics import Comparison
from evolution.runs.folder import RunFolder
from evolution.search.settings import LARGEST_FITNESS, N_BEST

# Runs whose plateau comes so near to the largest fitness count as having reached the paper's 2.57.
PLATEAU_TOLERANCE: Final = 0.02


def ends_at_largest(plateau: ArrayLike, largest: float = LARGEST_FITNESS) -> NDArray[np.bool_]:
    """Whether runs with these plateaus end at the largest fitness of their task, the paper's 2.57."""
    return np.asarray(plateau) >= largest - PLATEAU_TOLERANCE


@dataclass(frozen=True)
class TransitionOutcome:
    """What a class of agents made of the two transition tests.

    Attributes:
        agents: How many were tested.
        action_passed: How many passed the action transition,
        object_passed: and the object transition.
        action_success: [X], mean share of successful trials in each transition of the action word,
        object_success: and of the object word. NaN if no agent was tested.
        runs_action: Runs with an agent that passed the action transition,
        runs_object: and the object transition.
    """

    agents: int
    action_passed: int
    object_passed: int
    action_success: NDArray[np.float64]
    object_success: NDArray[np.float64]
    runs_action: int
    runs_object: int

    __repr__ = brief
    __eq__ = alike


@dataclass(frozen=True)
class ConditionResults:
    """The results of one condition.

    Attributes:
        condition: With-Indicate or With-Ignore.
        runs: The R runs that are in here.
        seeds: [R].
        best: [R, G], best fitness per generation.
        plateau: [R], median best fitness at the end.
        first_solved: [R], first generation in which one genotype carried out all trials; -1 if none.
        genotypes: [R], distinct genotypes among the five best of the late generations.
        longest_stay: [R], the most of these generations in which one genotype was among the five best.
        generations: [L], the late generations.
        successes: [R, L, 5, 9], of 80 trials.
        counts: [11, 4], Table II: agents by category and sub-task.
        counts_per_run: [R, 11, 4].
        members: Agents of each class, [R] by class.
        generalisers: Of each run: its fully compositional agents over time.
        transitions: By class.
        missing: One sentence for every run that was left out.
    """

    condition: Condition
    runs: tuple[RunFolder, ...]
    seeds: NDArray[np.int64]
    best: NDArray[np.float64]
    plateau: NDArray[np.float64]
    first_solved: NDArray[np.int64]
    genotypes: NDArray[np.int64]
    longest_stay: NDArray[np.int64]
    generations: NDArray[np.int32]
    successes: NDArray[np.int16]
    counts: NDArray[np.int64]
    counts_per_run: NDArray[np.int64]
    members: Mapping[AgentClass, NDArray[np.int64]]
    generalisers: tuple[Generalisers, ...]
    transitions: Mapping[AgentClass, TransitionOutcome]
    missing: tuple[str, ...]

    __repr__ = brief
    __eq__ = alike

    @property
    def n_agents(self) -> int:
        """All post-evaluated agents."""
        return int(self.counts[:, 0].sum())

    @property
    def at_plateau(self) -> int:
        """Runs that end at the paper's 2.57."""
        return int(ends_at_largest(self.plateau).sum())

    def share_in_top(self, subtask: str) -> NDArray[np.float64]:
        """Share of each run's agents in category 10 of a sub-task, [R]."""
        column = self.counts_per_run[:, :, SUBTASKS.index(subtask)]
        return column[:, -1] / np.maximum(column.sum(axis=1), 1)

    def share_of_class(self, members: AgentClass) -> NDArray[np.float64]:
        """Share of each run's agents in a class, [R]."""
        return self.members[members] / (len(self.generations) * N_BEST)


@dataclass(frozen=True)
class AnalysedRun:
    """One run of the results of its condition.

    Attributes:
        results: Of the condition.
        index: Of the run, in there.
    """

    results: ConditionResults
    index: int

    @property
    def condition(self) -> Condition:
        """Its condition."""
        return self.results.condition

    @property
    def seed(self) -> int:
        """Its seed."""
        return int(self.results.seeds[self.index])

    @property
    def plateau(self) -> float:
        """Median best fitness at its end."""
        return float(self.results.plateau[self.index])

    @property
    def genotypes(self) -> int:
        """Distinct genotypes among the five best of its late generations."""
        return int(self.results.genotypes[self.index])

    @property
    def longest_stay(self) -> int:
        """The most late generations in which one genotype was among the five best."""
        return int(self.results.longest_stay[self.index])

    @property
    def generalisers(self) -> Generalisers:
        """Its fully compositional agents over time."""
        return self.results.generalisers[self.index]

    def first_solved_in_words(self, form: str) -> str:
        """The first generation in which one genotype carried out all trials, in a form, or "never"."""
        first = int(self.results.first_solved[self.index])
        return form.format(first) if first != NEVER else "never"

    def members(self, kind: AgentClass) -> int:
        """How many of its agents belong to a class."""
        return int(self.results.members[kind][self.index])

    def in_top(self, subtask: str) -> int:
        """How many of its agents are in category 10 of a sub-task."""
        return int(self.results.counts_per_run[self.index, -1, SUBTASKS.index(subtask)])

    def share_in_top(self, subtask: str) -> float:
        """The same as a share of its agents."""
        return float(self.results.share_in_top(subtask)[self.index])


@dataclass(frozen=True)
class Results:
    """The results of an experiment.

    Attributes:
        experiment: Where they come from.
        conditions: By condition, as far as there are runs.
        comparisons: Between With-Indicate and With-Ignore with the run as the unit, by what is compared.
        published_tests: (statistic, p) of the paper's kind of test, by the same names.
    """

    experiment: Experiment
    conditions: Mapping[Condition, ConditionResults]
    comparisons: Mapping[str, Comparison]
    published_tests: Mapping[str, tuple[float, float]]

    @property
    def analysed_runs(self) -> list[AnalysedRun]:
        """All runs that are in here, condition by condition."""
        return [AnalysedRun(found, i) for found in self.conditions.values() for i in range(len(found.runs))]

    @property
    def missing(self) -> tuple[str, ...]:
        """One sentence for everything that is missing or was left out."""
        left_out = [sentence for found in self.conditions.values() for sentence in found.missing]
        return (*self.experiment.unreadable, *self.experiment.copies, *self.experiment.absent, *left_out)
