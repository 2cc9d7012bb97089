"""A process that has loaded and compiled everything once, and forks a worker for every job it is sent.

Starting Python, loading Numba and reading machine code back takes a second; a fork takes a hundredth of
it. Spoken over a socket that keeps messages apart:

    to it       {"function": "...", "arguments": {...}, "log": "..."}
    from it     {"ready": true} once; {"started": pid} with a pidfd for every job;
                {"ended": pid, "status": ..., "cpu": [s], "peak": [MB]} for every worker that ended

It ends when the other side does; its workers go on.

Why not the standard library's forkserver: it starts workers as fast, but keeps their CPU time and memory to
itself, reports a worker that outlives it as ended, hands its own descriptors on and listens at a path.
"""

from __future__ import annotations

import gc
import json
import os
import select
import signal
import socket
import sys
import traceback
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final, NoReturn

from arm2d.files import handle_to_append
from evolution.child import perform

LARGEST_MESSAGE: Final = 200_000  # [bytes]


def fork_workers(descriptor: int) -> int:
    """Load, then fork until nobody asks any more.

    Args:
        descriptor: Our end of the socket.
    """
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    with socket.socket(fileno=descriptor) as client:
        _load()
        # What is there now stays: the collector need not touch it, so workers go on sharing its memory.
        gc.collect()
        gc.freeze()
        _tell(client, {"ready": True})
        _serve(client)
    return 0


def _load() -> None:
    """Compile or load all that the stages of a run need, by a generation of each condition."""
    import evolution.experiments.stages  # noqa: F401 - loaded for the workers
    from arm2d import Condition
    from evolution.search.config import RunConfig
    from evolution.search.evaluation import evaluate
    from evolution.search.population import first_population, next_population
    from evolution.search.scoring import score_population
    from evolution.search.settings import Settings

    for condition in Condition:
        config = RunConfig(condition, settings=Settings(population=5, elites=1, parents=2, trials_per_area=1))
        population = first_population(config)
        next_population(population, score_population(population, config), config)
        evaluate(population.genotypes[:1], condition, config.readings)


def _serve(client: socket.socket) -> None:
    """Fork for every message, tell of every end."""
    poller, workers = select.poll(), dict[int, int]()
    poller.register(client, select.POLLIN)
    while True:
        for descriptor, _ in poller.poll():
            if descriptor == client.fileno():
                if not (message := client.recv(LARGEST_MESSAGE)):
                    return
                pid, pidfd = _fork(client, json.loads(message))
                workers[pidfd] = pid
                poller.register(pidfd, select.POLLIN)
            else:
                poller.unregister(descriptor)
                os.close(descriptor)
                _tell(client, _ended(workers.pop(descriptor)))


def _fork(client: socket.socket, message: dict[str, Any]) -> tuple[int, int]:
    """A new worker's number and pidfd, which the client is sent too."""
    pid = os.fork()
    if not pid:
        _work(message["function"], message["arguments"], message["log"])
    pidfd = os.pidfd_open(pid)
    try:
        socket.send_fds(client, [json.dumps({"started": pid}).encode()], [pidfd])
    except BrokenPipeError:
        sys.exit()
    return pid, pidfd


def _ended(pid: int) -> dict[str, Any]:
    """What is to be told of a worker that ended."""
    _, status, usage = os.wait4(pid, 0)
    cpu, peak = usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024
    return {"ended": pid, "status": os.waitstatus_to_exitcode(status), "cpu": cpu, "peak": peak}


def _tell(client: socket.socket, message: dict[str, Any]) -> None:
    """Send a message; end if nobody listens."""
    try:
        client.send(json.dumps(message).encode())
    except BrokenPipeError:
        sys.exit()


def _work(function: str, arguments: Mapping[str, Any], log: str) -> NoReturn:
    """Be the worker: call a function, its output added to the log."""
    code = 1
    try:
        os.setpgid(0, 0)
        signal.signal(signal.SIGINT, signal.default_int_handler)
        output = handle_to_append(Path(log))
        os.dup2(output, 1)
        os.dup2(output, 2)
        # Also our end of the socket: whether the server lives is seen by its end.
        os.closerange(3, os.sysconf("SC_OPEN_MAX"))
        code = perform(function, arguments)
    except SystemExit as error:
        code = error.code if isinstance(error.code, int) else 1
    except BaseException:
        traceback.print_exc()
    finally:
        # Without a way back into the server's code, whatever happened.
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(code)
