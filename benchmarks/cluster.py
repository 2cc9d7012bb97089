"""What Dask costs: the same runs by the local runner and by a scheduler with workers on this machine.

python -m benchmarks.cluster [runs] [generations]

The two take turns (local, Dask, Dask, local), so that other load on the machine meets both. Processor time
counts every process that takes part: scheduler, worker, nanny and client too.
"""

from __future__ import annotations

import json
import resource
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import psutil

from evolution.experiments.cluster.address import connected
from evolution.experiments.cluster.running import RemoteStart
from evolution.experiments.plan import Plan
from evolution.experiments.plan_runner import processes, run_plan
from evolution.search.config import RunConfig
from evolution.search.settings import Settings

# CPU of a whole run of 6000 generations [s], as measured with `wordarm evolve` (README).
WHOLE_RUN = (52, 81)


@dataclass
class Cost:
    """Time that runs took, by the clock and by all processors [s]."""

    wall: float = 0.0
    cpu: float = 0.0


def start_dask(*arguments: str) -> subprocess.Popen:
    """Start one of Dask's processes, silently."""
    command = [sys.executable, "-m", "dask", *arguments]
    return subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


@contextmanager
def dask_processes(folder: Path, threads: int) -> Iterator[tuple[str, list[subprocess.Popen]]]:
    """A scheduler and one worker."""
    file = folder / "scheduler.json"
    where = ("--host=127.0.0.1", "--port=0", f"--scheduler-file={file}")
    started = [start_dask("scheduler", *where, "--no-dashboard")]
    try:
        while not file.exists() or not file.read_text().endswith("}"):
            time.sleep(0.1)
        how = (f"--nthreads={threads}", "--nworkers=1", "--no-dashboard", f"--local-directory={folder}")
        started.append(start_dask("worker", f"--scheduler-file={file}", *how))
        yield json.loads(file.read_text())["address"], started
    finally:
        for process in started:
            process.terminate()
        for process in started:
            process.wait()


def cpu_of(pids: list[int]) -> float:
    """Processor time of living processes, of those below them, and of all that these have waited for [s]."""
    total = 0.0
    for pid in pids:
        for process in (parent := psutil.Process(pid), *parent.children(recursive=True)):
            times = process.cpu_times()
            total += times.user + times.system + times.children_user + times.children_system
    return total


def own_cpu() -> float:
    """Processor time of this process and of those it has waited for [s]."""
    usages = [resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
    return sum(each.ru_utime + each.ru_stime for each in usages)


@contextmanager
def counted(cost: Cost, pids: list[int]) -> Iterator[None]:
    """Add what is spent meanwhile."""
    wall, cpu = time.perf_counter(), own_cpu() + cpu_of(pids)
    yield
    cost.wall += time.perf_counter() - wall
    cost.cpu += own_cpu() + cpu_of(pids) - cpu


def main() -> None:
    """Run and print."""
    n_runs, generations = (int(each) for each in (sys.argv[1:] + ["4", "600"][len(sys.argv) - 1 :]))
    settings = Settings(generations=generations)
    configs = tuple(RunConfig(seed=seed, settings=settings) for seed in range(1, n_runs + 1))
    at_once, local, remote = processes(None), Cost(), Cost()
    with tempfile.TemporaryDirectory() as name, dask_processes(Path(name), at_once) as (address, started):
        pids = [each.pid for each in started]
        with connected(address, Path(name)) as cluster:
            while not cluster.threads():
                time.sleep(0.1)
            warm = Plan(Path(name) / "warm", (RunConfig(settings=Settings(generations=1)),), False)
            run_plan(warm, 1)
            for i, which in enumerate(("local", "dask", "dask", "local")):
                plan = Plan(Path(name) / f"{i}-{which}", configs, False)
                if which == "local":
                    with counted(local, []):
                        assert run_plan(plan, at_once) == ()
                else:
                    with counted(remote, pids):
                        assert run_plan(plan, sys.maxsize, start=RemoteStart(cluster)) == ()
    tell(local, remote, 2 * n_runs, at_once)


def tell(local: Cost, remote: Cost, n_runs: int, at_once: int) -> None:
    """Print both, and what follows for whole runs."""
    for who, cost in (("local", local), ("Dask", remote)):
        print(
            f"{who:6}{3600 * n_runs / cost.wall:7.0f} runs per hour, {at_once} at a time;"
            f"{cost.cpu / n_runs:7.2f} s of CPU per run"
        )
    extra = (remote.cpu - local.cpu) / n_runs
    print(
        f"ratio: {local.wall / remote.wall:.3f} of the runs per hour, {remote.cpu / local.cpu:.3f} of the CPU"
    )
    low, high = (100 * extra / each for each in reversed(WHOLE_RUN))
    print(f"{extra:.2f} s of CPU more per run, which is {low:.1f} to {high:.1f} % of one of 6000 generations")


if __name__ == "__main__":
    main()
