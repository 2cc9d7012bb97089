"""The study as files: a row for each run, for each cell, for each comparison; one picture."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from math import comb
from pathlib import Path
from typing import Any, Final

import numpy as np

from evolution.figures.page import save_figure
from evolution.report.columns import PlainTable
from evolution.runs.storage import make_folder, write_atomically
from evolution.study.beyond.answers import sentences
from evolution.study.beyond.cells import NAME
from evolution.study.beyond.comparisons import Comparison, comparisons, verdict_of
from evolution.study.beyond.figure import cells_figure
from evolution.study.beyond.groups import Group, groups_of
from evolution.study.beyond.outcomes import OUTCOMES, UNDERSTOOD, Outcome
from evolution.study.beyond.rows import CellRun, write_rows
from evolution.study.declared.regression import SIGNIFICANT, estimate_columns

NOTHING: Final = "shows more or less than the paper's task"


def write_results(runs: Sequence[CellRun], folder: Path) -> tuple[list[Path], list[str]]:
    """Write what the runs measured by now say: paths, and a sentence for every verdict.

    Raises:
        ValueError: If there is no run.
        OSError: If a file cannot be written.
    """
    if not runs:
        raise ValueError("no run is measured yet; leave --now away to evolve them")
    make_folder(folder)
    groups = groups_of(runs)
    found = comparisons(groups)
    paths = [folder / f"{NAME}-{name}.csv" for name in ("runs", "cells", "comparisons")]
    write_rows(runs, paths[0])
    write_atomically(paths[1], cell_table(groups).to_csv().encode())
    write_atomically(paths[2], comparison_table(found).to_csv().encode())
    paths += save_figure(cells_figure(groups, found), folder / NAME)
    return paths, sentences(groups, found) or [_nothing(found)]


def _nothing(found: Sequence[Comparison]) -> str:
    """That nothing is shown, and whether anything could have been."""
    if not found:
        return "every cell needs two runs to be compared with the paper's task"
    said = f"none of {len(found)} comparisons {NOTHING}"
    fewest = min(
        2 / comb(len(each.group.runs) + len(each.paper.runs), len(each.paper.runs)) for each in found
    )
    return said if fewest * len(found) < SIGNIFICANT else f"{said}; of so few runs, none could"


def cell_table(groups: Iterable[Group]) -> PlainTable[Group]:
    """One row per cell and condition, with 95 % intervals over runs."""
    return PlainTable(
        {
            "cell": lambda group: group.cell.name,
            "condition": lambda group: group.runs[0].config.task.condition_name,
            "largest fitness": lambda group: f"{group.runs[0].config.task.largest_fitness:.4f}",
            "runs": lambda group: len(group.runs),
            **_of_outcomes(),
            "runs at the largest fitness": lambda group: sum(run.at_limit for run in group.runs),
            "median generation of the solved": _median_generation,
            "obey all experienced": lambda group: _mean(run.obeying / run.agents for run in group.runs),
            "runs with such agents": lambda group: group.obeying_runs,
            "understood, of these": lambda group: _share(group.of_obeying(group.held_out)),
            "success, experienced": lambda group: _success(group, of_held_out=False),
            "success, held out": lambda group: _success(group, of_held_out=True),
        },
        groups,
    )


def comparison_table(found: Sequence[Comparison]) -> PlainTable[Comparison]:
    """One row per cell, condition of the paper's task and outcome; understanding over what both hold out."""
    return PlainTable(
        {
            "cell": lambda each: each.group.cell.name,
            "condition": lambda each: str(each.paper.task),
            "outcome": lambda each: each.outcome.name,
            "runs": lambda each: len(each.group.runs),
            "runs of the paper's task": lambda each: len(each.paper.runs),
            "mean": lambda each: f"{each.means[0]:.4f}",
            "mean of the paper's task": lambda each: f"{each.means[1]:.4f}",
            **estimate_columns("difference", "low", "high", of=lambda each: each.difference),
            "p": lambda each: f"{each.p:.3g}",
            "after Holm": lambda each: f"{each.corrected:.3g}",
            "verdict": lambda each: each.verdict,
            "said of the cell": lambda each: verdict_of(each.group, each.outcome, found),
            "of those that obey": lambda each: _of_obeying(each, each.group),
            "of those that obey in the paper's task": lambda each: _of_obeying(each, each.paper),
        },
        found,
    )


def _of_obeying(each: Comparison, group: Group) -> str:
    """How many of the agents that obey understand: beside understanding, of the same instructions."""
    return _share(group.of_obeying(each.words)) if each.outcome == UNDERSTOOD else ""


def _of_outcomes() -> dict[str, Callable[[Group], Any]]:
    """Three columns for each outcome: value, low and high end."""
    columns: dict[str, Callable[[Group], Any]] = {}
    for outcome in OUTCOMES:
        columns |= _of_outcome(outcome)
    return columns


def _of_outcome(outcome: Outcome) -> dict[str, Callable[[Group], Any]]:
    names = (outcome.name, f"{outcome.name} low", f"{outcome.name} high")
    return estimate_columns(*names, of=lambda group: group.estimate(outcome))


def _median_generation(group: Group) -> int | str:
    first = [run.first_solved for run in group.runs if run.solved]
    return int(np.median(first)) if first else ""


def _success(group: Group, *, of_held_out: bool) -> str:
    """Mean success of late agents on experienced or on held-out instructions, over runs."""
    return _mean(
        float(
            np.mean(
                [share for word, share in run.successes.items() if (word in group.held_out) is of_held_out]
            )
        )
        for run in group.runs
    )


def _mean(values: Iterable[float]) -> str:
    """Over runs; nothing if no run can tell."""
    found = list(values)
    return _share(float(np.mean(found)) if found else np.nan)


def _share(value: float) -> str:
    return "" if np.isnan(value) else f"{value:.4f}"
