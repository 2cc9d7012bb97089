"""A claim on a folder that other machines see: locks of a shared file system may not reach beyond one.

On NFS, Lustre or BeeGFS `flock` is, depending on how they are mounted, honoured by all machines, by one, or
refused. So whoever holds a folder's lock also keeps a lease beside it, a small file that is touched again and
again. Ages are told by the file server's clock alone.

    the lease is another machine's, touched lately     its holder is taken to be alive: in use
    the same, not touched for LAPSE                     its machine is taken to be dead: taken over
    the lease is of this machine, whose lock we hold    its process is dead: taken over
    the lease is dated in the future                    dated anew, and judged by whether it is touched again

A holder that cannot touch its lease, or finds it taken over, ends itself at once and writes no more.
"""

from __future__ import annotations

import json
import os
import socket
import sys
import tempfile
import threading
import time
import uuid
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import asdict, dataclass
from functools import cache
from pathlib import Path
from typing import Final

from arm2d.files import NoFileError, handle_of_new, read_with_status
from evolution.runs.folder import LEASE

RENEWAL: Final = 15.0  # [s] between two touches
LAPSE: Final = 90.0  # [s] after which others may take over
# Without a touch for so long [s], a holder ends itself: well before others may take over.
GIVE_UP: Final = LAPSE - 2 * RENEWAL
# A date so far ahead of the server's clock [s] is that of another clock.
TOLERANCE: Final = 1.0
# Whoever takes over looks again after this time [s], in case another did so in the same moment.
SETTLE: Final = 2.0
LONGEST: Final = 10_000  # [bytes]
# Exit code of a process that lost its lease; not 2, for it is nobody's mistake.
EXIT_CODE: Final = 75


class RunInUseError(ValueError):
    """Another process works on the run."""


@dataclass(frozen=True)
class Holder:
    """Who holds a lease.

    Attributes:
        process: Its number.
        host: Name of its machine, for people.
        kernel: Changes with every machine and every start of it.
        token: Differs from one holding to the next.
    """

    process: int
    host: str
    kernel: str
    token: str


@contextmanager
def leased(folder: Path, *, lock_held: bool, on_loss: Callable[[str], None] | None = None) -> Iterator[None]:
    """Hold the folder's lease, and keep touching it.

    Args:
        folder: What is claimed.
        lock_held: Whether we hold its lock, so that no other process of this machine can be alive.
        on_loss: Called in another thread with a sentence if the lease is lost; by default the process ends.

    Raises:
        RunInUseError: If a process of another machine holds it.
        OSError: If it cannot be written.
    """
    path = folder / LEASE
    mine = Holder(os.getpid(), socket.gethostname(), this_kernel(), uuid.uuid4().hex)
    _claim(path, mine, lock_held)
    released = threading.Event()
    renewing = threading.Thread(
        target=_renew, args=(path, mine, released, on_loss or _end_process), daemon=True
    )
    renewing.start()
    try:
        yield
    finally:
        released.set()
        renewing.join()
        with suppress(OSError):  # one that stays behind lapses
            if _read(path)[0] == mine:
                path.unlink()


def held_elsewhere(folder: Path) -> bool:
    """Whether a process of another machine seems to be at work; asked without writing anything."""
    try:
        holder, touched = _read(folder / LEASE)
    except OSError:  # no lease of ours
        return False
    # Nothing being written, the clock of the server is unknown; a date far from ours is no sign of life.
    return holder is not None and holder.kernel != this_kernel() and abs(time.time() - touched) < LAPSE


@cache
def this_kernel() -> str:
    """What tells this machine, since it was started, from all others."""
    try:
        return Path("/proc/sys/kernel/random/boot_id").read_text(encoding="ascii").strip()
    except OSError:
        return f"{socket.gethostname()}-{uuid.getnode():x}"


def _claim(path: Path, mine: Holder, lock_held: bool) -> None:
    """Write the lease, unless somebody else's is in force."""
    if _create(path, mine):
        return
    other, touched = _read(path)
    dead_here = lock_held and other is not None and other.kernel == mine.kernel
    age = _server_time(path.parent) - touched
    if age < -TOLERANCE:
        # A clock was set back: of this date no age can be told, of the present one it can.
        with suppress(OSError):
            os.utime(path, follow_symlinks=False)
    if not dead_here and age < LAPSE:
        raise _in_use(path.parent, other)
    temporary = _write_beside(path, mine)
    temporary.replace(path)
    if not dead_here:
        time.sleep(SETTLE)
        if (now := _read(path)[0]) != mine:
            raise _in_use(path.parent, now)


def _create(path: Path, mine: Holder) -> bool:
    """Write the lease if there is none, in one step that no other machine can share."""
    temporary = _write_beside(path, mine)
    try:
        os.link(temporary, path)
    except FileExistsError:
        return False
    finally:
        temporary.unlink()
    return True


def _write_beside(path: Path, mine: Holder) -> Path:
    """A file with the lease's content, to be linked or renamed."""
    temporary = path.with_name(f".{path.name}-{mine.token}.tmp")
    try:
        with os.fdopen(handle_of_new(temporary), "w", encoding="utf-8") as file:
            file.write(json.dumps(asdict(mine)) + "\n")
    except OSError as error:
        temporary.unlink(missing_ok=True)
        raise OSError(f"{path} cannot be written: {error.strerror}; put this right first") from None
    return temporary


def _read(path: Path) -> tuple[Holder | None, float]:
    """The holder, if it can be read, and when the lease was touched; opening it asks the file server anew."""
    try:
        data, status = read_with_status(path, LONGEST, links=False)
    except FileNotFoundError:
        return None, float("-inf")
    except NoFileError as error:
        raise OSError(f"{path} is no lease ({error}); remove it") from None
    try:
        return Holder(**json.loads(data)), status.st_mtime
    except (ValueError, TypeError, RecursionError):
        return None, status.st_mtime


def _server_time(folder: Path) -> float:
    """What the file server's clock shows."""
    with tempfile.TemporaryFile(dir=folder) as probe:
        probe.write(b".")
        probe.flush()
        os.fsync(probe.fileno())
        return os.fstat(probe.fileno()).st_mtime


def _in_use(folder: Path, other: Holder | None) -> RunInUseError:
    who = f"process {other.process} on {other.host}" if other else "a process on another machine"
    return RunInUseError(
        f"{who} works on {folder}, or did so less than {LAPSE:.0f} s ago; "
        "wait until it ends, or choose another folder"
    )


def _renew(path: Path, mine: Holder, released: threading.Event, on_loss: Callable[[str], None]) -> None:
    """Touch the lease until it is released, or lost."""
    touched = _now()
    while not released.wait(RENEWAL):
        with suppress(OSError):
            if (holder := _read(path)[0]) not in (mine, None):
                on_loss(f"{holder.host} has taken over {path.parent}; this process ends and writes no more")
                return
            os.utime(path, follow_symlinks=False)
            touched = _now()
        if _now() - touched > GIVE_UP:
            on_loss(f"{path} cannot be touched; this process ends before another machine takes over")
            return


def _now() -> float:
    """A clock that goes on while the machine sleeps, where there is one."""
    return time.clock_gettime(getattr(time, "CLOCK_BOOTTIME", time.CLOCK_MONOTONIC))


def _end_process(sentence: str) -> None:
    print(f"wordarm: {sentence}", file=sys.stderr, flush=True)
    os._exit(EXIT_CODE)
