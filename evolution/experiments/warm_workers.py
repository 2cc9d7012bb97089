"""Workers that start in hundredths of a second: forked by a process that has loaded everything already."""

from __future__ import annotations

import json
import os
import select
import signal
import socket
import subprocess
import time
from collections.abc import Iterable
from contextlib import suppress
from pathlib import Path
from types import TracebackType
from typing import Any

from arm2d.files import handle_to_append
from evolution.child import calling, reference
from evolution.experiments.fork_server import LARGEST_MESSAGE, fork_workers
from evolution.experiments.workers import LOST, Ended, Job, Worker
from evolution.runs.storage import make_folder


class WarmStart:
    """Starts jobs through a fork server, which itself is started with the first one, and again if it dies.

    Use it as a context manager. When it is left, the server ends; workers still there go on.

    Attributes:
        log: Where a server that cannot start leaves its last words.
    """

    def __init__(self, log: Path) -> None:
        self.log = log
        self._server: _Server | None = None

    def __enter__(self) -> WarmStart:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._server:
            self._server.close()

    def start(self, job: Job) -> WarmWorker:
        """The worker of a job.

        Raises:
            OSError: If its log cannot be written, or no process can be started.
        """
        for _ in range(2):
            if self._server is None or self._server.gone:
                self._server = _Server(self.log)
            try:
                return WarmWorker(job, self._server)
            except ConnectionError:
                continue  # it was killed just now
        raise OSError(f"no worker can be started: its server ends at once; its last words are in {self.log}")

    @staticmethod
    def wait(workers: Iterable[Worker], seconds: float) -> None:
        """Return when a worker ends, or after some time."""
        ends = [each.pidfd for each in workers if isinstance(each, WarmWorker)]
        select.select(ends, [], [], seconds) if len(ends) < 1000 else time.sleep(seconds)


class WarmWorker(Worker):
    """A forked worker.

    Raises:
        ConnectionError: If the server is gone.
        OSError: If its log cannot be written.
    """

    def __init__(self, job: Job, server: _Server) -> None:
        self._server, self._over = server, False
        super().__init__(job)

    def _begin(self) -> None:
        self.pid, self.pidfd = self._server.fork(self.job)

    def look(self) -> Ended | None:
        """How it ended; None while it is at work, and for whoever asks again."""
        if self._over or not select.select([self.pidfd], [], [], 0)[0]:
            return None
        self._over = True
        os.close(self.pidfd)
        wall = time.monotonic() - self._began
        end = self._server.end_of(self.pid)
        if end is None:
            return Ended(self.job, LOST, wall, 0.0, 0.0)
        return Ended(self.job, end["status"], wall, end["cpu"], end["peak"])

    def _signal(self, number: signal.Signals) -> None:
        with suppress(ProcessLookupError):  # it ended by itself
            signal.pidfd_send_signal(self.pidfd, number)

    def kill(self) -> None:
        """End it at once; its files are whole at any moment."""
        if not self._over:
            self._signal(signal.SIGKILL)
            select.select([self.pidfd], [], [])
            self._over = True
            os.close(self.pidfd)


class _Server:
    """The fork server, seen from here."""

    def __init__(self, log: Path) -> None:
        make_folder(log.parent)
        self._socket, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        with theirs, os.fdopen(handle_to_append(log), "ab") as output:
            self._process = subprocess.Popen(  # noqa: S603 - our own program
                calling(reference(fork_workers), {"descriptor": theirs.fileno()}),
                stdin=subprocess.DEVNULL,
                stdout=output,
                stderr=subprocess.STDOUT,
                pass_fds=[theirs.fileno()],
                process_group=0,
                env={**os.environ, **{f"{each}_NUM_THREADS": "1" for each in ("OPENBLAS", "OMP", "MKL")}},
            )
        self.gone = False
        self._ends: dict[int, dict[str, Any]] = {}
        self._ready = False

    def fork(self, job: Job) -> tuple[int, int]:
        """Number and pidfd of a worker; raises ConnectionError if the server is gone."""
        message = {"function": job.function, "arguments": job.arguments, "log": str(job.log)}
        try:
            self._socket.send(json.dumps(message).encode())
        except BrokenPipeError:
            self.gone = True
            raise
        while True:
            told, descriptors = self._receive()
            if told is None:
                raise ConnectionResetError
            if "started" in told:
                return told["started"], descriptors[0]

    def end_of(self, pid: int) -> dict[str, Any] | None:
        """How a worker that is no more has ended; None if the server was gone before it could tell."""
        while pid not in self._ends:
            if self._receive()[0] is None:
                return None
        return self._ends.pop(pid)

    def close(self) -> None:
        """Let it end."""
        self._socket.close()
        self._process.wait()

    def _receive(self) -> tuple[dict[str, Any] | None, list[int]]:
        """The next message and what came with it; None if the server is gone."""
        try:
            data, descriptors, _, _ = socket.recv_fds(self._socket, LARGEST_MESSAGE, 1)
        except ConnectionResetError:
            data, descriptors = b"", []
        if not data:
            self.gone = True
            return None, []
        told = json.loads(data)
        if "ended" in told:
            self._ends[told["ended"]] = told
        return told, descriptors
