"""`wordarm experiment` and `wordarm status`: all runs of an experiment file, and how far they have come."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Final

from tyro.conf import Positional, arg

from evolution.answers import BAD_INPUT, INTERRUPTED
from evolution.commands.cluster_flags import ClusterFlags

if TYPE_CHECKING:
    from evolution.experiments.plan import Plan
    from evolution.experiments.spec import ExperimentSpec
    from evolution.experiments.standing import Standing

MOST_ROWS: Final = 60
PIPE_WIDTH: Final = 200


@dataclass(frozen=True)
class ExperimentCommand:
    """Evolve all runs of an experiment file (docs/experiments.md), as many at a time as there are processors.

    Repeat the command to go on; what is done is not done again. Ctrl-C loses nothing.
    """

    file: Annotated[Positional[Path], arg(metavar="FILE")]
    """A TOML file with conditions, seeds, readings and settings; lists are grids."""

    output: Path | None = None
    """Folder of the experiment; goes before the file's."""

    jobs: int | None = None
    """Processes at a time. By default what the file says, or as many as there are processors."""

    seeds: str | None = None
    """Goes before the file's, such as 7 or 1-8 or 1,2,5-8."""

    generations: int | None = None
    """Goes before the file's."""

    dry_run: bool = False
    """List the runs and how long they will take, with --slurm also the script of its jobs; start nothing."""

    cluster: Annotated[ClusterFlags, arg(name="")] = ClusterFlags()  # noqa: RUF009 - frozen

    def run(self) -> int:
        """Evolve; the exit code is 130 if it was stopped, 2 if a run was given up."""
        from rich.console import Console

        from evolution.experiments.plan_runner import processes, run_plan_shown
        from evolution.runs.interrupt import StopRequest
        from evolution.runs.lock import locked
        from evolution.runs.storage import make_folder

        spec = self.spec
        self.cluster.check()
        plan, at_once, console = self.cluster.placed(spec.plan()), processes(spec.jobs), Console()
        plan.check()
        if self.dry_run:
            _list_runs(plan, spec, at_once)
            return self.cluster.show_script() if self.cluster.slurm else 0
        with self.cluster.opened(plan.folder, console) as elsewhere:
            make_folder(plan.folder)
            with locked(plan.folder), StopRequest() as stop:
                at_once_there = elsewhere.threads() if elsewhere else at_once
                failures = run_plan_shown(plan, at_once_there, stop, console, elsewhere)
        if stop.requested:
            print("stopped; go on with the same command")
            return INTERRUPTED
        for each in failures:
            print(f"{each.job.name}, given up while {each.job.stage}: {each.sentence}")
        done = sum(each.done for each in plan.standings())
        print(f"{done} of {len(plan.configs)} runs are done: {plan.folder}")
        return BAD_INPUT if failures else 0

    @property
    def spec(self) -> ExperimentSpec:
        """What file and flags ask for."""
        from evolution.experiments.grid import read_experiment
        from evolution.experiments.seeds import read_seeds
        from evolution.experiments.spec import check_size

        spec = read_experiment(self.file)
        if self.generations is not None:
            spec = spec.with_settings(generations=self.generations)
        if self.seeds is not None:
            spec = replace(spec, seeds=read_seeds(self.seeds.split(",")))
        spec = replace(
            spec, output=self.output or spec.output, jobs=spec.jobs if self.jobs is None else self.jobs
        )
        check_size(spec)
        return spec


@dataclass(frozen=True)
class Status:
    """Show how far the runs of an experiment have come; nothing is written, whoever else is at work."""

    path: Annotated[Positional[Path], arg(metavar="FOLDER")]
    """Experiment folder, with variants or without, or the folder of one run."""

    every_run: Annotated[bool, arg(name="all")] = False
    """A row for each run, however many there are; else more than 60 are summed up."""

    def run(self) -> int:
        """Read and print once."""
        from rich.console import Console

        from evolution.experiments.live_table import run_table
        from evolution.experiments.standing import pace_of
        from evolution.experiments.status import experiment_standings
        from evolution.runs.folder import RunFolder

        standings = experiment_standings(self.path)
        at_work = sum(each.at_work for each in standings.values())
        started = [RunFolder(path, each.config) for path, each in standings.items() if each.generations]
        most_rows = None if self.every_run else MOST_ROWS
        table = run_table(list(standings.values()), pace_of(started), max(at_work, 1), most_rows)
        console = Console()
        # A pipe has no width: nothing is to be cut there.
        console.print(table, width=None if console.is_terminal else PIPE_WIDTH)
        return 0


def _list_runs(plan: Plan, spec: ExperimentSpec, at_once: int) -> None:
    """Print every run with its time, and the whole."""
    from evolution.experiments.estimate import expected_pace
    from evolution.experiments.live_table import duration
    from evolution.experiments.standing import time_left

    standings = plan.standings()
    pace, how = expected_pace(plan)
    width = len(str(len(standings)))
    for number, (config, each) in enumerate(zip(plan.configs, standings, strict=True), 1):
        left = "damaged" if each.damage else "done" if each.done else f"about {duration(pace.left(each))}"
        print(f"{number:{width}}  {plan.path(config)}  {config.settings.generations} generations, {left}")
    print(_count(spec, standings))
    print(f"about {duration(time_left(standings, pace, at_once))} in {at_once} processes, {how}")


def _count(spec: ExperimentSpec, standings: Sequence[Standing]) -> str:
    """How many runs there are, and why so many."""
    factors = [
        _plural(len(spec.worlds), "variant"),
        _plural(len(spec.conditions), "condition"),
        _plural(len(spec.seeds), "seed"),
    ]
    done = sum(each.done for each in standings)
    return f"{_plural(len(standings), 'run')}: {' x '.join(factors)}" + (f"; {done} done" if done else "")


def _plural(n: int, noun: str) -> str:
    return f"{n} {noun}" + ("" if n == 1 else "s")
