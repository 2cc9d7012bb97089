"""An analysed experiment as tables for programs: Table II, runs, transitions, tests, generalisers."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from arm2d import Condition
from evolution.agents.subtasks import N_CATEGORIES, SUBTASKS, AgentClass
from evolution.report.columns import PlainTable
from evolution.results import published
from evolution.results.generalisers import CHANCE_RANK, Generalisers
from evolution.results.records import AnalysedRun, Results, TransitionOutcome
from evolution.results.statistics import Comparison
from evolution.search.settings import N_BEST


class Category(NamedTuple):
    """A category of agents in one condition: how many there are in each sub-task."""

    condition: Condition
    number: int
    paper: NDArray[np.int64]
    ours: NDArray[np.int64]


def table_ii(results: Results) -> PlainTable[Category]:
    """Agents by category and sub-task, published and ours."""

    def agents(whose: str, column: int) -> Callable[[Category], Any]:
        return lambda category: getattr(category, whose)[column]

    counts = {
        f"{whose} {subtask}": agents(whose, column)
        for column, subtask in enumerate(SUBTASKS)
        for whose in ("paper", "ours")
    }
    return PlainTable(
        {
            "condition": lambda category: category.condition,
            "category": lambda category: category.number,
            **counts,
        },
        [
            Category(condition, number, published.TABLE_II[condition][number], found.counts[number])
            for condition, found in results.conditions.items()
            for number in range(N_CATEGORIES)
        ],
    )


def run_table(results: Results) -> PlainTable[AnalysedRun]:
    """Every run in a row."""

    def members(kind: AgentClass) -> Callable[[AnalysedRun], int]:
        return lambda run: run.members(kind)

    def top_share(subtask: str) -> Callable[[AnalysedRun], str]:
        return lambda run: f"{run.share_in_top(subtask):.4f}"

    return PlainTable(
        {
            "condition": lambda run: run.condition,
            "seed": lambda run: run.seed,
            "plateau": lambda run: f"{run.plateau:.4f}",
            "first generation that solved all trials": lambda run: run.first_solved_in_words("{}"),
            **{kind: members(kind) for kind in AgentClass},
            **{f"share in category 10, sub-task {subtask}": top_share(subtask) for subtask in SUBTASKS},
            "distinct genotypes": lambda run: run.genotypes,
            "longest stay among the five best": lambda run: run.longest_stay,
        },
        results.analysed_runs,
    )


class TestedClass(NamedTuple):
    """A class of agents in the transition tests of one condition."""

    condition: Condition
    kind: AgentClass
    outcome: TransitionOutcome


def transition_table(results: Results) -> PlainTable[TestedClass]:
    """Agents that pass the transition tests, class by class."""
    return PlainTable(
        {
            "condition": lambda tested: tested.condition,
            "class": lambda tested: tested.kind,
            "agents": lambda tested: tested.outcome.agents,
            "pass action": lambda tested: tested.outcome.action_passed,
            "pass object": lambda tested: tested.outcome.object_passed,
            "runs action": lambda tested: tested.outcome.runs_action,
            "runs object": lambda tested: tested.outcome.runs_object,
        },
        [
            TestedClass(condition, kind, outcome)
            for condition, found in results.conditions.items()
            for kind, outcome in found.transitions.items()
        ],
    )


class BothTests(NamedTuple):
    """A number compared between the conditions: runs as the unit, and in the paper's way."""

    name: str
    sound: Comparison
    published_p: float


def both_tests(results: Results) -> list[BothTests]:
    """All that is compared."""
    return [
        BothTests(name, sound, results.published_tests[name][1])
        for name, sound in results.comparisons.items()
    ]


def significance_table(results: Results) -> PlainTable[BothTests]:
    """Comparisons between the conditions: runs as the unit, and the paper's kind of test."""
    return PlainTable(
        {
            "compared": lambda both: both.name,
            "With-Indicate": lambda both: f"{both.sound.means[0]:.4g}",
            "With-Ignore": lambda both: f"{both.sound.means[1]:.4g}",
            "difference": lambda both: f"{both.sound.difference:.4g}",
            "95 % low": lambda both: f"{both.sound.interval[0]:.4g}",
            "95 % high": lambda both: f"{both.sound.interval[1]:.4g}",
            "Mann-Whitney p": lambda both: f"{both.sound.mann_whitney_p:.4g}",
            "permutation p": lambda both: f"{both.sound.permutation_p:.4g}",
            "Cliff's delta": lambda both: f"{both.sound.cliffs_delta:.4g}",
            "Wilcoxon p as published": lambda both: f"{both.published_p:.4g}",
        },
        both_tests(results),
    )


def generaliser_table(results: Results) -> PlainTable[AnalysedRun]:
    """Every run in a row: where its fully compositional agents stand, and how long they last."""

    def at_rank(rank: int) -> Callable[[AnalysedRun], Any]:
        return lambda run: run.generalisers.by_rank[rank]

    return PlainTable(
        {
            "condition": lambda run: run.condition,
            "seed": lambda run: run.seed,
            "fully compositional agents": lambda run: len(run.generalisers),
            "most in a generation": lambda run: run.generalisers.counts.max(initial=0),
            **{f"at rank {rank}": at_rank(rank) for rank in range(N_BEST)},
            "mean rank": lambda run: f"{run.generalisers.ranks.mean():.2f}" if len(run.generalisers) else "",
            "mean rank by chance": lambda run: f"{CHANCE_RANK:g}",
            "spells": lambda run: len(run.generalisers.spells),
            "generations with one": lambda run: run.generalisers.spells.sum(),
            "longest spell": lambda run: run.generalisers.spells.max(initial=0),
            "distinct genotypes": lambda run: len(run.generalisers.stays),
            "longest stay among the five best": lambda run: run.generalisers.stays.max(initial=0),
            "found fully compositional in that stay": lambda run: _verdicts(run.generalisers),
            "longest line": lambda run: run.generalisers.longest_line,
        },
        results.analysed_runs,
    )


class Genotype(NamedTuple):
    """A genotype that was ever found fully compositional, by its number in its run."""

    run: AnalysedRun
    number: int


def genotype_table(results: Results) -> PlainTable[Genotype]:
    """Genotypes that were ever found fully compositional: their stays among the five best."""
    return PlainTable(
        {
            "condition": lambda genotype: genotype.run.condition,
            "seed": lambda genotype: genotype.run.seed,
            "first among the five best": lambda genotype: genotype.run.generalisers.first[genotype.number],
            "stay": lambda genotype: genotype.run.generalisers.stays[genotype.number],
            "found fully compositional": lambda genotype: genotype.run.generalisers.verdicts[genotype.number],
        },
        [Genotype(run, n) for run in results.analysed_runs for n in range(len(run.generalisers.stays))],
    )


def _verdicts(found: Generalisers) -> int:
    """In how many generations of the longest stay its genotype was found fully compositional."""
    return found.verdicts[found.stays.argmax()] if len(found) else 0
