"""Jobs in processes of their own, so many at a time: one that dies is started again, the others undisturbed.

Jobs stand in chains, such as the stages of a run: each starts when the one before it is done.

    exit code 0         done
    exit code 2         bad input: its sentence is kept, its chain ends, the others go on
    anything else       it died (killed, out of memory): started again, at most three times without progress
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final, Protocol

from evolution.answers import BAD_INPUT
from evolution.experiments.workers import ColdStart, Ended, Job, Worker
from evolution.runs.folder import CHECKPOINT

MOST_RESTARTS: Final = 3  # without progress
POLL_INTERVAL: Final = 0.1  # [s]


@dataclass(frozen=True)
class Failure:
    """A job that was given up, and why in one sentence."""

    job: Job
    sentence: str

    def __str__(self) -> str:
        """As the user is told."""
        return f"{self.job.name}, given up while {self.job.stage}: {self.sentence}"


def tell_failures(failures: Iterable[Failure]) -> None:
    """Print a line for each, at once: what is made of the other runs may end in an error of its own."""
    for failure in failures:
        print(failure, flush=True)


@dataclass(frozen=True)
class Overseer:
    """What the runner of jobs tells its caller, and asks of it.

    Attributes:
        on_tick: Called often, with the jobs at work.
        on_end: Called for every process that ended.
        on_note: Called with a sentence when a job is started again.
        may_start: Asked before a job starts; one that may not is asked for again later.
        wants_stop: Asked often; if so, the jobs at work are told to stop and no other is started.
    """

    on_tick: Callable[[Sequence[Job]], None] = lambda jobs: None
    on_end: Callable[[Ended], None] = lambda ended: None
    on_note: Callable[[str], None] = lambda note: None
    may_start: Callable[[Job], bool] = lambda job: True
    wants_stop: Callable[[], bool] = lambda: False


class Start(Protocol):
    """A way to start workers and to wait for them."""

    def start(self, job: Job) -> Worker:
        """The worker of a job."""
        ...

    def wait(self, workers: Iterable[Worker], seconds: float) -> None:
        """Return after some time, or before, when a worker ends."""
        ...


def run_jobs(
    chains: Sequence[Sequence[Job]],
    at_once: int,
    overseer: Overseer | None = None,
    start: Start | None = None,
) -> tuple[Failure, ...]:
    """Run chains of jobs, `at_once` processes at a time; a chain that was begun goes before others.

    When asked to stop, all processes get SIGTERM and this returns once they have ended. When it is left by
    an exception, they are killed.

    Args:
        chains: The jobs.
        at_once: Processes at a time, at least 1.
        overseer: Is told of what happens, and may stop it.
        start: How workers are started; by default each as a new Python process.

    Returns:
        The jobs that were given up. Those that were stopped, or never started, are not among them.

    Raises:
        OSError: If a log cannot be written, or no process can be started.
    """
    waiting = [list(chain) for chain in chains if chain]
    runner = _Runner(waiting, overseer or Overseer(), start or ColdStart())
    with _none_left_behind(runner):
        while runner.workers or (runner.waiting and not runner.overseer.wants_stop()):
            _start_or_stop(runner, at_once)
            runner.overseer.on_tick([worker.job for worker, _ in runner.workers if worker.begun])
            runner.start.wait([worker for worker, _ in runner.workers], POLL_INTERVAL)
            _take_note_of_ends(runner)
    return tuple(runner.failures)


def finished_files(folder: Path) -> int:
    """Files of a run that are written once and for all; a run that gets on has ever more of them."""
    return sum(each.name != CHECKPOINT for each in folder.rglob("*.npz"))


@dataclass
class _Tally:
    """How often a job was started again, and how many files there were the last time."""

    restarts: int = 0
    files: int = 0


@dataclass
class _Runner:
    """The state of `run_jobs`: chains not at work, and workers with the jobs that follow."""

    waiting: list[list[Job]]
    overseer: Overseer
    start: Start
    workers: list[tuple[Worker, list[Job]]] = field(default_factory=list)
    tallies: dict[Job, _Tally] = field(default_factory=dict)
    failures: list[Failure] = field(default_factory=list)


def _start_or_stop(runner: _Runner, at_once: int) -> None:
    """Fill the free places, or tell all to stop."""
    if runner.overseer.wants_stop():
        for worker, _ in runner.workers:
            worker.stop()
        return
    for chain in list(runner.waiting):
        if len(runner.workers) < at_once and runner.overseer.may_start(chain[0]):
            runner.workers.append((runner.start.start(chain[0]), chain[1:]))
            runner.waiting.remove(chain)


def _take_note_of_ends(runner: _Runner) -> None:
    """Go on with the chains of processes that ended, start them again, or give them up."""
    for pair in list(runner.workers):
        worker, later = pair
        if ended := worker.look():
            runner.workers.remove(pair)
            runner.overseer.on_end(ended)
            if ended.exit_code == 0:
                runner.waiting[:0] = [later] if later else []
            elif not worker.told_to_stop:
                _start_again_or_give_up(runner, worker, later, ended)


def _start_again_or_give_up(runner: _Runner, worker: Worker, later: list[Job], ended: Ended) -> None:
    job = ended.job
    if ended.exit_code == BAD_INPUT:
        runner.failures.append(Failure(job, worker.sentence()))
    elif _deserves_another_start(runner, job):
        runner.overseer.on_note(f"{job.name}: {ended.how} while {job.stage}; started again")
        runner.waiting.insert(0, [job, *later])
    else:
        times = f"{ended.how}, {MOST_RESTARTS + 1} times without progress"
        runner.failures.append(Failure(job, f"{times}; its last words are in {job.log}"))


def _deserves_another_start(runner: _Runner, job: Job) -> bool:
    """Whether a job that died got on since it died last, or has tries left; counts this one."""
    tally, files = runner.tallies.setdefault(job, _Tally()), finished_files(job.folder)
    if files > tally.files:
        tally.restarts = 0
    tally.files = files
    tally.restarts += 1
    return tally.restarts <= MOST_RESTARTS


@contextmanager
def _none_left_behind(runner: _Runner) -> Iterator[None]:
    """Kill what is still at work when an exception ends it all."""
    try:
        yield
    finally:
        for worker, _ in runner.workers:
            worker.kill()
