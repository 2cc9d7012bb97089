"""Behaviour by class as files, and for the report; everything is read from what `wordarm behaviour` kept."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from arm2d import Condition
from evolution.agents.classes import Observation, Sampling, read_observation
from evolution.agents.subtasks import AgentClass
from evolution.figures.classes import Behaviours, classes_figure
from evolution.figures.fans import fans_figure, representatives
from evolution.figures.page import save_figure
from evolution.report.columns import PlainTable
from evolution.results.classes import ClassBehaviour, class_behaviours, measures
from evolution.results.records import Results
from evolution.results.statistics import mean_interval
from evolution.runs.folder import RunFolder
from evolution.runs.storage import make_folder, write_atomically
from evolution.search.randomness import Purpose, generator


def behaviours_of(observed: Sequence[tuple[RunFolder, Observation]]) -> Behaviours:
    """Each condition's classes."""
    by_condition = {c: [(run, own) for run, own in observed if run.config.condition is c] for c in Condition}
    return {c: class_behaviours(c, own) for c, own in by_condition.items() if own}


def behaviours_kept(results: Results, sampling: Sampling) -> tuple[Behaviours, list[str]]:
    """What was observed of an analysed experiment, and a sentence for each run with classes that was not."""
    observed, missing = [], []
    for found in results.conditions.values():
        for index, run in enumerate(found.runs):
            if any(found.members[kind][index] for kind in AgentClass):
                try:
                    observed.append((run, read_observation(run, sampling)))
                except ValueError as error:
                    missing.append(f"{run.config.condition}, seed {run.config.seed}: {error}")
    return behaviours_of(observed), missing


def class_figures(behaviours: Behaviours, sampling: Sampling) -> dict[str, Figure]:
    """The figures, by the name of their files; none without an agent of a class."""
    if not any(len(behaviour.seeds) for behaviour in _all(behaviours)):
        return {}
    figures = {"classes": classes_figure(behaviours)}
    for condition, classes in behaviours.items():
        if fans := representatives(condition, classes, sampling):
            figures[f"classes-trajectories-{condition}"] = fans_figure(condition, fans)
    return figures


def write_classes(behaviours: Behaviours, sampling: Sampling, folder: Path) -> list[Path]:
    """Write tables and figures; their paths."""
    make_folder(folder)
    paths = []
    tables = {
        "classes.csv": class_table(_all(behaviours), sampling),
        "classes-runs.csv": class_run_table(_all(behaviours)),
    }
    for name, table in tables.items():
        paths.append(folder / name)
        write_atomically(paths[-1], table.to_csv().encode())
    for name, figure in class_figures(behaviours, sampling).items():
        paths += save_figure(figure, folder / name)
    return paths


class Measured(NamedTuple):
    """One measure of one class, with its values in the runs that have one."""

    behaviour: ClassBehaviour
    name: str
    values: NDArray[np.float64]


def class_table(behaviours: Iterable[ClassBehaviour], sampling: Sampling) -> PlainTable[Measured]:
    """Conditions, classes and measures: mean over runs, their range, and its bootstrap interval."""

    def unless_none(
        number: Callable[[NDArray[np.float64]], float], least: int = 1
    ) -> Callable[[Measured], str]:
        return lambda row: f"{number(row.values):.4f}" if len(row.values) >= least else ""

    return PlainTable(
        {
            "condition": lambda row: row.behaviour.condition,
            "class": lambda row: row.behaviour.kind,
            "measure": lambda row: row.name,
            "runs": lambda row: len(row.values),
            "agents observed": lambda row: row.behaviour.agents.sum(),
            "agents in the class": lambda row: row.behaviour.members.sum(),
            "trials each": lambda row: 2 * sampling.per_area * 9,
            "mean over runs": unless_none(np.mean),
            "95 % low": unless_none(lambda values: _interval(values)[0], least=2),
            "95 % high": unless_none(lambda values: _interval(values)[1], least=2),
            "lowest run": unless_none(np.min),
            "highest run": unless_none(np.max),
        },
        [
            Measured(behaviour, name, values[np.isfinite(values)])
            for behaviour in behaviours
            for name, measure in measures().items()
            for values in [measure(behaviour)]
        ],
    )


class RunOfClass(NamedTuple):
    """A run that has agents of a class, by its number in the class's behaviour."""

    behaviour: ClassBehaviour
    number: int


def class_run_table(behaviours: Iterable[ClassBehaviour]) -> PlainTable[RunOfClass]:
    """Conditions, classes and runs, with every measure."""

    def value(measure: Callable[[ClassBehaviour], NDArray[np.float64]]) -> Callable[[RunOfClass], str]:
        return lambda run: _text(measure(run.behaviour)[run.number])

    return PlainTable(
        {
            "condition": lambda run: run.behaviour.condition,
            "class": lambda run: run.behaviour.kind,
            "seed": lambda run: run.behaviour.seeds[run.number],
            "agents observed": lambda run: run.behaviour.agents[run.number],
            "agents in the class": lambda run: run.behaviour.members[run.number],
            **{name: value(measure) for name, measure in measures().items()},
        },
        [RunOfClass(behaviour, n) for behaviour in behaviours for n in range(len(behaviour.seeds))],
    )


def _interval(values: NDArray[np.float64]) -> tuple[float, float]:
    return mean_interval(values, generator(0, Purpose.STATISTICS))


def _text(value: float) -> str:
    return f"{value:.4f}" if np.isfinite(value) else ""


def _all(behaviours: Mapping[Condition, Mapping[AgentClass, ClassBehaviour]]) -> list[ClassBehaviour]:
    return [behaviour for classes in behaviours.values() for behaviour in classes.values()]
