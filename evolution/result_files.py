"""An analysed experiment as files: tables for people and programs, one compact archive, all figures."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable, Sequence
from pathlib import Path

import numpy as np

from evolution import published
from evolution.analysis import ConditionResults, Results, interval_of_mean
from evolution.figures import save_figure
from evolution.figures_paper import all_figures
from evolution.storage import make_folder, write_arrays, write_atomically
from evolution.subtasks import N_CATEGORIES, SUBTASKS, AgentClass


def write_results(results: Results, folder: Path) -> list[Path]:
    """Write everything into a folder; the paths, tables first."""
    make_folder(folder)
    tables = {
        "table-ii.csv": table_ii_rows(results),
        "runs.csv": run_rows(results),
        "transitions.csv": transition_rows(results),
        "tests.csv": test_rows(results),
    }
    paths = []
    for name, rows in tables.items():
        paths.append(folder / name)
        write_atomically(paths[-1], to_csv(rows).encode())
    paths.append(folder / "results.npz")
    write_arrays(paths[-1], arrays_of(results))
    for name, figure in all_figures(results).items():
        paths += save_figure(figure, folder / name)
    return paths


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
    yield ("condition", "seed", "plateau", "first generation that solved all trials", *kinds, *tops)
    for condition, each in results.conditions.items():
        shares = np.stack([each.share_in_top(name) for name in SUBTASKS], axis=1)
        for run, seed in enumerate(each.seeds):
            members = [int(each.members[kind][run]) for kind in AgentClass]
            first = int(each.first_solved[run])
            yield (
                str(condition), int(seed), f"{each.plateau[run]:.4f}", first if first >= 0 else "never",
                *members, *(f"{share:.4f}" for share in shares[run]),
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


def arrays_of(results: Results) -> dict[str, np.ndarray]:
    """The numbers behind the figures, condition by condition; all trials are out of 80."""
    arrays = {}
    for condition, each in results.conditions.items():
        for name, array in _condition_arrays(each).items():
            arrays[f"{condition}.{name}"] = array
    return arrays


def summary(results: Results) -> str:
    """The result in a few sentences."""
    sentences = []
    for condition, each in results.conditions.items():
        share = each.share_in_top("I")
        low, high = interval_of_mean(share) if len(share) else (0.0, 0.0)
        full = int((each.generalisers.sum(axis=1) > 0).sum())
        top = f"{100 * share.mean():.1f} % of the agents [{100 * low:.1f}, {100 * high:.1f}]"
        sentences.append(
            f"{condition}: {each.at_plateau} of {len(each.runs)} runs end at the largest fitness; {top} "
            f"are in category 10 of sub-task I; runs with fully compositional agents: {full}."
        )
    return "\n".join([*sentences, *results.missing])


def to_csv(rows: Iterable[Sequence[object]]) -> str:
    """Rows as comma-separated lines."""
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerows(rows)
    return text.getvalue()


def _condition_arrays(each: ConditionResults) -> dict[str, np.ndarray]:
    return {
        "instructions": np.array([str(instruction) for instruction in each.condition.instructions]),
        "seeds": each.seeds,
        "best": each.best.astype(np.float32),
        "first_solved": each.first_solved,
        "generations": each.generations,
        "successes": each.successes.astype(np.uint8),
    }
