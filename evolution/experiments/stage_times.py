"""Where the time goes: every process that ended is noted in times.csv, and summed up stage by stage."""

from __future__ import annotations

import csv
import os
import resource
import time
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from arm2d.files import NoFileError, handle_to_append, read_file
from evolution.experiments.workers import Ended

FILE: Final = "times.csv"
LARGEST: Final = 64 * 2**20  # [bytes], a million processes
COLUMNS: Final = ("stage", "run", "exit_code", "wall_s", "cpu_s", "peak_mb")


@dataclass(frozen=True)
class StageTime:
    """What a stage took, all runs together.

    Attributes:
        stage: Its name.
        processes: How many processes took part, restarts included.
        wall: The sum of their durations [s].
        cpu: Their processor time [s].
        peak: Most memory one of them held [MB].
    """

    stage: str
    processes: int
    wall: float
    cpu: float
    peak: float


def note_time(folder: Path, ended: Ended) -> None:
    """Add a process to an experiment's times.csv.

    Raises:
        OSError: If it cannot be written.
    """
    job = ended.job
    _note(folder, job.stage, job.name, ended.exit_code, ended.wall, ended.cpu, ended.peak)


def _note(folder: Path, stage: str, run: str, exit_code: int, wall: float, cpu: float, peak: float) -> None:
    """Add a line, below the heading."""
    path = folder / FILE
    new = not path.exists()
    with os.fdopen(handle_to_append(path), "a", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        if new:
            writer.writerow(COLUMNS)
        writer.writerow((stage, run, exit_code, f"{wall:.2f}", f"{cpu:.2f}", f"{peak:.0f}"))


@contextmanager
def timed(folder: Path, stage: str) -> Iterator[None]:
    """Note what this process does while it is open like a process of its own.

    Raises:
        OSError: As `note_time`.
    """
    wall, cpu = time.monotonic(), time.process_time()
    yield
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    _note(folder, stage, "all runs", 0, time.monotonic() - wall, time.process_time() - cpu, peak)


def stage_times(folder: Path) -> list[StageTime]:
    """The sums, in the order in which stages first ended; lines a crash left unfinished are passed over."""
    sums: dict[str, StageTime] = {}
    for stage, wall, cpu, peak in _rows(folder / FILE):
        old = sums.get(stage, StageTime(stage, 0, 0.0, 0.0, 0.0))
        sums[stage] = StageTime(stage, old.processes + 1, old.wall + wall, old.cpu + cpu, max(old.peak, peak))
    return list(sums.values())


def time_lines(times: Iterable[StageTime]) -> list[str]:
    """The same for people."""
    return [
        f"{each.stage}: {each.cpu:.0f} s of CPU in {each.processes} processes that took {each.wall:.0f} s; "
        f"at most {each.peak:.0f} MB each"
        for each in times
    ]


def _rows(path: Path) -> Iterable[tuple[str, float, float, float]]:
    """(stage, wall, cpu, peak) of every sound line."""
    try:
        text = read_file(path, LARGEST, links=False).decode("utf-8", "replace")
        lines = list(csv.reader(text.splitlines()))
    except (OSError, NoFileError, csv.Error):
        return
    for line in lines:
        try:
            stage, _, _, wall, cpu, peak = line
            yield stage, float(wall), float(cpu), float(peak)
        except ValueError:
            continue
