"""Each cell against the paper's task: more, less, or undecided; the run is the unit (docs/beyond.md)."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from typing import Final, Literal

import numpy as np

from arm2d import Condition, Instruction
from arm2d.tasks.task import task_of
from evolution.results.statistics import declared_ways, permutation_p
from evolution.study.beyond.cells import PAPER
from evolution.study.beyond.groups import Group
from evolution.study.beyond.outcomes import TESTED, Outcome
from evolution.study.declared.regression import SIGNIFICANT, Estimate
from evolution.study.effects import holm

FEWEST_RUNS: Final = 2
Verdict = Literal["more", "less", "undecided"]


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
