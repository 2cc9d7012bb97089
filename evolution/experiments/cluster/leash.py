"""A job's process on a worker's machine, which ends with the worker.

The worker holds the other end of our standard input. However it dies, the kernel closes that end; the job is
then told to stop, in good order and with a checkpoint, and gives the run free for whoever goes on with it.
"""

from __future__ import annotations

import os
import signal
import sys
import threading
import time
from collections.abc import Mapping
from typing import Any, Final

from evolution.child import perform

PATIENCE: Final = 30.0  # [s] for stopping in good order


def perform_on_a_leash(function: str, arguments: Mapping[str, Any]) -> int:
    """Call a function by its reference; its exit code."""
    threading.Thread(target=_end_with_the_worker, daemon=True).start()
    return perform(function, arguments)


def _end_with_the_worker() -> None:
    """Wait until standard input is closed, then stop."""
    while os.read(sys.stdin.fileno(), 1):
        pass
    os.kill(os.getpid(), signal.SIGTERM)
    time.sleep(PATIENCE)
    os._exit(128 + signal.SIGTERM)
