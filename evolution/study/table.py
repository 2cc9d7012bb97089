"""The study in rows: one per run with all its numbers, one per variant with intervals over its runs."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from arm2d import Condition, Instruction
from evolution.agents.subtasks import SUBTASKS, AgentClass
from evolution.results import published
from evolution.results.statistics import mean_interval, midranks
from evolution.search.randomness import Purpose, generator
from evolution.search.settings import LARGEST_FITNESS
from evolution.study.measures import RunMeasures

AREAS: Final = ("right", "left")
ACTIONS: Final = ("MOVE", "TOUCH", "third")


@dataclass(frozen=True)
class VariantMeasures:
    """All runs of one variant in one condition.

    Attributes:
        name: Of the variant: the readings that differ from the default, or `default`.
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
        return np.array([each.plateau for each in self.runs])

    @property
    def solved(self) -> NDArray[np.bool_]:
        """Which runs had a genotype that carried out all trials of its generation, [R]."""
        return np.array([each.first_solved >= 0 for each in self.runs])

    @property
    def times_to_solve(self) -> NDArray[np.int64]:
        """First generations of those that did, ascending."""
        return np.sort([each.first_solved for each in self.runs if each.first_solved >= 0])

    @property
    def top_shares(self) -> NDArray[np.float64]:
        """Share of agents in category 10 of the sub-tasks, [R, 4]."""
        return np.array([each.top_shares for each in self.runs])

    def class_shares(self, kind: AgentClass) -> NDArray[np.float64]:
        """Share of agents in a class, [R]."""
        return np.array([each.class_shares[kind] for each in self.runs])

    @property
    def success_by_area(self) -> NDArray[np.float64]:
        """Mean over runs, [9, 2]."""
        return np.mean([each.success_by_area for each in self.runs], axis=0)

    @property
    def weakest(self) -> tuple[Instruction, str, float]:
        """The experienced instruction and start area with the lowest success, and that success."""
        order = self.condition.instructions
        known = [order.index(each) for each in self.condition.experienced]
        success = self.success_by_area[known]
        row, area = np.unravel_index(int(success.argmin()), success.shape)
        return order[known[row]], AREAS[area], float(success.min())


def group(measured: Iterable[tuple[str, RunMeasures]]) -> list[VariantMeasures]:
    """Runs named by their variant, put together in the order in which variants first appear."""
    groups: dict[tuple[str, Condition, int], list[RunMeasures]] = {}
    for name, each in measured:
        key = (name, each.config.condition, each.config.settings.generations)
        groups.setdefault(key, []).append(each)
    return [
        VariantMeasures(*key, tuple(sorted(runs, key=lambda run: run.config.seed)))
        for key, runs in groups.items()
    ]


def nearest(variants: Sequence[VariantMeasures], n: int = 3) -> list[VariantMeasures]:
    """The n variants that come nearest to the paper, the nearest first.

    Each is ranked by how far its mean plateau is from the published one, and by how far its mean share of
    agents in category 10 of sub-task I is from Table II's; the sum of both ranks decides.
    """
    plateau_gaps = np.array([abs(each.plateaus.mean() - LARGEST_FITNESS) for each in variants])
    share_gaps = np.array([abs(each.top_shares[:, 0].mean() - _published_share(each)) for each in variants])
    order = np.argsort(midranks(plateau_gaps) + midranks(share_gaps), kind="stable")
    return [variants[i] for i in order[:n]]


def _published_share(variant: VariantMeasures) -> float:
    return published.TABLE_II[variant.condition][-1, 0] / published.AGENTS


def interval(values: NDArray[np.float64]) -> tuple[float, float]:
    """95 % bootstrap interval of the mean over runs, the same whenever it is asked for."""
    return mean_interval(values, generator(0, Purpose.STATISTICS))


def variant_rows(variants: Sequence[VariantMeasures]) -> Iterable[Sequence[object]]:
    """One row per variant and condition."""
    tops = [f"sub-task {name}, category 10{part}" for name in SUBTASKS for part in ("", " low", " high")]
    classes = [f"runs with {kind} agents" for kind in AgentClass]
    yield (
        "variant", "condition", "generations", "runs", "plateau", "plateau low", "plateau high",
        "best plateau", "runs at 18/7", "runs that solve all trials", "median generation of these", *tops,
        *classes, "weakest instruction", "from", "its success",
    )  # fmt: skip
    for each in variants:
        times = each.times_to_solve
        shares = [f"{v:.4f}" for top in each.top_shares.T for v in (top.mean(), *interval(top))]
        instruction, area, success = each.weakest
        yield (
            each.name, str(each.condition), each.generations, len(each.runs),
            *(f"{v:.4f}" for v in (each.plateaus.mean(), *interval(each.plateaus), each.plateaus.max())),
            sum(run.at_limit for run in each.runs), int(each.solved.sum()),
            int(np.median(times)) if len(times) else "",
            *shares, *(int((each.class_shares(kind) > 0).sum()) for kind in AgentClass),
            str(instruction), area, f"{success:.3f}",
        )  # fmt: skip


def run_rows(variants: Sequence[VariantMeasures]) -> Iterable[Sequence[object]]:
    """One row per run; third-action columns are INDICATE's or IGNORE's, by condition."""
    tops = [f"sub-task {name}, category 10" for name in SUBTASKS]
    names = [
        f"{action} {thing}" for action in ("MOVE", "TOUCH", "third") for thing in ("Blue", "Green", "Red")
    ]
    columns = [f"{name}, {area}" for name in names for area in AREAS]
    yield (
        "variant", "condition", "generations", "seed", "plateau", "first generation that solved all trials",
        "share of late generations that did", *tops, *(str(kind) for kind in AgentClass), *columns,
    )  # fmt: skip
    for variant in variants:
        for run in variant.runs:
            yield (
                variant.name, str(variant.condition), variant.generations, run.config.seed,
                f"{run.plateau:.4f}", run.first_solved if run.first_solved >= 0 else "never",
                f"{run.solved_late:.3f}", *(f"{share:.4f}" for share in run.top_shares),
                *(f"{run.class_shares[kind]:.4f}" for kind in AgentClass),
                *(f"{share:.3f}" for share in run.success_by_area.ravel()),
            )  # fmt: skip
