"""An experiment: a folder of run folders, one folder for each condition.

runs/<experiment>/<condition>/seed-0007/
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from arm2d import Condition, Readings
from evolution.folder import CONFIG, RunFolder
from evolution.postevaluation import progress
from evolution.storage import DamagedFileError


@dataclass(frozen=True)
class Experiment:
    """The runs of an experiment, by condition and in the order of their seeds."""

    path: Path
    runs: Mapping[Condition, tuple[RunFolder, ...]]

    @property
    def all_runs(self) -> tuple[RunFolder, ...]:
        """All runs, condition by condition."""
        return tuple(run for runs in self.runs.values() for run in runs)

    @property
    def readings(self) -> Readings:
        """The readings that all runs share; see `open_experiment`."""
        return self.all_runs[0].config.readings


@dataclass(frozen=True)
class RunState:
    """How far a run has come.

    Attributes:
        run: The run.
        generations: How many are in finished parts.
        evaluated: Parts post-evaluated, of `to_evaluate`.
        to_evaluate: Parts to be post-evaluated.
        damage: What is wrong with it, or nothing.
    """

    run: RunFolder
    generations: int
    evaluated: int
    to_evaluate: int
    damage: str = ""

    @property
    def finished(self) -> bool:
        """Whether evolution is over."""
        return self.generations >= self.run.config.settings.generations

    @property
    def complete(self) -> bool:
        """Whether it can be analysed whole."""
        return self.finished and self.evaluated == self.to_evaluate and not self.damage


def open_experiment(path: Path) -> Experiment:
    """The experiment in a folder; a single run's folder is an experiment of one.

    Raises:
        ValueError: If there is no run in it, or its runs took place in different worlds.
    """
    folders = (
        [path] if (path / CONFIG).is_file() else sorted(each.parent for each in path.glob(f"*/*/{CONFIG}"))
    )
    if not folders and (variants := sorted({each.parents[2].name for each in path.glob(f"*/*/*/{CONFIG}")})):
        raise ValueError(
            f"{path} holds {len(variants)} variants, which are looked at one by one; "
            f"give the folder of one, such as {path / variants[0]}"
        )
    if not folders:
        raise ValueError(
            f"{path} holds no runs; an experiment holds <condition>/seed-<seed>/{CONFIG}: "
            "give such a folder, or start one with: wordarm reproduce"
        )
    runs = sorted((RunFolder.open(each) for each in folders), key=lambda run: run.config.seed)
    worlds = {run.config.readings for run in runs}
    if len(worlds) > 1:
        raise ValueError(
            f"the runs in {path} took place under {len(worlds)} different readings; analyse them apart"
        )
    by_condition = {c: tuple(run for run in runs if run.config.condition is c) for c in Condition}
    return Experiment(path, {c: runs for c, runs in by_condition.items() if runs})


def state_of(run: RunFolder) -> RunState:
    """How far a run has come, damage included."""
    evaluated, to_evaluate = progress(run)
    try:
        spans = run.finished_spans()
        return RunState(run, spans[-1].stop if spans else 0, evaluated, to_evaluate)
    except DamagedFileError as error:
        return RunState(run, 0, evaluated, to_evaluate, str(error))
