"""Carry out a plan: the one way in which reproductions, experiments and studies get their runs."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Sequence
from contextlib import nullcontext
from dataclasses import replace

from rich.console import Console

from evolution.experiments.jobs import Failure, Start, Watcher, run_jobs
from evolution.experiments.live_table import shown_table
from evolution.experiments.plan import LOGS, Plan, in_use
from evolution.experiments.plan_file import write_plan
from evolution.experiments.stage_times import note_time
from evolution.experiments.standing import Pace, Standing, pace_of
from evolution.experiments.warm_workers import WarmStart
from evolution.experiments.workers import Ended, Job
from evolution.runs.folder import RunFolder
from evolution.runs.interrupt import StopRequest
from evolution.search.config import RunConfig


def run_plan(
    plan: Plan, at_once: int, watcher: Watcher | None = None, start: Start | None = None
) -> tuple[Failure, ...]:
    """Evolve and test all runs as far as that is not done; the jobs that were given up.

    A run that another process works on is waited for.

    Args:
        plan: The runs.
        at_once: Processes at a time.
        watcher: Is told of what happens, and may stop it.
        start: How workers are started; by default forked by a process that has loaded everything.

    Raises:
        ValueError: If a folder holds another run.
        OSError: If nothing can be written.
    """
    watcher = watcher or Watcher()
    plan.check()
    if not (chains := plan.chains()):
        return ()
    free = replace(watcher, may_start=lambda job: watcher.may_start(job) and not in_use(job.folder))
    if start is not None:
        return run_jobs(chains, at_once, free, start)
    with WarmStart(plan.folder / LOGS / "workers.log") as warm:
        return run_jobs(chains, at_once, free, warm)


def run_plan_shown(
    plan: Plan,
    at_once: int,
    stop: StopRequest | None = None,
    console: Console | None = None,
    elsewhere: Start | None = None,
    on_end: Callable[[Ended], None] = lambda ended: None,
) -> tuple[Failure, ...]:
    """The same under the live table, plan and times being noted in the folder.

    Args:
        plan: The runs.
        at_once: Processes at a time; see `processes`.
        stop: An open one, if the caller has more to do when stopped; else Ctrl-C stops this alone.
        console: Where the table is shown.
        elsewhere: How workers are started on other machines, which then get all jobs, to queue them.
        on_end: Called for every process that ended, too.

    Returns:
        The jobs that were given up.

    Raises:
        ValueError, OSError: As `run_plan`.
    """
    plan.check()
    write_plan(plan)
    console, watch = console or Console(), PlanWatch(plan)
    with (
        StopRequest() if stop is None else nullcontext(stop) as asked,
        shown_table(console, watch.read, at_once) as show,
    ):

        def tick(jobs: Sequence[Job]) -> None:
            watch.at_work = {job.name for job in jobs}
            show()

        def end(ended: Ended) -> None:
            note_time(plan.folder, ended)
            watch.forget(ended.job.name)
            on_end(ended)

        watcher = Watcher(
            on_tick=tick,
            on_end=end,
            on_note=lambda note: console.print(note, highlight=False),
            wants_stop=lambda: asked.requested,
        )
        failures = run_plan(plan, sys.maxsize if elsewhere else at_once, watcher, elsewhere)
        watch.at_work = set()
    return failures


def processes(asked: int | None) -> int:
    """How many processes at a time: as many as asked for, else as there are processors for us.

    Raises:
        ValueError: If asked for none.
    """
    if asked is not None and asked < 1:
        raise ValueError(f"asked for {asked} processes at a time; there must be at least 1")
    return len(os.sched_getaffinity(0)) if asked is None else asked


class PlanWatch:
    """Standings of a plan's runs for the live table; only those that can have changed are read again.

    Attributes:
        at_work: Names of runs that have a process, which may not hold the run yet.
    """

    def __init__(self, plan: Plan) -> None:
        self.at_work: set[str] = set()
        self._plan = plan
        self._names = {config: plan.run_name(config) for config in plan.configs}
        self._known: dict[str, Standing] = {}

    def forget(self, name: str) -> None:
        """A process of this run has ended: what is known of it is old."""
        self._known.pop(name, None)

    def read(self) -> tuple[list[Standing], Pace]:
        """Standings and pace as they are now."""
        standings = [self._standing(config) for config in self._plan.configs]
        return standings, self._pace_now(standings)

    def _standing(self, config: RunConfig) -> Standing:
        name = self._names[config]
        known = self._known.get(name)
        if known is None or name in self.at_work or known.at_work:
            known = self._known[name] = self._plan.standing(config)
        return replace(known, at_work=True) if name in self.at_work else known

    def _pace_now(self, standings: Sequence[Standing]) -> Pace:
        """Told by the runs that have come furthest, which are enough."""
        telling = sorted((each for each in standings if each.generations), key=_progress)[-12:]
        return pace_of(RunFolder(self._plan.path(each.config), each.config) for each in telling)


def _progress(standing: Standing) -> tuple[bool, int, int]:
    """Runs at work tell today's pace best, then those that have come far."""
    return standing.at_work, standing.generations, standing.tested
