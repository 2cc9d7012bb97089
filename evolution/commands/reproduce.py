"""`wordarm reproduce`: the whole paper from random genotypes to the report."""

from __future__ import annotations

import os
import time
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from tyro.conf import arg

from arm2d import Condition
from evolution.commands.evolve import INTERRUPTED, UncheckedReadings
from evolution.config import RunConfig
from evolution.settings import Settings

if TYPE_CHECKING:
    from evolution.jobs import Failure
    from evolution.reproduce import Plan

MOST_RUNS = 10_000


@dataclass(frozen=True)
class Reproduce:
    """Evolve and test runs of both conditions, then write tables, figures and the report.

    Repeat the command to go on; what is done is not done again. Ctrl-C loses nothing.
    """

    output: Path = Path("runs/paper")
    """Folder of the experiment."""

    runs: int = 10
    """Runs of each condition, with seeds from 1 on."""

    jobs: int | None = None
    """Processes at a time. By default as many as there are processors."""

    settings: Annotated[Settings, arg(name="")] = Settings()  # noqa: RUF009 - frozen

    preset: str = "default"
    """Readings to start from: default, or printed (the paper at its word); single ones can be set below."""

    readings: UncheckedReadings = field(default_factory=UncheckedReadings)

    @property
    def plan(self) -> Plan:
        """The runs that are asked for."""
        from evolution.reproduce import Plan

        if not 1 <= self.runs <= MOST_RUNS:
            raise ValueError(f"asked for {self.runs} runs of each condition; give 1 to {MOST_RUNS}")
        readings = self.readings.checked()
        configs = [
            RunConfig(condition, seed, self.settings, readings)
            for seed in range(1, self.runs + 1)
            for condition in Condition
        ]
        return Plan(self.output, tuple(configs))

    def run(self) -> int:
        """Reproduce; the exit code is 130 if it was stopped, 2 if a run was given up."""
        from evolution.lock import locked
        from evolution.storage import make_folder

        at_once = len(os.sched_getaffinity(0)) if self.jobs is None else self.jobs
        if at_once < 1:
            raise ValueError(f"asked for {at_once} processes at a time; there must be at least 1")
        plan, began = self.plan, time.monotonic()
        plan.check()
        make_folder(plan.folder)
        with locked(plan.folder):
            failures, stopped = _evolve_and_test(plan, at_once)
            if stopped:
                print("stopped; go on with the same command")
                return INTERRUPTED
            _analyse_and_report(plan.folder)
        _tell_times(plan.folder, time.monotonic() - began)
        for each in failures:
            print(f"{each.job.name}, given up while {each.job.stage}: {each.sentence}")
        return 2 if failures else 0


def _evolve_and_test(plan: Plan, at_once: int) -> tuple[tuple[Failure, ...], bool]:
    """Run all jobs under the live table: (those given up, whether it was stopped)."""
    from rich.console import Console

    from evolution.interrupt import StopRequest
    from evolution.jobs import Watcher
    from evolution.live_table import shown_table
    from evolution.reproduce import run_plan, watched_standings
    from evolution.stage_times import note_time

    console, at_work = Console(), set[str]()

    with (
        StopRequest() as stop,
        shown_table(console, lambda: watched_standings(plan, lambda: at_work), at_once) as show,
    ):

        def tick(jobs) -> None:
            at_work.clear()
            at_work.update(job.name for job in jobs)
            show()

        watcher = Watcher(
            on_tick=tick,
            on_end=lambda ended: note_time(plan.folder, ended),
            on_note=lambda note: console.print(note, highlight=False),
            wants_stop=lambda: stop.requested,
        )
        failures = run_plan(plan, at_once, watcher)
        at_work.clear()
        return failures, stop.requested


def _analyse_and_report(folder: Path) -> None:
    """Tables and figures into `results`, and the page; notes the time like that of a process."""
    import resource

    from evolution.stage_times import note_time
    from evolution.workers import Ended, Job

    wall, cpu = time.monotonic(), time.process_time()
    _write_everything(folder)
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    job = Job("all runs", "analysing", (), folder, folder)
    note_time(folder, Ended(job, 0, time.monotonic() - wall, time.process_time() - cpu, peak))


def _write_everything(folder: Path) -> None:
    from evolution.analysis import analyse
    from evolution.experiment import open_experiment
    from evolution.report import write_report
    from evolution.result_files import summary, write_results

    print("tables, figures and the report are being written", flush=True)
    results = analyse(open_experiment(folder))
    write_results(results, folder / "results")
    print(summary(results))
    print(write_report(results, folder / "report.html"))


def _tell_times(folder: Path, wall: float) -> None:
    """Where the time went."""
    from evolution.live_table import duration
    from evolution.stage_times import stage_times, time_lines

    print(f"this command took {duration(wall)}; all its processes so far:")
    for line in time_lines(stage_times(folder)):
        print(f"  {line}")
