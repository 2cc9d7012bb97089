"""What each cell comes to, and whether that is more or less than the paper's task does; the run is the unit.

As declared in docs/beyond.md. Axes: R runs.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from typing import Final, Literal

import numpy as np
from numpy.typing import NDArray

from arm2d import Condition, Instruction
from arm2d.tasks.task import AnyTask, task_of
from evolution.results.statistics import (
    bootstrap_interval,
    declared_ways,
    difference_of_means,
    mean_interval,
    permutation_p,
    proportion_interval,
    proportions_interval,
)
from evolution.search.randomness import Purpose, generator
from evolution.study.beyond.cells import CELLS, PAPER, Cell
from evolution.study.beyond.rows import CellRun
from evolution.study.declared.regression import SIGNIFICANT, Estimate
from evolution.study.effects import holm

FEWEST_RUNS: Final = 2
Verdict = Literal["more", "less", "undecided"]
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


@dataclass(frozen=True)
class Comparison:
    """A cell against the paper's task in one condition, by one outcome.

    Attributes:
        group: The runs of the cell,
        paper: and those of the paper's task.
        outcome: What is compared.
        means: Over runs of the cell and of the paper's task, over the instructions that both hold out.
        difference: Of the means, with its 95 % interval.
        p: Two-sided, runs being exchanged.
        corrected: The same after Holm's correction over all comparisons.
    """

    group: Group
    paper: Group
    outcome: Outcome
    means: tuple[float, float]
    difference: Estimate
    p: float
    corrected: float = float("nan")

    @property
    def verdict(self) -> Verdict:
        """Whether the cell has shown more, or less, than the paper's task."""
        if self.corrected >= SIGNIFICANT:
            return "undecided"
        return "more" if self.difference.value > 0 else "less"

    @property
    def words(self) -> tuple[Instruction, ...]:
        """What cell and paper's task both hold out."""
        return shared_words(self.group, self.paper)

    @property
    def sentence(self) -> str:
        """The verdict in words."""
        own = [100 * each for each in (self.difference.value, self.difference.low, self.difference.high)]
        return (
            f"{self.group.cell.name}, {self.paper.task}: {self.outcome.name} {self.verdict}, "
            f"{own[0]:+.1f} points [{own[1]:.1f}, {own[2]:.1f}], p = {self.corrected:.2g} after Holm"
        )


def comparisons(groups: Sequence[Group]) -> list[Comparison]:
    """Every cell against the paper's task in the same condition; twelve instructions against both.

    Groups of fewer than two runs are left out.
    """
    enough = [group for group in groups if len(group.runs) >= FEWEST_RUNS]
    papers = [group for group in enough if group.cell == PAPER]
    found = [
        _compare(group, paper, outcome)
        for group in enough
        for paper in papers
        if group.cell != PAPER and _is_base(paper, group)
        for outcome in TESTED
    ]
    corrected = holm(np.array([each.p for each in found]))
    return [replace(each, corrected=float(p)) for each, p in zip(found, corrected, strict=True)]


def verdict_of(group: Group, outcome: Outcome, found: Iterable[Comparison]) -> Verdict:
    """What the comparisons say of a group: of one that is compared with both conditions, if they agree."""
    own: list[Verdict] = [each.verdict for each in found if each.group == group and each.outcome == outcome]
    bases = len(Condition) if task_of(group.task).third == "both" else 1
    return own[0] if len(own) == bases and len(set(own)) == 1 else "undecided"


def shared_words(group: Group, paper: Group) -> tuple[Instruction, ...]:
    """What both hold out: over these words alone understanding can be compared."""
    return tuple(word for word in group.held_out if word in paper.held_out)


# What a change does, of these outcomes.
SUBJECTS: Final = {"evolution": (SOLVED, PLATEAU), "understanding": (UNDERSTOOD,)}


def effects_of(cell: Cell, groups: Iterable[Group], found: Sequence[Comparison]) -> dict[str, str]:
    """Whether a change helps, hinders or is undecided as to evolution and as to understanding.

    It helps (hinders) if an outcome says more (less) in at least one condition and none says the contrary.
    """
    own = [group for group in groups if group.cell == cell]
    told = {}
    for subject, outcomes in SUBJECTS.items():
        said = {verdict_of(group, outcome, found) for group in own for outcome in outcomes}
        shown = said - {"undecided"}
        told[subject] = {"more": "helps", "less": "hinders"}[shown.pop()] if len(shown) == 1 else "undecided"
    return told


def sentences(groups: Sequence[Group], found: Sequence[Comparison]) -> list[str]:
    """Every verdict with its comparisons, and what each change does."""
    told = []
    for group in groups:
        for outcome in TESTED:
            if verdict_of(group, outcome, found) != "undecided":
                told += [each.sentence for each in found if (each.group, each.outcome) == (group, outcome)]
    for cell in dict.fromkeys(group.cell for group in groups if group.cell != PAPER):
        shown = {s: effect for s, effect in effects_of(cell, groups, found).items() if effect != "undecided"}
        told += [f"{cell.name} {effect} {subject}" for subject, effect in shown.items()]
        if [*shown.values()] in (["helps"] * len(SUBJECTS), ["hinders"] * len(SUBJECTS)):
            told.append(_with_success(cell, shown["evolution"], found))
    return told


def _with_success(cell: Cell, effect: str, found: Iterable[Comparison]) -> str:
    """What is said of a cell where understanding goes with the success of evolution."""
    more = "more" if effect == "helps" else "less"
    own = [each for each in found if each.group.cell == cell and each.outcome == UNDERSTOOD]
    shares = "; ".join(
        f"{each.paper.task} {100 * each.group.of_obeying(each.words):.1f} % "
        f"({100 * each.paper.of_obeying(each.words):.1f} % in the paper's task)"
        for each in own
    )
    return (
        f"{cell.name}: {more} is understood where evolution succeeds {more}; of the agents that obey all "
        f"experienced instructions understand: {shares}"
    )


def _is_base(paper: Group, group: Group) -> bool:
    """Whether a group is compared with this one: both have the same third action, or it has both."""
    third = task_of(group.task).third
    return third in ("both", task_of(paper.task).third)


def _compare(group: Group, paper: Group, outcome: Outcome) -> Comparison:
    words = shared_words(group, paper)
    first, second = outcome.values(group.runs, words), outcome.values(paper.runs, words)
    ways = declared_ways(len(first) + len(second), len(first))
    return Comparison(
        group=group,
        paper=paper,
        outcome=outcome,
        means=(float(first.mean()), float(second.mean())),
        difference=outcome.difference(first, second),
        p=permutation_p(np.concatenate([first, second]), ways),
    )
