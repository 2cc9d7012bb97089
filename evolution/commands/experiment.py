"""`wordarm experiment` and `wordarm status`: all runs of an experiment file, and how far they have come."""

from __future__ import annotations

import sys
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Final

from tyro.conf import Positional, arg

from arm2d import Condition
from evolution.answers import BAD_INPUT, INTERRUPTED
from evolution.commands.cluster_flags import ClusterFlags

if TYPE_CHECKING:
    from evolution.experiments.plan import Plan
    from evolution.experiments.spec import ExperimentSpec

MOST_ROWS: Final = 60


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

    device: str = "cpu"
    """What runs the trials: cpu, or cuda for a graphics card by NVIDIA, one of several as cuda:1 (extra gpu).
    The results are the same, to the bit."""

    dry_run: bool = False
    """List the variants and how long they take, with --slurm also the script of its jobs; start nothing."""

    cluster: Annotated[ClusterFlags, arg(name="")] = ClusterFlags()  # noqa: RUF009 - frozen

    def run(self) -> int:
        """Evolve; the exit code is 130 if it was stopped, 2 if a run was given up."""
        from rich.console import Console

        from arm2d.device.opening import PROCESSOR
        from evolution.experiments.device.jobs import check_device, device_shares
        from evolution.experiments.jobs import tell_failures
        from evolution.experiments.plan_runner import plan_lines, processes, run_plan_shown
        from evolution.runs.interrupt import StopRequest
        from evolution.runs.lock import locked
        from evolution.runs.storage import make_folder

        spec = self.spec
        self.cluster.check()
        plan, at_once, console = self.cluster.placed(spec.plan()), processes(spec.jobs), Console()
        plan.check()
        check_device(self.device, plan.configs)
        if self.dry_run:
            width = console.width if console.is_terminal else None
            print("\n".join([*plan_lines(plan, at_once, width), f"{plan.folder}: {_count(plan, spec)}"]))
            if any(not isinstance(each, Condition) for each in spec.conditions):
                print(f"conditions: {', '.join(str(each) for each in spec.conditions)}")
            if self.device != PROCESSOR:
                print(f"times are the processor's; how much faster {self.device} is stands in docs/speed.md")
            return self.cluster.show_script(plan.folder) if self.cluster.slurm else 0
        with self.cluster.opened(plan.folder, console) as elsewhere:
            shares = device_shares(self.device, spec.jobs, elsewhere.threads() if elsewhere else None)
            make_folder(plan.folder)
            with locked(plan.folder), StopRequest() as stop:
                at_once_there = elsewhere.threads() if elsewhere else at_once
                failures = run_plan_shown(plan, at_once_there, stop, console, elsewhere, shares=shares)
        if stop.requested:
            print("stopped; go on with the same command")
            return INTERRUPTED
        tell_failures(failures)
        done = sum(each.done for each in plan.standings())
        print(f"{done} of {len(plan.configs)} runs are done: {plan.folder}")
        return BAD_INPUT if failures else 0

    @property
    def spec(self) -> ExperimentSpec:
        """What file and flags ask for."""
        from evolution.experiments.grid import read_experiment
        from evolution.experiments.spec import check_size, read_seeds

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

    path: Positional[Path]
    """Experiment folder, with variants or without, or the folder of one run."""

    every_run: Annotated[bool, arg(name="all")] = False
    """A row for each run, however many there are; else more than 60 are summed up."""

    def run(self) -> int:
        """Read and print once."""
        from rich.console import Console

        from evolution.experiments.live_table import run_table
        from evolution.experiments.plan_file import experiment_standings
        from evolution.experiments.standing import pace_of
        from evolution.runs.folder import RunFolder

        standings, unreadable = experiment_standings(self.path)
        at_work = sum(each.at_work for each in standings.values())
        started = [RunFolder(path, each.config) for path, each in standings.items() if each.generations]
        most_rows = None if self.every_run else MOST_ROWS
        # A pipe has no width: nothing is to be cut there.
        console = Console(highlight=False, markup=False, soft_wrap=not sys.stdout.isatty())
        width = None if console.soft_wrap else console.width
        console.print(
            run_table(list(standings.values()), pace_of(started), max(at_work, 1), most_rows, width)
        )
        for sentence in unreadable:
            console.print(sentence, style="red")
        return 0


def _count(plan: Plan, spec: ExperimentSpec) -> str:
    """How many runs there are, and why so many."""
    factors = [
        _plural(len(spec.variants), "variant"),
        _plural(len(spec.conditions), "condition"),
        _plural(len(spec.seeds), "seed"),
    ]
    return f"{_plural(len(plan.configs), 'run')}, {' x '.join(factors)}"


def _plural(n: int, noun: str) -> str:
    return f"{n} {noun}" + ("" if n == 1 else "s")
