"""Carry out a plan: the one way in which reproductions, experiments and studies get their runs."""

from __future__ import annotations

import math
import os
import sys
import time
from collections.abc import Callable, Sequence
from contextlib import nullcontext
from dataclasses import replace
from typing import TYPE_CHECKING, Final

from rich.console import Console

from evolution.experiments.jobs import Failure, Overseer, Start, run_jobs
from evolution.experiments.live_table import duration, shown_table
from evolution.experiments.plan import LOGS, Plan
from evolution.experiments.plan_file import write_plan
from evolution.experiments.stage_times import note_time
from evolution.experiments.standing import (
    TESTS_PER_EVOLUTION,
    Pace,
    Standing,
    pace_of,
    size_of,
    time_left,
)
from evolution.experiments.variants import Variant, told_apart
from evolution.experiments.warm_workers import WarmStart
from evolution.experiments.workers import Ended, Job
from evolution.runs.folder import GENERATIONS_PER_PART, RunFolder
from evolution.runs.interrupt import StopRequest
from evolution.runs.lock import in_use
from evolution.search.config import RunConfig
from evolution.search.population import first_population, next_population
from evolution.search.scoring import score_population

if TYPE_CHECKING:
    from evolution.experiments.device.jobs import DeviceShares

TRIED: Final = 5  # generations
# An evolved population takes that many times as long as a random one (python -m benchmarks.kernel).
EVOLVED: Final = 1.5


def run_plan(
    plan: Plan,
    at_once: int,
    overseer: Overseer | None = None,
    start: Start | None = None,
    shares: DeviceShares | None = None,
) -> tuple[Failure, ...]:
    """Evolve and test all runs as far as that is not done; the jobs that were given up.

    A run that another process works on is waited for.

    Args:
        plan: The runs.
        at_once: Processes at a time.
        overseer: Is told of what happens, and may stop it.
        start: How workers are started; by default forked by a process that has loaded everything.
        shares: How a device is shared, if one is to run the trials.

    Raises:
        ValueError: If a folder holds another run.
        OSError: If nothing can be written.
    """
    overseer = overseer or Overseer()
    plan.check()
    if not (chains := plan.chains()):
        return ()
    free = replace(overseer, may_start=lambda job: overseer.may_start(job) and not in_use(job.folder))
    if start is not None:
        return _run_chains(plan, chains, at_once, free, start, shares)
    with WarmStart(plan.folder / LOGS / "workers.log") as warm:
        return _run_chains(plan, chains, at_once, free, warm, shares)


def _run_chains(
    plan: Plan,
    chains: list[list[Job]],
    at_once: int,
    overseer: Overseer,
    start: Start,
    shares: DeviceShares | None,
) -> tuple[Failure, ...]:
    """Run the stages of a plan; on a device wave by wave, batches of runs first, then what follows them."""
    if shares is None:
        return run_jobs(chains, at_once, overseer, start)
    failures = ()
    for wave in shares.waves(chains):
        failures += run_jobs(shares.batches(wave, plan.folder), at_once, overseer, start)
        if overseer.wants_stop():
            break
        names = {chain[0].name for chain in wave}
        evolved = [chain for chain in plan.chains() if chain[0].name in names]
        failures += run_jobs(shares.later(evolved, plan.folder), at_once, overseer, start)
    return failures


def run_plan_shown(
    plan: Plan,
    at_once: int,
    stop: StopRequest | None = None,
    console: Console | None = None,
    elsewhere: Start | None = None,
    on_end: Callable[[Ended], None] = lambda ended: None,
    shares: DeviceShares | None = None,
) -> tuple[Failure, ...]:
    """The same under the live table, plan and times being noted in the folder.

    Args:
        plan: The runs.
        at_once: Processes at a time; see `processes`.
        stop: An open one, if the caller has more to do when stopped; else Ctrl-C stops this alone.
        console: Where the table is shown.
        elsewhere: How workers are started on other machines, which then get all jobs, to queue them.
        on_end: Called for every process that ended, too.
        shares: How a device is shared, if one is to run the trials; then as many processes as it says.

    Returns:
        The jobs that were given up.

    Raises:
        ValueError, OSError: As `run_plan`.
    """
    plan.check()
    write_plan(plan)
    at_once = shares.processes if shares else at_once
    # A process with a device advances all runs of its batch, which the time left is told by.
    shown = len(plan.configs) if shares else at_once
    console, watch = console or Console(), PlanWatch(plan)
    with (
        StopRequest() if stop is None else nullcontext(stop) as asked,
        shown_table(console, watch.read, shown) as show,
    ):

        def tick(jobs: Sequence[Job]) -> None:
            watch.at_work = {name for job in jobs for name in job.run_names}
            show()

        def end(ended: Ended) -> None:
            note_time(plan.folder, ended)
            for name in ended.job.run_names:
                watch.forget(name)
            on_end(ended)

        overseer = Overseer(
            on_tick=tick,
            on_end=end,
            on_note=lambda note: console.print(note, highlight=False),
            wants_stop=lambda: asked.requested,
        )
        failures = run_plan(plan, sys.maxsize if elsewhere else at_once, overseer, elsewhere, shares)
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


def expected_pace(plan: Plan) -> tuple[Pace, str]:
    """What a generation and a test will take, and in words how that is known."""
    pace = plan.pace()
    if not math.isnan(pace.generation):
        return pace, "by the pace of the runs so far"
    generation = EVOLVED * _trial_generation(plan.configs[0])
    test = TESTS_PER_EVOLUTION * GENERATIONS_PER_PART * generation / 2
    return Pace(generation, test), f"by {TRIED} random generations tried out, times {EVOLVED:g}"


def _trial_generation(config: RunConfig) -> float:
    """CPU time [s] of a generation of the paper's size, from a run's first ones, which are not kept."""
    population = first_population(config)
    score_population(population, config)  # compiles, or loads what was compiled
    began = time.process_time()
    for _ in range(TRIED):
        population = next_population(population, score_population(population, config), config)
    return (time.process_time() - began) / TRIED / size_of(config)


def plan_lines(plan: Plan, at_once: int, width: int | None = None) -> list[str]:
    """What a plan holds, a line for each variant, and how long it will take.

    Args:
        plan: The runs.
        at_once: Processes at a time.
        width: Characters in a line; by default names are not cut.
    """
    standings = plan.standings()
    pace, how = expected_pace(plan)
    groups: dict[Variant, list[Standing]] = {}
    for standing in standings:
        groups.setdefault(Variant.of(standing.config), []).append(standing)
    texts = {variant: _group_text(runs, pace) for variant, runs in groups.items()}
    room = width - 2 - max(map(len, texts.values())) if width else sys.maxsize
    names = told_apart([plan.variants[each] for each in groups], room)
    longest = max(map(len, names.values()))
    lines = [f"{names[plan.variants[variant]]:{longest}}  {text}" for variant, text in texts.items()]
    return [*lines, f"about {duration(time_left(standings, pace, at_once))} in {at_once} processes, {how}"]


def _group_text(runs: Sequence[Standing], pace: Pace) -> str:
    """The runs of a variant: how many, how long, and what is done of them."""
    left = [each for each in runs if not each.done and not each.damage]
    damaged = sum(bool(each.damage) for each in runs)
    parts = [f"{len(runs)} x {runs[0].config.settings.generations} generations"]
    if done := len(runs) - len(left) - damaged:
        parts.append(f"{done} done")
    if damaged:
        parts.append(f"{damaged} damaged")
    if left:
        parts.append(f"about {duration(sum(map(pace.left, left)))} in one process")
    return ", ".join(parts)
