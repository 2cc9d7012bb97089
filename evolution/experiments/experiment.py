"""An experiment: a folder of run folders, one folder for each condition.

runs/<experiment>/<condition>/seed-0007/
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path

from arm2d import Condition, Readings
from arm2d.tasks.task import papers_condition
from evolution.runs.folder import CONFIG, RunFolder
from evolution.search.config import RunConfig


@dataclass(frozen=True)
class Experiment:
    """The runs of an experiment, by condition and in the order of their seeds.

    Attributes:
        path: Its folder.
        runs: By condition.
        unreadable: A sentence for every run whose config.toml cannot be understood.
        copies: A sentence for every folder that holds a run which another one holds too.
    """

    path: Path
    runs: Mapping[Condition, tuple[RunFolder, ...]]
    unreadable: tuple[str, ...] = ()
    copies: tuple[str, ...] = ()

    @property
    def all_runs(self) -> tuple[RunFolder, ...]:
        """All runs, condition by condition."""
        return tuple(run for runs in self.runs.values() for run in runs)

    @property
    def absent(self) -> tuple[str, ...]:
        """A sentence for every condition that lacks seeds of the other."""
        seeds = {c: {run.config.seed for run in runs} for c, runs in self.runs.items()}
        every = set().union(*seeds.values())
        return tuple(
            f"{condition} has no run of seed {', '.join(map(str, sorted(every - own)))}, which the other "
            "condition has; start it with: wordarm evolve"
            for condition, own in seeds.items()
            if every - own
        )

    @property
    def readings(self) -> Readings:
        """The readings that all runs share; see `open_experiment`."""
        return self.all_runs[0].config.readings


def open_experiment(path: Path | str) -> Experiment:
    """The experiment in a folder; a single run's folder is an experiment of one.

    Raises:
        ValueError: If there is no readable run in it, or its runs took place under different readings.
    """
    path = Path(path)
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
    opened, unreadable = _opened(folders)
    runs, copies = _without_copies(opened)
    readings = {run.config.readings for run in runs}
    if len(readings) > 1:
        raise ValueError(
            f"the runs in {path} took place under {len(readings)} different readings; analyse them apart"
        )
    by_condition = {c: tuple(run for run in runs if run.config.condition is c) for c in Condition}
    shown = {c: runs for c, runs in by_condition.items() if runs}
    others = [run for run in runs if not isinstance(run.config.condition, Condition)]
    if not shown:
        papers_condition(others[0].config.condition, "this analysis")
    unreadable += [
        f"{run.path} is of the task {run.config.condition}, which is not analysed" for run in others
    ]
    return Experiment(path, shown, tuple(unreadable), tuple(copies))


def _opened(folders: Iterable[Path]) -> tuple[list[RunFolder], list[str]]:
    """The runs that can be opened, and what is wrong with the others.

    Raises:
        ValueError: If none can, with what is wrong with the first.
    """
    runs, unreadable = [], []
    for folder in folders:
        try:
            runs.append(RunFolder.open(folder))
        except ValueError as error:
            unreadable.append(str(error))
    if not runs:
        raise ValueError(unreadable[0])
    return runs, unreadable


def _without_copies(runs: Iterable[RunFolder]) -> tuple[list[RunFolder], list[str]]:
    """Every run once, and a sentence for each folder that holds one of them again.

    One configuration with one seed gives one result: counted twice, it would pass for two.
    """
    found: dict[RunConfig, RunFolder] = {}
    copies = []
    for run in sorted(runs, key=lambda run: (run.config.seed, not _has_its_own_name(run), run.path)):
        first = found.setdefault(run.config, run)
        if first is not run:
            copies.append(
                f"{run.path} holds the same run as {first.path} (configuration and seed), which is counted "
                "once; move the copy elsewhere"
            )
    return list(found.values()), copies


def _has_its_own_name(run: RunFolder) -> bool:
    """Whether a run lies where it was made, rather than where it was copied."""
    return run.path.name == f"seed-{run.config.seed:04d}" and run.path.parent.name == str(
        run.config.condition
    )
