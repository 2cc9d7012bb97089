"""An analysed experiment as rows of tables for programs; the first row of each names its columns."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable, Sequence

import numpy as np

from evolution.agents.subtasks import N_CATEGORIES, SUBTASKS, AgentClass
from evolution.results import published
from evolution.results.generalisers import CHANCE_RANK
from evolution.results.records import Results
from evolution.search.settings import N_BEST


def table_ii_rows(results: Results) -> Iterable[Sequence[object]]:
    """Agents by category and sub-task, published and ours."""
    yield ("condition", "category", *(f"{whose} {name}" for name in SUBTASKS for whose in ("paper", "ours")))
    for condition, each in results.conditions.items():
        theirs = published.TABLE_II[condition]
        for category in range(N_CATEGORIES):
            pairs = zip(theirs[category], each.counts[category], strict=True)
            yield (str(condition), category, *(int(n) for pair in pairs for n in pair))


def run_rows(results: Results) -> Iterable[Sequence[object]]:
    """One row per run."""
    kinds = [str(kind) for kind in AgentClass]
    tops = [f"share in category 10, sub-task {name}" for name in SUBTASKS]
    yield (
        "condition", "seed", "plateau", "first generation that solved all trials", *kinds, *tops,
        "distinct genotypes", "longest stay among the five best",
    )  # fmt: skip
    for condition, each in results.conditions.items():
        shares = np.stack([each.share_in_top(name) for name in SUBTASKS], axis=1)
        for run, seed in enumerate(each.seeds):
            members = [int(each.members[kind][run]) for kind in AgentClass]
            first = int(each.first_solved[run])
            yield (
                str(condition), int(seed), f"{each.plateau[run]:.4f}", first if first >= 0 else "never",
                *members, *(f"{share:.4f}" for share in shares[run]),
                int(each.genotypes[run]), int(each.longest_stay[run]),
            )  # fmt: skip


def transition_rows(results: Results) -> Iterable[Sequence[object]]:
    """Agents that pass the transition tests, class by class."""
    yield ("condition", "class", "agents", "pass action", "pass object", "runs action", "runs object")
    for condition, each in results.conditions.items():
        for kind, outcome in each.transitions.items():
            yield (
                str(condition), str(kind), outcome.agents, outcome.action_passed, outcome.object_passed,
                outcome.runs_action, outcome.runs_object,
            )  # fmt: skip


def test_rows(results: Results) -> Iterable[Sequence[object]]:
    """Comparisons between the conditions: runs as the unit, and the paper's kind of test."""
    yield (
        "compared", "With-Indicate", "With-Ignore", "difference", "95 % low", "95 % high",
        "Mann-Whitney p", "permutation p", "Cliff's delta", "Wilcoxon p as published",
    )  # fmt: skip
    for name, each in results.comparisons.items():
        numbers = (
            *each.means, each.difference, *each.interval, each.mann_whitney_p, each.permutation_p,
            each.cliffs_delta, results.published_tests[name][1],
        )  # fmt: skip
        yield (name, *(f"{number:.4g}" for number in numbers))


def generaliser_rows(results: Results) -> Iterable[Sequence[object]]:
    """One row per run: where its fully compositional agents stand, and how long they last."""
    yield (
        "condition", "seed", "fully compositional agents", "most in a generation",
        *(f"at rank {rank}" for rank in range(N_BEST)), "mean rank", "mean rank by chance",
        "spells", "generations with one", "longest spell", "distinct genotypes",
        "longest stay among the five best",
        "found fully compositional in that stay", "longest line",
    )  # fmt: skip
    for condition, each in results.conditions.items():
        for seed, found in zip(each.seeds, each.generalisers, strict=True):
            longest = int(found.stays.argmax()) if len(found) else None
            yield (
                str(condition), int(seed), len(found), int(found.counts.max(initial=0)),
                *map(int, found.by_rank),
                f"{found.ranks.mean():.2f}" if len(found) else "", f"{CHANCE_RANK:g}",
                len(found.spells), int(found.spells.sum()), int(found.spells.max(initial=0)),
                len(found.stays),
                int(found.stays.max(initial=0)), 0 if longest is None else int(found.verdicts[longest]),
                found.longest_line,
            )  # fmt: skip


def genotype_rows(results: Results) -> Iterable[Sequence[object]]:
    """One row per genotype that was ever found fully compositional: its stay among the five best."""
    yield ("condition", "seed", "first among the five best", "stay", "found fully compositional")
    for condition, each in results.conditions.items():
        for seed, found in zip(each.seeds, each.generalisers, strict=True):
            for row in zip(found.first, found.stays, found.verdicts, strict=True):
                yield (str(condition), int(seed), *map(int, row))


def to_csv(rows: Iterable[Sequence[object]]) -> str:
    """Rows as comma-separated lines."""
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerows(rows)
    return text.getvalue()
