"""`wordarm reproduce`: the whole paper from random genotypes to the report."""

from __future__ import annotations

import time
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Final

from tyro.conf import arg

from arm2d import Condition
from evolution.answers import BAD_INPUT, INTERRUPTED
from evolution.commands.cluster_flags import ClusterFlags
from evolution.commands.evolve import FromPreset
from evolution.search.config import RunConfig
from evolution.search.settings import Settings

if TYPE_CHECKING:
    from evolution.experiments.jobs import Failure
    from evolution.experiments.plan import Plan
    from evolution.experiments.workers import Job
    from evolution.results.records import Results
    from evolution.runs.interrupt import StopRequest

MOST_RUNS: Final = 10_000


@dataclass(frozen=True, kw_only=True)
class Reproduce(FromPreset):
    """Evolve and test runs of both conditions, then write tables, figures and the report.

    Repeat the command to go on; what is done is not done again. Ctrl-C loses nothing.
    """

    output: Path = Path("runs/paper")
    """Folder of the experiment."""

    runs: int = 10
    """Runs of each condition, with seeds from 1 on."""

    jobs: int | None = None
    """Processes at a time. By default as many as there are processors."""

    device: str = "cpu"
    """What runs the trials: cpu, or cuda for a graphics card by NVIDIA, one of several as cuda:1 (extra gpu).
    The results are the same, to the bit."""

    dry_run: bool = False
    """With --slurm, show the script of its jobs; start nothing."""

    cluster: Annotated[ClusterFlags, arg(name="")] = ClusterFlags()  # noqa: RUF009 - frozen

    settings: Annotated[Settings, arg(name="")] = Settings()  # noqa: RUF009 - frozen

    @property
    def plan(self) -> Plan:
        """The runs that are asked for."""
        from evolution.experiments.plan import Plan

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
        """Reproduce; the exit code is 130 if it was stopped, 2 if a job was given up."""
        from rich.console import Console

        from evolution.experiments.device.jobs import check_device, device_shares
        from evolution.experiments.jobs import tell_failures
        from evolution.experiments.plan_runner import processes, run_plan_shown
        from evolution.runs.interrupt import StopRequest
        from evolution.runs.lock import locked
        from evolution.runs.storage import make_folder

        at_once = processes(self.jobs)
        self.cluster.check()
        plan, began, console = self.cluster.placed(self.plan), time.monotonic(), Console()
        plan.check()
        check_device(self.device, plan.configs)
        if self.dry_run:
            return self.cluster.show_script(plan.folder)
        with self.cluster.opened(plan.folder, console) as elsewhere:
            shares = device_shares(self.device, self.jobs, elsewhere.threads() if elsewhere else None)
            make_folder(plan.folder)
            with locked(plan.folder):
                with StopRequest() as stop:
                    at_once_there = elsewhere.threads() if elsewhere else at_once
                    failures = run_plan_shown(plan, at_once_there, stop, console, elsewhere, shares=shares)
                    tell_failures(failures)
                    results = None if stop.requested else _analyse(plan.folder)
                    if results and not stop.requested:
                        unseen = _look_at_agents(results, plan.folder, at_once, stop)
                        tell_failures(unseen)
                        failures += unseen
                    if results is None or stop.requested:
                        print("stopped; go on with the same command")
                        return INTERRUPTED
                _report(results, plan.folder)
        _tell_times(plan.folder, time.monotonic() - began)
        return BAD_INPUT if failures else 0


def _analyse(folder: Path) -> Results:
    """The results, their tables and figures written into `results`."""
    from evolution.experiments.experiment import open_experiment
    from evolution.experiments.stage_times import timed
    from evolution.report.files import summary, write_results
    from evolution.results.analysis import analyse

    print("analysing all runs", flush=True)
    with timed(folder, "analysing"):
        results = analyse(open_experiment(folder))
        write_results(results, folder / "results")
    print(summary(results), flush=True)
    return results


def _look_at_agents(results: Results, folder: Path, at_once: int, stop: StopRequest) -> tuple[Failure, ...]:
    """Trace and observe the best agent of each condition, and observe classes; the jobs given up."""
    from evolution.experiments.jobs import Overseer, run_jobs
    from evolution.experiments.stage_times import note_time

    if chains := _agent_chains(results, folder) + _class_chains(results, folder):
        print("tracing the best agents' ancestors, and what they and their classes do", flush=True)
    overseer = Overseer(
        on_end=lambda ended: note_time(folder, ended),
        on_note=lambda note: print(note, flush=True),
        wants_stop=lambda: stop.requested,
    )
    return run_jobs(chains, at_once, overseer)


def _report(results: Results, folder: Path) -> None:
    """The page."""
    from evolution.agents.classes import Sampling
    from evolution.experiments.stage_times import timed
    from evolution.report.classes import behaviours_kept, write_classes
    from evolution.report.page import write_report

    with timed(folder, "reporting"):
        behaviours, _ = behaviours_kept(results, Sampling())
        write_classes(behaviours, Sampling(), folder / "results")
        path = write_report(results, folder / "report.html")
    print(path, flush=True)


def _tell_times(folder: Path, wall: float) -> None:
    """Where the time went."""
    from evolution.experiments.live_table import duration
    from evolution.experiments.stage_times import stage_times, time_lines

    print(f"this command took {duration(wall)}; all its processes so far:")
    for line in time_lines(stage_times(folder)):
        print(f"  {line}")


def _agent_chains(results: Results, folder: Path) -> list[list[Job]]:
    """What is still to be drawn of the best agent of each condition: its ancestors, and how it does it."""
    from evolution.child import reference
    from evolution.experiments.plan import LOGS
    from evolution.experiments.workers import Job
    from evolution.results.notable import best_agent

    chains = []
    for condition, of_condition in results.conditions.items():
        if (agent := best_agent(of_condition)) is None:
            continue
        path, stem = agent.run.path, f"generation-{agent.generation:06d}-rank-{agent.rank}"
        name, log = f"{condition}, its best agent", folder / LOGS / f"{condition}-best-agent.log"
        which = {"folder": str(path), "generation": agent.generation, "rank": agent.rank}
        for function, stage, done in (
            (trace_ancestors, "tracing ancestors", path / "lineage" / f"{stem}.npz"),
            (observe_agent, "observing", path / "behaviour" / f"{stem}-behaviour.npz"),
        ):
            if not done.exists():
                chains.append([Job(name, stage, reference(function), which, path, log)])
    return chains


def _class_chains(results: Results, folder: Path) -> list[list[Job]]:
    """What is still to be observed of the classes of agents, run by run."""
    from evolution.agents.classes import Sampling, observation_path
    from evolution.agents.subtasks import AgentClass
    from evolution.child import reference
    from evolution.experiments.plan import LOGS
    from evolution.experiments.workers import Job

    chains = []
    for condition, of_condition in results.conditions.items():
        for index, run in enumerate(of_condition.runs):
            some = any(of_condition.members[kind][index] for kind in AgentClass)
            if some and not observation_path(run, Sampling()).exists():
                log = folder / LOGS / f"{condition}-seed-{run.config.seed:04d}.log"
                name, which = f"{condition}, seed {run.config.seed}", {"folder": str(run.path)}
                job = Job(name, "observing classes", reference(observe_classes), which, run.path, log)
                chains.append([job])
    return chains


def trace_ancestors(folder: str, generation: int, rank: int) -> int:
    """`wordarm lineage` of an agent, in a process of its own."""
    from evolution.commands.lineage import LineageCommand

    return LineageCommand(Path(folder), generation, rank).run()


def observe_agent(folder: str, generation: int, rank: int) -> int:
    """`wordarm behaviour` of an agent, in a process of its own."""
    from evolution.commands.behaviour import BehaviourCommand

    return BehaviourCommand(folder, generation=generation, rank=rank).run()


def observe_classes(folder: str) -> int:
    """`wordarm behaviour --classes` of a run, in a process of its own, without its figures."""
    from evolution.commands.behaviour import BehaviourCommand

    return BehaviourCommand(folder, classes=True, figures=False).run()
