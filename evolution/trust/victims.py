"""The processes of an experiment, and their end.

All processes that a command starts belong to its session, workers that outlive it included; so a session of
one's own tells them from all others.
"""

from __future__ import annotations

import json
import os
import select
import signal
from contextlib import suppress
from pathlib import Path
from typing import Final

from evolution.child import reference
from evolution.experiments.fork_server import fork_workers

PROCESSES: Final = Path("/proc")


def members(session: int) -> list[int]:
    """The processes of a session, in the order of their numbers."""
    found = [int(each.name) for each in PROCESSES.iterdir() if each.name.isdecimal()]
    return sorted(each for each in found if session_of(each) == session)


def session_of(process: int) -> int:
    """The session of a process; 0 if there is no such process."""
    try:
        return os.getsid(process)
    except (ProcessLookupError, PermissionError):
        return 0


def names(process: int, folder: Path) -> bool:
    """Whether the command line of a process names a folder among the arguments of its call."""
    with suppress(OSError):
        return json.dumps(str(folder)).encode() in (PROCESSES / str(process) / "cmdline").read_bytes()
    return False


def starts_workers(process: int, parent: int) -> bool:
    """Whether a process is the one that forks the parent's workers; these share its command line."""
    with suppress(OSError):
        place = PROCESSES / str(process)
        forks = reference(fork_workers).encode() in (place / "cmdline").read_bytes().split(b"\0")
        after_name = (place / "stat").read_text(encoding="ascii", errors="replace").rpartition(")")[2]
        return forks and int(after_name.split()[1]) == parent
    return False


def kill(process: int, session: int) -> bool:
    """End a process by SIGKILL and wait until it is gone; False if it is not, or no longer, of the session.

    It is held by a descriptor before its session is looked at, so that no other process that was given its
    number in the meantime can be hit.
    """
    try:
        handle = os.pidfd_open(process)
    except OSError:
        return False
    try:
        if session_of(process) != session or select.select([handle], [], [], 0)[0]:
            return False
        signal.pidfd_send_signal(handle, signal.SIGKILL)
        select.select([handle], [], [])
        return True
    except ProcessLookupError:
        return False
    finally:
        os.close(handle)
