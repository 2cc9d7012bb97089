"""What `wordarm behaviour` does with an experiment: how compositional, partial and other agents do it."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from numpy.typing import ArrayLike
    from rich.table import Table

    from evolution.agents.classes import Sampling
    from evolution.figures.classes import Behaviours


def observe_classes(experiment: Path, sampling: Sampling, output: Path | None) -> None:
    """Observe a sample of every class run by run, then write and print.

    Args:
        experiment: Its folder, or that of one run.
        sampling: Which agents and trials.
        output: Folder for tables and figures; None to keep the observations beside each run only.

    Raises:
        ValueError: If no run can be observed; what is wrong with each is printed.
    """
    from rich.console import Console
    from rich.progress import track

    from evolution.agents.classes import observe
    from evolution.experiments.experiment import open_experiment
    from evolution.report.classes import behaviours_of, write_classes
    from evolution.results.tested_runs import name_of, unfinished
    from evolution.runs.lock import locked

    console, observed = Console(), []
    shown = {"console": console, "transient": True, "disable": not console.is_terminal}
    for run in track(open_experiment(experiment).all_runs, "runs observed", **shown):
        try:
            if reason := unfinished(run):
                raise ValueError(reason)
            with locked(run.path):
                observed.append((run, observe(run, sampling)))
        except (ValueError, OSError) as error:
            console.print(f"{name_of(run)}: left out, {error}", highlight=False, soft_wrap=True)
    if not observed:
        raise ValueError(f"no run in {experiment} can be observed, for the reasons above")
    if output is not None:
        behaviours = behaviours_of(observed)
        console.print(_table(behaviours))
        for path in write_classes(behaviours, sampling, output):
            print(path)


def _table(behaviours: Behaviours) -> Table:
    """Object word before sight, action word after it, and success intact and with the harmless lesions."""
    from rich.table import Table

    from evolution.agents.lesions import LESIONS
    from evolution.figures.classes import SHORT
    from evolution.results.wording import TITLES

    table = Table(
        "", "agents\n(runs)", "object\nbefore", "action\nafter", "intact",
        "action\nsilenced\nbefore", "object\nsilenced\nafter",
        title="share of variance explained before and after first sight; success, experienced",
    )  # fmt: skip
    places = [1 + i for i, each in enumerate(LESIONS) if each.harmless and each.manner == "silenced"]
    for condition, classes in behaviours.items():
        table.add_row(TITLES[condition])
        for kind, behaviour in classes.items():
            if len(behaviour.seeds):
                success = behaviour.success(known=True).mean(axis=0)
                values = (behaviour.windows[:, 0, 0], behaviour.windows[:, 1, 1], *success[[0, *places]])
                shown = [_percent(value) for value in values]
            else:
                shown = ["-"] * 5
            counts = f"{int(behaviour.agents.sum())} ({len(behaviour.seeds)})"
            table.add_row(f"  {SHORT[kind]}", counts, *shown)
        table.add_section()
    return table


def _percent(values: ArrayLike) -> str:
    """The mean of what is known of some values, or a stroke."""
    import numpy as np

    found = np.atleast_1d(values)[np.isfinite(np.atleast_1d(values))]
    return f"{100 * found.mean():.0f} %" if len(found) else "-"
