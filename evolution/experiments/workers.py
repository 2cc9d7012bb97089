"""A job, the process of its own that does it, and what is learnt from that."""

from __future__ import annotations

import os
import signal
import subprocess
import time
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final

from arm2d.files import handle_to_append
from evolution.answers import DEVICE_LOST, SENTENCE_PREFIX
from evolution.child import calling
from evolution.runs.storage import make_folder

# The exit code of a process whose end nobody saw: its files tell how far it came.
LOST: Final = 255


@dataclass(frozen=True)
class Job:
    """A function to be called in a process of its own, which goes on where it was stopped.

    Attributes:
        name: Whose it is, for people.
        stage: What it does, for people.
        function: What is called, by its `evolution.child.reference`; it answers with an exit code.
        arguments: By name, as plain values: they reach the process as JSON.
        folder: Where it writes; files that appear there are its progress.
        log: What it prints is added to this file.
        runs: The names of all its runs, if it has several.
        on_device: The function that does the same for several runs on a device, if there is one: it is given
            the device's name and the folders of the runs.
    """

    name: str
    stage: str
    function: str
    arguments: Mapping[str, Any] = field(hash=False)
    folder: Path
    log: Path
    runs: tuple[str, ...] = ()
    on_device: str = ""

    @property
    def run_names(self) -> tuple[str, ...]:
        """Whose it is: one run's, or those of several."""
        return self.runs or (self.name,)


@dataclass(frozen=True)
class Ended:
    """A process that ended, for whatever reason.

    Attributes:
        job: What it was to do.
        exit_code: Its exit code; of one killed by a signal, minus its number.
        wall: How long it took [s].
        cpu: Processor time of it and its children [s].
        peak: Most memory it held [MB].
    """

    job: Job
    exit_code: int
    wall: float
    cpu: float
    peak: float

    @property
    def how(self) -> str:
        """How it ended, in words."""
        if self.exit_code == LOST:
            return "lost sight of"
        if self.exit_code == DEVICE_LOST:
            return "lost its device"
        if self.exit_code >= 0:
            return f"ended with exit code {self.exit_code}"
        try:
            name = signal.Signals(-self.exit_code).name
        except ValueError:
            name = f"signal {-self.exit_code}"
        return f"killed by {name}"


class Worker:
    """The process of a job, from its start to its end.

    Raises:
        OSError: If its log cannot be written or it cannot be started.
    """

    def __init__(self, job: Job) -> None:
        self.job = job
        self._told_to_stop = False
        make_folder(job.log.parent)
        with os.fdopen(handle_to_append(job.log), "ab") as log:
            self._log_start = log.tell()
        self._began = time.monotonic()
        self._begin()

    def _begin(self) -> None:
        """Start the process."""
        with os.fdopen(handle_to_append(self.job.log), "ab") as log:
            # A process group of its own: Ctrl-C reaches it through us, once, and in good order.
            self._process = subprocess.Popen(  # noqa: S603 - our own program
                calling(self.job.function, self.job.arguments),
                stdin=subprocess.DEVNULL,
                stdout=log,
                stderr=subprocess.STDOUT,
                process_group=0,
            )

    @property
    def begun(self) -> bool:
        """Whether it is at work already, rather than in a queue."""
        return True

    @property
    def told_to_stop(self) -> bool:
        """Whether `stop` was called."""
        return self._told_to_stop

    def look(self) -> Ended | None:
        """How it ended; None while it is at work, and for whoever asks again."""
        if self._process.returncode is not None:
            return None
        found, status, usage = os.wait4(self._process.pid, os.WNOHANG)
        if not found:
            return None
        self._process.returncode = os.waitstatus_to_exitcode(status)
        cpu = usage.ru_utime + usage.ru_stime
        wall = time.monotonic() - self._began
        return Ended(self.job, self._process.returncode, wall, cpu, usage.ru_maxrss / 1024)

    def stop(self) -> None:
        """Ask it once to stop: evolution does so after the generation at hand."""
        if not self._told_to_stop:
            self._told_to_stop = True
            self._signal(signal.SIGTERM)

    def _signal(self, number: signal.Signals) -> None:
        self._process.send_signal(number)

    def kill(self) -> None:
        """End it at once; its files are whole at any moment."""
        self._process.kill()
        self._process.wait()

    def sentence(self) -> str:
        """What it said of the bad input it met, or where to look."""
        with self.job.log.open("rb") as file:
            file.seek(self._log_start)
            lines = file.read().decode("utf-8", "replace").splitlines()
        said = [line.removeprefix(SENTENCE_PREFIX) for line in lines if line.startswith(SENTENCE_PREFIX)]
        return said[-1] if said else f"bad input, but no word of it; see {self.job.log}"


class ColdStart:
    """Starts each job as a new Python process."""

    @staticmethod
    def start(job: Job) -> Worker:
        """The worker of a job; raises as `Worker`."""
        return Worker(job)

    @staticmethod
    def wait(workers: Iterable[Worker], seconds: float) -> None:
        """Return after some time."""
        time.sleep(seconds)
