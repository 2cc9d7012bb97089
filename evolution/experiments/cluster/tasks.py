"""What runs inside a Dask worker: a task that watches over one job's process.

The process is one of its own, as on a single machine: the worker stays small and outlives a job that is
killed or runs out of memory, signals reach the job, and jobs of one worker do not share an interpreter lock.
"""

from __future__ import annotations

import os
import subprocess
import time
from dataclasses import dataclass
from typing import Final

from distributed import get_worker

from arm2d.files import handle_to_append
from evolution.child import calling, reference
from evolution.experiments.cluster.agreement import Order, disagreement
from evolution.experiments.cluster.leash import perform_on_a_leash
from evolution.experiments.workers import Ended, Job, Worker
from evolution.runs.lock import in_use

POLL_INTERVAL: Final = 0.1  # [s]
# Between two looks at a run that a process left over elsewhere still holds [s].
WAIT_INTERVAL: Final = 2.0
STOPPED: Final = 130

# Calls that this worker was asked to stop, by token.
_stopped: set[str] = set()


@dataclass(frozen=True)
class Outcome:
    """What a task answers.

    Attributes:
        address: Of the worker.
        ended: How the job's process ended; None if the worker cannot take part.
        sentence: What the job said of bad input, or why the worker cannot take part.
    """

    address: str
    ended: Ended | None
    sentence: str = ""


class LeashedWorker(Worker):
    """A job's process, which ends when this one does."""

    def _begin(self) -> None:
        job = {"function": self.job.function, "arguments": self.job.arguments}
        with os.fdopen(handle_to_append(self.job.log), "ab") as log:
            self._process = subprocess.Popen(  # noqa: S603 - our own program
                calling(reference(perform_on_a_leash), job),
                stdin=subprocess.PIPE,
                stdout=log,
                stderr=subprocess.STDOUT,
                process_group=0,
            )

    def look(self) -> Ended | None:
        """As `Worker.look`."""
        ended = super().look()
        if ended and self._process.stdin:
            self._process.stdin.close()
        return ended


def perform(order: Order, job: Job, key: str) -> Outcome:
    """Do a job here, once no other process holds its run.

    Args:
        order: The call that the job belongs to.
        job: What to do; its paths are those of the shared folder.
        key: Name of the task; told on the call's topic when the job begins.
    """
    worker = get_worker()
    if why := disagreement(order):
        return Outcome(worker.address, None, why)
    while order.token not in _stopped and in_use(job.folder):
        time.sleep(WAIT_INTERVAL)
    if order.token in _stopped:
        return Outcome(worker.address, Ended(job, STOPPED, 0.0, 0.0, 0.0))
    process = LeashedWorker(job)
    worker.log_event(order.token, key)
    while (ended := process.look()) is None:
        if order.token in _stopped:
            process.stop()
        time.sleep(POLL_INTERVAL)
    return Outcome(worker.address, ended, process.sentence() if ended.exit_code else "")


def stop_jobs(token: str) -> None:
    """Stop the jobs of a call that are at work here, and let no other begin."""
    _stopped.add(token)
