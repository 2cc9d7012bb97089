"""Behaviour by class as files, and for the report; everything is read from what `wordarm behaviour` kept."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

from matplotlib.figure import Figure

from arm2d import Condition
from evolution.agents.classes import Observation, Sampling, read_observation
from evolution.agents.subtasks import AgentClass
from evolution.figures.classes import Behaviours, classes_figure
from evolution.figures.fans import fans_figure
from evolution.figures.run import save_figure
from evolution.report.rows import to_csv
from evolution.results.classes import ClassBehaviour, class_behaviours, class_rows, run_class_rows
from evolution.results.records import Results
from evolution.runs.folder import RunFolder
from evolution.runs.storage import make_folder, write_atomically


def behaviours_of(observed: Sequence[tuple[RunFolder, Observation]]) -> Behaviours:
    """Each condition's classes."""
    by_condition = {
        c: [(run, each) for run, each in observed if run.config.condition is c] for c in Condition
    }
    return {c: class_behaviours(c, own) for c, own in by_condition.items() if own}


def behaviours_kept(results: Results, sampling: Sampling) -> tuple[Behaviours, list[str]]:
    """What was observed of an analysed experiment, and a sentence for each run with classes that was not."""
    observed, missing = [], []
    for each in results.conditions.values():
        for index, run in enumerate(each.runs):
            if any(each.members[kind][index] for kind in AgentClass):
                try:
                    observed.append((run, read_observation(run, sampling)))
                except ValueError as error:
                    missing.append(f"{run.config.condition}, seed {run.config.seed}: {error}")
    return behaviours_of(observed), missing


def class_figures(behaviours: Behaviours, sampling: Sampling) -> dict[str, Figure]:
    """The figures, by the name of their files; none without an agent of a class."""
    if not any(len(each.seeds) for each in _all(behaviours)):
        return {}
    figures = {"classes": classes_figure(behaviours)}
    for condition, classes in behaviours.items():
        if figure := fans_figure(condition, classes, sampling):
            figures[f"classes-trajectories-{condition}"] = figure
    return figures


def write_classes(behaviours: Behaviours, sampling: Sampling, folder: Path) -> list[Path]:
    """Write tables and figures; their paths."""
    make_folder(folder)
    paths = []
    tables = {
        "classes.csv": class_rows(_all(behaviours), sampling),
        "classes-runs.csv": run_class_rows(_all(behaviours)),
    }
    for name, rows in tables.items():
        paths.append(folder / name)
        write_atomically(paths[-1], to_csv(rows).encode())
    for name, figure in class_figures(behaviours, sampling).items():
        paths += save_figure(figure, folder / name)
    return paths


def _all(behaviours: Mapping[Condition, Mapping[AgentClass, ClassBehaviour]]) -> list[ClassBehaviour]:
    return [each for classes in behaviours.values() for each in classes.values()]
