"""How busy an experiment keeps the processors, and what starting a run costs: a grid of short runs.

python -m benchmarks.experiment [runs [generations]]

Occupation is told in two ways. Of the wall time: CPU time of all workers / (wall time x processes). That is
low on a machine that others use too, whatever the runner does; so the time in which processes were at work is
told as well: the sum of their durations / (wall time x processes).
"""

from __future__ import annotations

import csv
import io
import os
import platform
import subprocess
import sys
import tempfile
import time
from contextlib import redirect_stdout
from pathlib import Path

from evolution.child import reference
from evolution.experiments.plan import Plan
from evolution.experiments.plan_runner import run_plan_shown
from evolution.experiments.stage_times import FILE
from evolution.experiments.stages import evolve_run
from evolution.experiments.warm_workers import WarmStart
from evolution.experiments.workers import ColdStart, Job
from evolution.runs.meta import machine
from evolution.search.config import RunConfig
from evolution.search.settings import Settings

STARTS = 5
SHORT = Settings(population=5, elites=1, parents=2, generations=1, trials_per_area=1)


def main() -> None:
    """Measure and print."""
    given = [int(each) for each in sys.argv[1:]]
    n_runs, generations = [*given, *(200, 150)[len(given) :]]
    at_once = len(os.sched_getaffinity(0))
    about = machine()
    print(f"{about['processor']}, {about['cores']} cores, Python {platform.python_version()}")
    print(f"load {os.getloadavg()[0]:.1f} before the start, of which none is ours")
    with tempfile.TemporaryDirectory() as folder:
        _starts(Path(folder))
        _occupation(Path(folder), n_runs, generations, at_once)


def _starts(folder: Path) -> None:
    """A run of one generation of five genotypes is all start and end: in a new Python, and forked."""
    with WarmStart(folder / "log") as warm:
        for name, start in (("new Python process", ColdStart()), ("forked", warm)):
            # The first compiles, or loads the fork server.
            seconds = [_start_once(folder, name, i, start) for i in range(1 + STARTS)][1:]
            wall, cpu = (sorted(each)[STARTS // 2] for each in zip(*seconds, strict=True))
            print(f"one generation, {name}: {1e3 * wall:.0f} ms of wall time, {1e3 * cpu:.0f} ms of CPU")
    for what, code in (("Python alone", "0"), ("with NumPy", "import numpy"), ("with Numba", "import numba")):
        print(f"  for comparison, {what}: {1e3 * _cpu_of([sys.executable, '-c', code]):.0f} ms of CPU")


def _start_once(folder: Path, name: str, number: int, start: ColdStart | WarmStart) -> tuple[float, float]:
    """Wall and CPU time of one run, its process included [s]."""
    config, path = RunConfig(seed=number, settings=SHORT), folder / name / str(number)
    path.parent.mkdir(exist_ok=True)
    run = {"folder": str(path), "config": config.to_mapping()}
    worker = start.start(Job(name, "evolving", reference(evolve_run), run, path, folder / "log"))
    while (ended := worker.look()) is None:
        start.wait([worker], 0.001)
    assert ended.exit_code == 0, worker.sentence()
    return ended.wall, ended.cpu


def _cpu_of(command: list[str]) -> float:
    """CPU time of a command, the second time it is run [s]."""
    for _ in range(2):
        before = os.times()
        subprocess.run(command, check=True)
        after = os.times()
    return after.children_user + after.children_system - before.children_user - before.children_system


def _occupation(folder: Path, n_runs: int, generations: int, at_once: int) -> None:
    """Hundreds of short runs under the live table."""
    settings = Settings(generations=generations)
    plan = Plan(folder / "grid", tuple(RunConfig(seed=i, settings=settings) for i in range(n_runs)), False)
    own, began = time.process_time(), time.monotonic()
    with redirect_stdout(io.StringIO()):
        failures = run_plan_shown(plan, at_once)
    own, wall = time.process_time() - own, time.monotonic() - began
    assert not failures
    with (plan.folder / FILE).open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    cpu, busy = (sum(float(row[name]) for row in rows) for name in ("cpu_s", "wall_s"))
    print(f"{n_runs} runs of {generations} generations, {at_once} at a time: {wall:.1f} s")
    print(f"  processes at work {100 * busy / (wall * at_once):.1f} % of the time")
    print(f"  their CPU time is {100 * cpu / (wall * at_once):.1f} % of what {at_once} processors have")
    print(f"  the command itself took {own:.2f} s of CPU, {100 * own / cpu:.1f} % of its workers'")


if __name__ == "__main__":
    main()
