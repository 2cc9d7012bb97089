"""Trying faults: in copies of the tree, several at a time, each result written as soon as it is known."""

from __future__ import annotations

import csv
import os
import queue
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import asdict, dataclass, fields
from pathlib import Path
from typing import Final, TextIO

from scripts.faults import Fault

ROOT: Final = Path(__file__).parents[1]
LIMIT: Final = 900.0  # [s] in which some test has to end, on the busiest of machines
QUICK_CPU_LIMIT: Final = 25.0  # [s] of processor time for the same, of tests that are not called slow
SLOW_CPU_LIMIT: Final = 60.0
LOOK: Final = 1.0  # [s] from one look to the next
OPTIONS: Final = ("-x", "-p", "no:cacheprovider", "--tb=no")
# Where compiled code is kept, as the program itself has it; a warning says what is unusual.
ASK_FOLDER: Final = "from arm2d.cache import cache_folder; print(cache_folder() or '')"
# No function of another module has anything of these compiled into it.
NOT_COMPILED: Final = (
    "arm2d/network/controller.py",
    "arm2d/geometry.py",
    "arm2d/readings.py",
    "arm2d/reference.py",
    "arm2d/trials.py",
    "arm2d/worlds/*.py",
)
# Exit codes of pytest: all tests passed, or there were none of the kind that was asked for.
PASSED: Final = (0, 5)


@dataclass(frozen=True)
class Row:
    """What became of a fault, as it stands in the output.

    Attributes:
        path: The module.
        line: Of the fault.
        kind: What was done.
        before: The lines as they should be.
        after: With the fault.
        outcome: "noticed", "survived", or "too slow", which is noticed as well.
        seconds: Duration of the tests [s].
        seen_by: The test that failed.
    """

    path: str
    line: int
    kind: str
    before: str
    after: str
    outcome: str = ""
    seconds: str = ""
    seen_by: str = ""

    @property
    def what(self) -> tuple[str, ...]:
        """What tells it from all others, wherever its lines have moved to."""
        return self.path, self.kind, self.before, self.after


@dataclass(frozen=True)
class Mutant:
    """A fault of a module.

    Attributes:
        row: What will tell of it.
        fault: It.
        tests: Those that should notice it.
        nearest: Those that are asked first; none if all are few.
    """

    row: Row
    fault: Fault
    tests: tuple[str, ...]
    nearest: tuple[str, ...] = ()


class Copy:
    """A copy of the tree in which one fault after the other is tried.

    Args:
        place: An empty folder for the copy, its cache and its temporary files.
    """

    def __init__(self, place: Path) -> None:
        self._tree, self._place = place / "tree", place
        if shutil.which("git") is None:
            raise SystemExit("git, which lists the files to be copied, is not there: apt-get install git")
        listed = subprocess.run(
            ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"],  # noqa: S607
            cwd=ROOT,
            check=True,
            capture_output=True,
            text=True,
        )
        for name in filter(None, listed.stdout.split("\0")):
            target = self._tree / name
            target.parent.mkdir(parents=True, exist_ok=True)
            if (ROOT / name).is_file():
                shutil.copy2(ROOT / name, target)
        for name in ("home", "temporary"):
            (place / name).mkdir(mode=0o700)
        self._tried = 0
        self._compiled = self._cache_folder()

    def attempt(self, mutant: Mutant) -> tuple[str, float, str]:
        """Outcome, duration [s], and the test that failed, of its tests with a fault in the sources."""
        path = self._tree / mutant.row.path
        sound, stamp = path.read_bytes(), path.stat()
        path.write_bytes(mutant.fault.put_into(sound))
        # A date of its own, lest what was compiled of another fault be taken for this one's.
        self._tried += 1
        os.utime(path, (stamp.st_atime, stamp.st_mtime + 10 * self._tried))
        try:
            if any(Path(mutant.row.path).match(pattern) for pattern in NOT_COMPILED):
                self._take_over_what_was_compiled()
            return self._run_in_turn(mutant)
        finally:
            path.write_bytes(sound)
            os.utime(path, (stamp.st_atime, stamp.st_mtime))

    def _take_over_what_was_compiled(self) -> None:
        """Spare the compiling of functions that a fault does not reach; any change in arm2d asks for it."""
        folder = self._cache_folder()
        if self._compiled and folder:
            shutil.copytree(self._compiled, folder, dirs_exist_ok=True)

    def _cache_folder(self) -> str:
        """Where compiled code is kept of the tree as it is; nothing if nowhere."""
        command = [sys.executable, "-c", ASK_FOLDER]
        asked = subprocess.run(  # noqa: S603 - our own words
            command, cwd=self._tree, env=self._environment, capture_output=True, text=True, check=False
        )
        return asked.stdout.strip()

    def _run_in_turn(self, mutant: Mutant) -> tuple[str, float, str]:
        """The same, of the quick ones among the nearest tests, then of all quick ones, then of the slow."""
        turns = [("-m", "not slow", *mutant.tests), ("-m", "slow", *mutant.tests)]
        if mutant.nearest:
            turns.insert(0, ("-m", "not slow", *mutant.nearest))
        outcome, seconds, failed = "survived", 0.0, ""
        for asked in turns:
            if outcome == "survived":
                outcome, taken, failed = self.run(asked)
                seconds += taken
        return outcome, seconds, failed

    def run(self, asked: Sequence[str]) -> tuple[str, float, str]:
        """The same, of tests in the tree as it is."""
        began = time.monotonic()
        with (self._place / "said").open("w+", encoding="utf-8") as said:
            process = subprocess.Popen(  # noqa: S603 - our own words
                [sys.executable, "-m", "pytest", *OPTIONS, *asked],
                cwd=self._tree,
                env=self._environment,
                stdout=said,
                stderr=subprocess.STDOUT,
                start_new_session=True,
            )
            try:
                code = self._exit_code(process, QUICK_CPU_LIMIT if "not slow" in asked else SLOW_CPU_LIMIT)
                outcome = "too slow" if code is None else "survived" if code in PASSED else "noticed"
            finally:
                self._end_all(process)
            said.seek(0)
            failed = [line for line in said if line.startswith(("FAILED ", "ERROR "))]
        return outcome, time.monotonic() - began, name_of(failed[0]) if failed else ""

    def _exit_code(self, process: subprocess.Popen, cpu_limit: float) -> int | None:
        """That of pytest, which says a letter after every test; None if it has fallen silent."""
        silence, written, before = 0.0, -1, 0.0
        while process.poll() is None:
            size, taken = (self._place / "said").stat().st_size, cpu_time(process.pid)
            # Looks are counted, not the clock asked: it goes on while all of this is suspended.
            silence = silence + LOOK if size == written else 0.0
            before = before if size == written else taken
            written = size
            if silence > LIMIT or taken - before > cpu_limit:
                return None
            with suppress(subprocess.TimeoutExpired):
                process.wait(LOOK)
        return process.returncode

    def _end_all(self, process: subprocess.Popen) -> None:
        """End whatever tests have left behind."""
        with suppress(ProcessLookupError):
            os.killpg(process.pid, signal.SIGKILL)
        process.wait()
        shutil.rmtree(self._place / "temporary", ignore_errors=True)
        (self._place / "temporary").mkdir(mode=0o700, exist_ok=True)

    @property
    def _environment(self) -> dict[str, str]:
        """That of the user, with nothing of theirs in reach."""
        places = {"HOME": "home", "TMPDIR": "temporary", "NUMBA_CACHE_DIR": "home", "XDG_CACHE_HOME": "home"}
        own = {name: str(self._place / folder) for name, folder in places.items()}
        return {**os.environ, **own, "PYTHONPATH": str(self._tree), "PYTHONDONTWRITEBYTECODE": "1"}


class Attempts:
    """Faults being tried, several at a time, each result written at once.

    Args:
        output: The file of rows.
        copies: Where they are tried.
        again: Whether to try once more what survived; tests may have come since.
    """

    def __init__(self, output: Path, copies: list[Copy], *, again: bool = False) -> None:
        self.rows = read_rows(output)
        if again:
            self.rows = {what: row for what, row in self.rows.items() if row.outcome != "survived"}
            write_rows(output, list(self.rows.values()))
        self._output = output
        self._free: queue.SimpleQueue[Copy] = queue.SimpleQueue()
        for each in copies:
            self._free.put(each)

    def with_fault(self, mutant: Mutant) -> None:
        """Try one fault, unless it was tried before."""
        if mutant.row.what in self.rows:
            return
        copy = self._free.get()
        try:
            self._keep(mutant.row, *copy.attempt(mutant))
        finally:
            self._free.put(copy)

    def without_fault(self, rows: list[Row]) -> None:
        """Refuse results if a test that noticed a fault fails without any."""
        seen_by = sorted({row.seen_by for row in rows if "::" in row.seen_by})
        outcome, _, failed = self._free.get().run(seen_by)
        if outcome != "survived":
            raise SystemExit(f"{failed or outcome}: fails without any fault; put this right and begin anew")

    def _keep(self, row: Row, outcome: str, seconds: float, seen_by: str) -> None:
        done = Row(**{**asdict(row), "outcome": outcome, "seconds": f"{seconds:.1f}", "seen_by": seen_by})
        if not self._output.exists():
            write_rows(self._output, [])
        with self._output.open("a", encoding="utf-8", newline="") as file:
            _writer(file).writerow(asdict(done))
        self.rows[done.what] = done
        print(f"{outcome:9}{seconds:6.0f} s  {row.path}:{row.line}  {row.kind}", flush=True)


def cpu_time(session: int) -> float:
    """Processor time that the processes of a session have taken [s]; 0 where nobody can say."""
    ticks = 0
    for file in Path("/proc").glob("[0-9]*/stat"):
        with suppress(OSError):
            fields = file.read_text().rpartition(")")[2].split()
            if int(fields[3]) == session:
                ticks += sum(map(int, fields[11:15]))  # its own, and of children that have ended
    return ticks / os.sysconf("SC_CLK_TCK")


def row_of(path: str, source: bytes, fault: Fault) -> Row:
    """The row of a fault that has not been tried."""
    first = source.rfind(b"\n", 0, fault.start) + 1
    last = source.find(b"\n", fault.end)
    after = source[first : fault.start] + fault.new.encode() + source[fault.end : last]
    return Row(
        path, source.count(b"\n", 0, first) + 1, fault.kind, source[first:last].decode(), after.decode()
    )


def read_rows(output: Path) -> dict[tuple[str, ...], Row]:
    """What was tried before."""
    if not output.exists():
        return {}
    with output.open(encoding="utf-8", newline="") as file:
        rows = [Row(**{**row, "line": int(row["line"])}) for row in csv.DictReader(file)]
    return {row.what: row for row in rows}


def write_rows(output: Path, rows: list[Row]) -> None:
    """A file of rows, whatever was there before."""
    with output.open("w", encoding="utf-8", newline="") as file:
        writer = _writer(file)
        writer.writeheader()
        writer.writerows(map(asdict, rows))


def _writer(file: TextIO) -> csv.DictWriter:
    return csv.DictWriter(file, [each.name for each in fields(Row)], lineterminator="\n")


def name_of(line: str) -> str:
    """The test in a line of pytest's summary, such as "FAILED tests/test_one.py::test_one - ValueError"."""
    return line.partition(" ")[2].partition(" - ")[0].strip()
