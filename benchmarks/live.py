"""`wordarm live`: how soon the page is there, and how many moments a second reach one viewer.

python -m benchmarks.live [seconds]
"""

from __future__ import annotations

import resource
import signal
import statistics
import subprocess
import sys
import time

from websockets.sync.client import connect

STARTS = 3
COMMAND = [sys.executable, "-m", "evolution", "live", "best-generaliser", "--port=0"]


def main() -> None:
    """Start it a few times, look on the last time, and print a table."""
    seconds = float(sys.argv[1]) if len(sys.argv) > 1 else 20.0
    starts = []
    for number in range(STARTS):
        began = time.perf_counter()
        server = subprocess.Popen(COMMAND, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        assert server.stdout is not None
        address = server.stdout.readline().split()[1]
        starts.append(time.perf_counter() - began)
        if number < STARTS - 1:
            ended(server)
    cpu_of_a_start = cpu_of_children() / (STARTS - 1)
    moments = looked_on(address, seconds)
    before = cpu_of_children()
    ended(server)
    cpu = cpu_of_children() - before - cpu_of_a_start
    print(f"from the command to the address: {statistics.median(starts):.1f} s on the clock")
    print(f"the same, with its end:          {cpu_of_a_start:.1f} s of CPU")
    print(f"moments to one viewer:           {moments / seconds:.1f} a second")
    print(f"a moment:                        {1000 * cpu / moments:.1f} ms of CPU")


def looked_on(address: str, seconds: float) -> int:
    """Moments that come in so many seconds."""
    moments, until = 0, time.perf_counter() + seconds
    with connect(address.replace("http", "ws", 1) + "socket", max_size=None) as socket:
        while time.perf_counter() < until:
            moments += isinstance(socket.recv(timeout=10), bytes)
    return moments


def ended(server: subprocess.Popen) -> None:
    """Wait for its end, as after Ctrl-C."""
    server.send_signal(signal.SIGINT)
    server.communicate(timeout=60)


def cpu_of_children() -> float:
    """CPU seconds of processes that have ended."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


if __name__ == "__main__":
    main()
