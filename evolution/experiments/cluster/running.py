"""Chains of jobs on a Dask cluster, by the rules of `evolution.experiments.jobs`."""

from __future__ import annotations

import signal
import sys
import time
import uuid
from collections.abc import Iterable, Sequence
from typing import Final

from distributed import Future, KilledWorker

from evolution.experiments.cluster.connection import Connection
from evolution.experiments.cluster.tasks import STOPPED, Outcome
from evolution.experiments.jobs import Failure, Overseer, run_jobs
from evolution.experiments.workers import Ended, Job, Worker

FETCH_TIME: Final = 5.0  # [s]


def run_jobs_on(
    connection: Connection, chains: Sequence[Sequence[Job]], overseer: Overseer | None = None
) -> tuple[Failure, ...]:
    """Run chains of jobs as `evolution.experiments.jobs.run_jobs` does, on whatever workers the cluster has.

    A worker that dies costs what its jobs had not yet written; they go on elsewhere. So does a scheduler: its
    tasks are handed out anew when it is back.

    Args:
        connection: To the cluster, open.
        chains: The jobs; all paths in them absolute.
        overseer: Is told of what happens, and may stop it.

    Returns:
        The jobs that were given up.

    Raises:
        OSError: If a log cannot be written, or the scheduler is gone for long.
        ValueError: If worker after worker cannot take part.
    """
    # All at once: Dask then knows how much there is to do, and can ask for more workers.
    return run_jobs(chains, sys.maxsize, overseer, RemoteStart(connection))


class RemoteStart:
    """Starts each job as a task."""

    def __init__(self, connection: Connection) -> None:
        self._connection = connection

    def threads(self) -> int:
        """Jobs that can be at work at once, as things are; at least 1."""
        return max(self._connection.threads(), 1)

    def start(self, job: Job) -> RemoteWorker:
        """The task of a job."""
        return RemoteWorker(job, self._connection)

    def wait(self, workers: Iterable[Worker], seconds: float) -> None:
        """Return after some time."""
        time.sleep(seconds)


class RemoteWorker(Worker):
    """A job's task; handed out anew whenever the cluster forgets it."""

    def __init__(self, job: Job, connection: Connection) -> None:
        self._connection = connection
        self._future: Future | None = None
        self._said = ""
        self._over = False
        super().__init__(job)

    def _begin(self) -> None:
        """Hand the task out. What was begun goes before what was not: later stages first."""
        self._key = f"{self.job.stage}-{self.job.name}-{uuid.uuid4().hex}"
        priority = int(any(self.job.folder.glob("parts/*.npz")))
        try:
            self._future = self._connection.submit(self.job, self._key, priority)
        except OSError:
            self._future = None

    @property
    def begun(self) -> bool:
        """As `Worker.begun`."""
        return self._key in self._connection.begun

    def look(self) -> Ended | None:
        """As `Worker.look`."""
        if self._over:
            return None
        ended = self._look()
        self._over = ended is not None
        return ended

    def _look(self) -> Ended | None:
        if not self._connection.alive():
            return self._end(STOPPED) if self.told_to_stop else None
        if self._future is None or self._future.status in ("lost", "cancelled"):
            if self.told_to_stop:
                return self._end(STOPPED)
            self._begin()
        elif self._future.status == "finished":
            return self._take(self._future)
        elif self._future.status == "error":
            return self._take_error(self._future)
        return None

    def _take(self, future: Future) -> Ended | None:
        """The task's answer."""
        try:
            outcome: Outcome = future.result(timeout=FETCH_TIME)
        except (OSError, TimeoutError):
            return None
        self._said = outcome.sentence
        if outcome.ended is None:
            self._connection.send_away(outcome.address, outcome.sentence)
            self._begin()
        return outcome.ended

    def _take_error(self, future: Future) -> Ended:
        """A task that Dask gave up: because it killed several workers, or could not be run."""
        error = future.exception(timeout=FETCH_TIME)
        self._said = f"{type(error).__name__}: {error}"
        return self._end(-signal.SIGKILL if isinstance(error, KilledWorker) else 1)

    def _end(self, exit_code: int) -> Ended:
        return Ended(self.job, exit_code, time.monotonic() - self._began, 0.0, 0.0)

    def _signal(self, number: signal.Signals) -> None:
        if not self.begun and self._future is not None:
            self._future.cancel()
        self._connection.stop()

    def kill(self) -> None:
        """Let it be stopped; nobody waits for it."""
        if not self._over:
            self.stop()

    def sentence(self) -> str:
        """As `Worker.sentence`."""
        return self._said or super().sentence()
