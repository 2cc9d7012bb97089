"""The way to a Dask scheduler: opened, lost, found again, and always with one sentence when it fails."""

from __future__ import annotations

import logging
import os
import time
import uuid
import warnings
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from types import TracebackType
from typing import Any, Final

from distributed import Client, Future
from distributed.versions import VersionMismatchWarning

from arm2d.files import handle_of_new
from evolution.experiments.cluster.agreement import Order, disagreement, fingerprint
from evolution.experiments.cluster.tasks import perform, stop_jobs
from evolution.experiments.workers import Job
from evolution.runs.storage import make_folder

ANSWER_TIME: Final = 10.0  # [s] for a scheduler to answer
RETRY_INTERVAL: Final = 5.0  # [s] between two attempts to find it again
PATIENCE: Final = 600.0  # [s] until a scheduler that went away is given up
WORKERS_INTERVAL: Final = 10.0  # [s] between two looks at how many workers there are


class Connection:
    """A client of a Dask cluster that outlives its scheduler; a context manager.

    Args:
        open_client: Opens a client, within so many seconds.
        where: The scheduler, for people.
        folder: Of the experiment, shared by all machines; made if need be.
        how_to_start_workers: Told to people while there is no worker.

    Raises:
        OSError: If the scheduler does not answer, or is gone for long.
        ValueError: If scheduler or workers cannot take part, with the reason.
    """

    def __init__(
        self, open_client: Callable[[float], Client], where: str, folder: Path, how_to_start_workers: str
    ) -> None:
        self.where, self.hint = where, how_to_start_workers
        self.on_note: Callable[[str], None] = lambda note: None
        self.order = Order(uuid.uuid4().hex, folder.resolve(), fingerprint())
        self.begun: set[str] = set()
        self._open_client = open_client
        self._client: Client | None = None
        self._gone_since: float | None = None
        self._looked_at = 0.0
        self._had_workers = True
        self._stopped = False
        self._sent_away: set[str] = set()

    def __enter__(self) -> Connection:
        logging.getLogger("distributed").setLevel(logging.CRITICAL)
        # Versions are compared by ourselves, in one sentence.
        warnings.filterwarnings("ignore", category=VersionMismatchWarning)
        try:
            self._open()
            make_folder(self.order.folder)
            os.close(handle_of_new(self.order.mark))
            self._examine()
        except BaseException:
            self._leave()
            raise
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._leave()

    def threads(self) -> int:
        """Jobs that can be at work at once, as things are; 0 without workers, or without scheduler."""
        try:
            return sum(self._running_client().nthreads().values())  # pyright: ignore - not a coroutine
        except (OSError, TimeoutError):
            return 0

    def alive(self) -> bool:
        """Whether the scheduler is there; if not, it is looked for, now and then."""
        if self._client and self._client.status == "running":
            if self._gone_since is not None:
                self._found_again()
            self._look_for_workers()
            return True
        if self._gone_since is None:
            self._gone_since = time.monotonic()
            self._looked_at = self._gone_since
            self.begun.clear()
            self.on_note(f"the scheduler at {self.where} is gone; waiting for it, Ctrl-C loses nothing")
        elif self._is_time(RETRY_INTERVAL) and not (self._client and self._client.status == "connecting"):
            self._open_again()
        return False

    def submit(self, job: Job, key: str, priority: int) -> Future:
        """The task of a job; raises OSError if the scheduler is gone."""
        return self._running_client().submit(
            perform, self.order, job, key, key=key, pure=False, priority=priority
        )

    def stop(self) -> None:
        """Tell all workers, once, to stop this call's jobs."""
        if not self._stopped:
            self._stopped = True
            self._run_on_workers(stop_jobs, self.order.token)

    def send_away(self, address: str, why: str) -> None:
        """Close a worker that came later and cannot take part, lest it swallow task after task.

        Raises:
            ValueError: If there is no other.
        """
        sentence = f"worker {address} {why}"
        client = self._running_client()
        is_new = address not in self._sent_away
        self._sent_away.add(address)
        there: Any = client.nthreads()
        if self._sent_away.issuperset(there):
            raise ValueError(f"{sentence}; there is no other worker")
        if is_new and address in there:
            self.on_note(f"{sentence}; it was sent away")
            client.retire_workers([address])

    def _running_client(self) -> Client:
        if self._client is None or self._client.status != "running":
            raise OSError(f"the scheduler at {self.where} is gone")
        return self._client

    def _open(self) -> None:
        try:
            self._client = self._open_client(ANSWER_TIME)
        except (OSError, TimeoutError):
            raise OSError(
                f"no scheduler answers at {self.where}; start one with: dask scheduler, "
                "or give the address that it printed"
            ) from None
        self._client.subscribe_topic(self.order.token, lambda event: self.begun.add(event[1]))

    def _open_again(self) -> None:
        """One attempt to find the scheduler again."""
        try:
            self._open()
        except OSError:
            if time.monotonic() - (self._gone_since or 0.0) > PATIENCE:
                raise OSError(
                    f"the scheduler at {self.where} has been gone for {PATIENCE / 60:.0f} minutes; "
                    "what was done is kept: start it, then repeat the command"
                ) from None

    def _found_again(self) -> None:
        self._gone_since = None
        self.begun.clear()
        self.on_note(f"the scheduler at {self.where} is back; unfinished jobs go on")

    def _look_for_workers(self) -> None:
        """Say so, once, when there are none."""
        if self._is_time(WORKERS_INTERVAL):
            has_workers = self.threads() > 0
            if self._had_workers and not has_workers:
                self.on_note(f"there is no worker at {self.where}; {self.hint}")
            self._had_workers = has_workers

    def _is_time(self, interval: float) -> bool:
        """Whether so much time has passed since this last said yes."""
        if time.monotonic() - self._looked_at < interval:
            return False
        self._looked_at = time.monotonic()
        return True

    def _examine(self) -> None:
        """Refuse a scheduler or workers that cannot take part, before anything is begun."""
        client = self._running_client()
        try:
            theirs: Any = client.run_on_scheduler(fingerprint)
        except Exception as error:
            raise ValueError(_cannot(f"the scheduler at {self.where}", error)) from None
        for name, wanted in self.order.fingerprint.items():
            if theirs[name] != wanted:
                raise ValueError(
                    f"the scheduler at {self.where} has {name} {theirs[name]}, where this command has "
                    f"{wanted}; install the same on both"
                )
        for address, why in self._run_on_workers(disagreement, self.order).items():
            if isinstance(why, Exception):
                raise ValueError(_cannot(f"worker {address}", why))
            if why:
                raise ValueError(f"worker {address} {why}")

    def _run_on_workers(self, function: Callable[..., Any], *arguments: Any) -> dict[str, Any]:
        """What a function gives on each worker; nothing from those that are gone."""
        try:
            return self._running_client().run(function, *arguments, on_error="return")  # pyright: ignore
        except (OSError, TimeoutError):
            return {}

    def _leave(self) -> None:
        """Close, so that nothing stays behind."""
        if self._client:
            with suppress(OSError, TimeoutError):
                self._client.close(timeout=ANSWER_TIME)
        self.order.mark.unlink(missing_ok=True)


def _cannot(who: str, error: Exception) -> str:
    return (
        f"{who} cannot run this version of wordarm ({type(error).__name__}: {error}); "
        "install the same there: pip install -c constraints.txt 'wordarm[cluster]'"
    )
