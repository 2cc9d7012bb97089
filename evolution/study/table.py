"""The study in rows: one per run with all its numbers, one per variant with intervals over its runs."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from arm2d import Condition, Instruction, ObjectWord
from arm2d.trials import START_AREAS
from evolution.agents.postevaluation import N_INSTRUCTIONS
from evolution.agents.subtasks import SUBTASKS, AgentClass
from evolution.report.columns import PlainTable
from evolution.results import published
from evolution.results.statistics import mean_interval, midranks
from evolution.search.randomness import Purpose, generator
from evolution.search.settings import LARGEST_FITNESS
from evolution.study.measures import RunMeasures

ACTIONS: Final = ("MOVE", "TOUCH", "third")


@dataclass(frozen=True)
class VariantMeasures:
    """All runs of one variant in one condition.

    Attributes:
        name: Of the variant: the readings that differ from the plain ones, or `default`.
        condition: Of its runs.
        generations: Of each run.
        runs: One or more, by seed.
    """

    name: str
    condition: Condition
    generations: int
    runs: tuple[RunMeasures, ...]

    @property
    def plateaus(self) -> NDArray[np.float64]:
        """[R]."""
        return np.array([run.plateau for run in self.runs])

    @property
    def solved(self) -> NDArray[np.bool_]:
        """Which runs had a genotype that carried out all trials of its generation, [R]."""
        return np.array([run.solved for run in self.runs])

    @property
    def times_to_solve(self) -> NDArray[np.int64]:
        """First generations of those that did, ascending."""
        return np.sort([run.first_solved for run in self.runs if run.solved])

    @property
    def top_shares(self) -> NDArray[np.float64]:
        """Share of agents in category 10 of the sub-tasks, [R, 4]."""
        return np.array([run.top_shares for run in self.runs])

    def class_shares(self, kind: AgentClass) -> NDArray[np.float64]:
        """Share of agents in a class, [R]."""
        return np.array([run.class_shares[kind] for run in self.runs])

    @property
    def success_by_area(self) -> NDArray[np.float64]:
        """Mean over runs, [9, 2]."""
        return np.mean([run.success_by_area for run in self.runs], axis=0)

    @property
    def weakest(self) -> tuple[Instruction, str, float]:
        """The experienced instruction and start area with the lowest success, and that success."""
        order = self.condition.instructions
        known = [order.index(word) for word in self.condition.experienced]
        success = self.success_by_area[known]
        row, area = np.unravel_index(int(success.argmin()), success.shape)
        return order[known[row]], START_AREAS[area], float(success.min())


def group(measured: Iterable[tuple[str, RunMeasures]]) -> list[VariantMeasures]:
    """Runs named by their variant, put together in the order in which variants first appear."""
    groups: dict[tuple[str, Condition, int], list[RunMeasures]] = {}
    for name, run in measured:
        key = (name, run.config.papers_condition, run.config.settings.generations)
        groups.setdefault(key, []).append(run)
    return [
        VariantMeasures(*key, tuple(sorted(runs, key=lambda run: run.config.seed)))
        for key, runs in groups.items()
    ]


def nearest(variants: Sequence[VariantMeasures], n: int = 3) -> list[VariantMeasures]:
    """The n variants that come nearest to the paper, the nearest first.

    Each is ranked by how far its mean plateau is from the published one, and by how far its mean share of
    agents in category 10 of sub-task I is from Table II's; the sum of both ranks decides.
    """
    plateau_gaps = np.array([abs(variant.plateaus.mean() - LARGEST_FITNESS) for variant in variants])
    share_gaps = np.array(
        [abs(variant.top_shares[:, 0].mean() - _published_share(variant)) for variant in variants]
    )
    order = np.argsort(midranks(plateau_gaps) + midranks(share_gaps), kind="stable")
    return [variants[i] for i in order[:n]]


def _published_share(variant: VariantMeasures) -> float:
    return published.TABLE_II[variant.condition][-1, 0] / published.AGENTS


def interval(values: NDArray[np.float64]) -> tuple[float, float]:
    """95 % bootstrap interval of the mean over runs, the same whenever it is asked for."""
    return mean_interval(values, generator(0, Purpose.STATISTICS))


def variant_table(variants: Sequence[VariantMeasures]) -> PlainTable[VariantMeasures]:
    """Every variant and condition in a row."""

    def top_share(subtask: int) -> Callable[[VariantMeasures], NDArray[np.float64]]:
        return lambda variant: variant.top_shares[:, subtask]

    def runs_with(kind: AgentClass) -> Callable[[VariantMeasures], int]:
        return lambda variant: int((variant.class_shares(kind) > 0).sum())

    top_shares: dict[str, Callable[[VariantMeasures], object]] = {}
    for column, subtask in enumerate(SUBTASKS):
        top_shares |= _mean_columns(f"sub-task {subtask}, category 10", top_share(column))
    return PlainTable(
        {
            "variant": lambda variant: variant.name,
            "condition": lambda variant: variant.condition,
            "generations": lambda variant: variant.generations,
            "runs": lambda variant: len(variant.runs),
            **_mean_columns("plateau", lambda variant: variant.plateaus),
            "best plateau": lambda variant: f"{variant.plateaus.max():.4f}",
            "runs at 18/7": lambda variant: sum(run.at_limit for run in variant.runs),
            "runs that solve all trials": lambda variant: variant.solved.sum(),
            "median generation of these": lambda variant: (
                int(np.median(variant.times_to_solve)) if variant.solved.any() else ""
            ),
            **top_shares,
            **{f"runs with {kind} agents": runs_with(kind) for kind in AgentClass},
            "weakest instruction": lambda variant: variant.weakest[0],
            "from": lambda variant: variant.weakest[1],
            "its success": lambda variant: f"{variant.weakest[2]:.3f}",
        },
        variants,
    )


def _mean_columns(
    name: str, values: Callable[[VariantMeasures], NDArray[np.float64]]
) -> dict[str, Callable[[VariantMeasures], object]]:
    """The mean over runs of one number of theirs, and both ends of its interval."""
    return {
        name: lambda variant: f"{values(variant).mean():.4f}",
        f"{name} low": lambda variant: f"{interval(values(variant))[0]:.4f}",
        f"{name} high": lambda variant: f"{interval(values(variant))[1]:.4f}",
    }


class MeasuredRun(NamedTuple):
    """A run of a variant."""

    variant: VariantMeasures
    measures: RunMeasures


def run_table(variants: Sequence[VariantMeasures]) -> PlainTable[MeasuredRun]:
    """Every run in a row; third-action columns are INDICATE's or IGNORE's, by condition."""

    def top_share(subtask: int) -> Callable[[MeasuredRun], str]:
        return lambda run: f"{run.measures.top_shares[subtask]:.4f}"

    def class_share(kind: AgentClass) -> Callable[[MeasuredRun], str]:
        return lambda run: f"{run.measures.class_shares[kind]:.4f}"

    def success(instruction: int, area: int) -> Callable[[MeasuredRun], str]:
        return lambda run: f"{run.measures.success_by_area[instruction, area]:.3f}"

    successes = {
        f"{ACTIONS[instruction // 3]} {ObjectWord(instruction % 3).name.capitalize()}, {name}": success(
            instruction, area
        )
        for instruction in range(N_INSTRUCTIONS)
        for area, name in enumerate(START_AREAS)
    }
    return PlainTable(
        {
            "variant": lambda run: run.variant.name,
            "condition": lambda run: run.variant.condition,
            "generations": lambda run: run.variant.generations,
            "seed": lambda run: run.measures.config.seed,
            "plateau": lambda run: f"{run.measures.plateau:.4f}",
            "first generation that solved all trials": lambda run: (
                run.measures.first_solved if run.measures.solved else "never"
            ),
            "share of late generations that did": lambda run: f"{run.measures.solved_late:.3f}",
            **{f"sub-task {name}, category 10": top_share(i) for i, name in enumerate(SUBTASKS)},
            **{kind: class_share(kind) for kind in AgentClass},
            **successes,
        },
        [MeasuredRun(variant, measures) for variant in variants for measures in variant.runs],
    )
