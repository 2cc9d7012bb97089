"""Where a run's time goes: CPU per generation, memory and disk of a real run in a temporary folder.

python benchmarks/run.py [generations]
"""

from __future__ import annotations

import functools
import resource
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

from evolution.runs import run
from evolution.runs.folder import RunFolder
from evolution.search import scoring
from evolution.search.config import RunConfig
from evolution.search.settings import Settings


class Clock:
    """CPU seconds spent in functions that are wrapped under a name."""

    def __init__(self) -> None:
        self.seconds: dict[str, float] = {}

    def wrap(self, home: object, function: str, name: str) -> None:
        """Count the time of `home.function` under `name` from now on."""
        inner: Callable = getattr(home, function)

        @functools.wraps(inner)
        def timed(*arguments, **options):
            began = time.process_time()
            result = inner(*arguments, **options)
            self.seconds[name] = self.seconds.get(name, 0.0) + time.process_time() - began
            return result

        setattr(home, function, timed)


def main() -> None:
    """Run and print."""
    generations = int(sys.argv[1]) if len(sys.argv) > 1 else 1000
    config = RunConfig(settings=Settings(generations=generations))
    with tempfile.TemporaryDirectory() as folder:
        # Compile, or load what was compiled, before the clock starts.
        run.evolve(Path(folder) / "warm", RunConfig(settings=Settings(generations=2)))
        clock = Clock()
        clock.wrap(scoring, "run_trials", "kernel")
        clock.wrap(scoring, "draw_trials", "drawing trials")
        clock.wrap(run, "next_population", "breeding")
        clock.wrap(RunFolder, "write_arrays", "writing")
        clock.wrap(run, "keep_champions", "champions")
        began, wall = time.process_time(), time.perf_counter()
        run.evolve(Path(folder) / "run", config)
        seconds, wall = time.process_time() - began, time.perf_counter() - wall
        disk = sum(each.stat().st_size for each in (Path(folder) / "run").rglob("*") if each.is_file())
    clock.seconds["the rest"] = seconds - sum(clock.seconds.values())
    print(f"{generations} generations: {seconds:.1f} s of CPU, {wall:.1f} s in all")
    for name, spent in clock.seconds.items():
        print(f"  {name:15}{1e3 * spent / generations:8.3f} ms of CPU per generation")
    print(f"memory {resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024:.0f} MB at most")
    print(f"disk {disk / 1e6:.2f} MB, {disk / generations * 6000 / 1e6:.1f} MB for 6000 generations")


if __name__ == "__main__":
    main()
