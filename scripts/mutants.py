"""Put small faults into the sources, one at a time, and say which of them no test notices.

    python -m scripts.mutants --number 200 --seed 1 --output mutants.csv

A random sample of all faults (`scripts.faults`) of the modules below is tried in copies of the tree,
each with the tests that concern its module; the tree itself is not touched. What was tried stands in the
output and is not tried again. A fault with which a test does not end is noticed, and so is one with
which nothing can be imported.

Two programs that do the like were tried. mutmut (3.8) leaves constants and decorated functions alone: in
the solver, whose functions are all compiled, it finds no fault to put in. cosmic-ray (8.7) rewrites the
tree where it stands, knows one test command for all modules, and draws no sample.
"""

from __future__ import annotations

import argparse
import csv
import difflib
import os
import queue
import random
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from dataclasses import asdict, dataclass, fields
from pathlib import Path
from typing import Final

from scripts.faults import Fault, faults_in

ROOT: Final = Path(__file__).parents[1]
# Which tests concern which modules, the quickest first; the first pattern that fits counts.
KERNEL: Final = (
    "tests/arm2d/test_arithmetic.py",
    "tests/arm2d/test_world.py",
    "tests/evolution/runs/test_golden.py",
    "tests/arm2d/test_kernel.py",
    "tests/arm2d/test_camera_at_end.py",
    "tests/arm2d/worlds/test_stepping.py",
)
RUNS: Final = (
    "tests/evolution/runs",
    "tests/evolution/trust/test_verify.py",
    "tests/evolution/test_library.py",
)
TESTS: Final[dict[str, tuple[str, ...]]] = {
    "arm2d/arithmetic.py": KERNEL,
    "arm2d/constants.py": KERNEL,
    "arm2d/geometry.py": KERNEL,
    "arm2d/reference.py": KERNEL,
    "arm2d/kernel/*.py": KERNEL,
    "arm2d/trials.py": (
        "tests/arm2d/test_trials.py",
        "tests/arm2d/test_records.py",
        "tests/arm2d/test_kernel.py",
    ),
    "arm2d/controller.py": ("tests/arm2d/test_controller.py", "tests/arm2d/test_kernel.py"),
    "arm2d/readings.py": ("tests/arm2d/test_readings.py", "tests/arm2d/test_trials.py"),
    "arm2d/instructions.py": ("tests/arm2d/test_instructions.py",),
    "arm2d/worlds/*.py": ("tests/arm2d/worlds",),
    "evolution/search/*.py": ("tests/evolution/search", "tests/evolution/runs/test_golden.py"),
    "evolution/results/statistics.py": ("tests/evolution/results",),
    "evolution/results/comparisons.py": ("tests/evolution/results",),
    "evolution/study/declared/regression.py": ("tests/evolution/study/declared/test_regression.py",),
    "evolution/study/declared/beta_binomial.py": ("tests/evolution/study/declared",),
    "evolution/study/declared/verdict.py": ("tests/evolution/study/declared",),
    "evolution/runs/*.py": RUNS,
    "mujoco_port/reach/*.py": ("tests/mujoco_port/reach",),
    "mujoco_port/acting/*.py": ("tests/mujoco_port/acting",),
    "models/*.py": (
        "tests/models",
        "tests/mujoco_port/reach/test_workspace.py",
        "tests/mujoco_port/reach/test_certificate.py",
        "tests/mujoco_port/reach/test_kinematics.py",
        "tests/mujoco_port/acting/test_contacts.py",
        "tests/mujoco_port/acting/test_control.py",
    ),
}
# What only draws is looked at by people.
LEFT_OUT: Final = ("mujoco_port/reach/certificate_figure.py", "models/appearance.py")
LIMIT: Final = 300.0  # [s] in which some test has to end
LOOK: Final = 1.0  # [s] from one look to the next
# A fault may ask for any amount of memory [bytes].
LARGEST_MEMORY: Final = 16 * 2**30


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
    """A fault of a module, with the row that will tell of it."""

    row: Row
    fault: Fault


class Copy:
    """A copy of the tree in which one fault after the other is tried.

    Args:
        place: An empty folder for the copy, its cache and its temporary files.
    """

    def __init__(self, place: Path) -> None:
        self._tree, self._place = place / "tree", place
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

    def attempt(self, mutant: Mutant, tests: tuple[str, ...]) -> tuple[str, float, str]:
        """Outcome, duration [s], and the test that failed, of tests with a fault in the sources."""
        path = self._tree / mutant.row.path
        sound, stamp = path.read_bytes(), path.stat()
        path.write_bytes(mutant.fault.put_into(sound))
        # A date of its own, lest what was compiled of another fault be taken for this one's.
        self._tried += 1
        os.utime(path, (stamp.st_atime, stamp.st_mtime + 10 * self._tried))
        try:
            return self.run(tests)
        finally:
            path.write_bytes(sound)
            os.utime(path, (stamp.st_atime, stamp.st_mtime))

    def run(self, tests: Sequence[str]) -> tuple[str, float, str]:
        """The same, of tests in the tree as it is."""
        began = time.monotonic()
        with (self._place / "said").open("w+", encoding="utf-8") as said:
            process = subprocess.Popen(  # noqa: S603 - our own words
                [sys.executable, "-m", "pytest", "-x", "-p", "no:cacheprovider", "--tb=no", *tests],
                cwd=self._tree,
                env=self._environment,
                stdout=said,
                stderr=subprocess.STDOUT,
                start_new_session=True,
            )
            try:
                code = self._exit_code(process)
                outcome = "too slow" if code is None else "noticed" if code else "survived"
            finally:
                self._end_all(process)
            said.seek(0)
            failed = [line for line in said if line.startswith(("FAILED ", "ERROR "))]
        return outcome, time.monotonic() - began, name_of(failed[0]) if failed else ""

    def _exit_code(self, process: subprocess.Popen) -> int | None:
        """That of pytest, which says a letter after every test; None if it has fallen silent."""
        silence, written = 0.0, -1
        while process.poll() is None:
            size = (self._place / "said").stat().st_size
            # Looks are counted, not the clock asked: it goes on while all of this is suspended.
            silence, written = (silence + LOOK if size == written else 0.0), size
            if silence > LIMIT:
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


def name_of(line: str) -> str:
    """The test in a line of pytest's summary, such as "FAILED tests/test_one.py::test_one - ValueError"."""
    return line.partition(" ")[2].partition(" - ")[0].strip()


def all_mutants() -> list[Mutant]:
    """Every fault of every module that has tests here; of equal lines in a module the first."""
    paths = {path for pattern in TESTS for path in ROOT.glob(pattern)} - {ROOT / name for name in LEFT_OUT}
    mutants: dict[tuple[str, ...], Mutant] = {}
    for path in sorted(paths):
        source = path.read_bytes()
        for fault in faults_in(source):
            row = row_of(path.relative_to(ROOT).as_posix(), source, fault)
            mutants.setdefault(row.what, Mutant(row, fault))
    return list(mutants.values())


def row_of(path: str, source: bytes, fault: Fault) -> Row:
    """The row of a fault that has not been tried."""
    first = source.rfind(b"\n", 0, fault.start) + 1
    last = source.find(b"\n", fault.end)
    after = source[first : fault.start] + fault.new.encode() + source[fault.end : last]
    return Row(
        path, source.count(b"\n", 0, first) + 1, fault.kind, source[first:last].decode(), after.decode()
    )


def witnesses_of(path: str) -> tuple[str, ...]:
    """The tests that concern a module."""
    return next(tests for pattern, tests in TESTS.items() if Path(path).match(pattern))


def read_rows(output: Path) -> dict[tuple[str, ...], Row]:
    """What was tried before."""
    if not output.exists():
        return {}
    with output.open(encoding="utf-8", newline="") as file:
        rows = [Row(**{**row, "line": int(row["line"])}) for row in csv.DictReader(file)]
    return {row.what: row for row in rows}


class Attempts:
    """Faults being tried, several at a time, each result written at once.

    Args:
        output: The file of rows.
        copies: Where they are tried.
    """

    def __init__(self, output: Path, copies: list[Copy]) -> None:
        self.rows = read_rows(output)
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
            self._keep(mutant.row, *copy.attempt(mutant, witnesses_of(mutant.row.path)))
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
        begun = self._output.exists()
        with self._output.open("a", encoding="utf-8", newline="") as file:
            writer = csv.DictWriter(file, [each.name for each in fields(Row)])
            if not begun:
                writer.writeheader()
            writer.writerow(asdict(done))
        self.rows[done.what] = done
        print(f"{outcome:9}{seconds:6.0f} s  {row.path}:{row.line}  {row.kind}", flush=True)


def summary(rows: list[Row]) -> str:
    """How many were noticed, room by room, and what survived."""
    lines = []
    rooms = sorted({str(Path(row.path).parent) for row in rows})
    for room in rooms:
        found = Counter(row.outcome for row in rows if str(Path(row.path).parent) == room)
        lines.append(f"{room}: {found.total() - found['survived']} of {found.total()} noticed")
    for row in rows:
        if row.outcome == "survived":
            change = difflib.ndiff(row.before.splitlines(), row.after.splitlines())
            shown = [line for line in change if line[0] in "-+"]
            lines += ["", f"{row.path}:{row.line}: {row.kind}, survived", *shown]
    survived = sum(row.outcome == "survived" for row in rows)
    lines += ["", f"{len(rows) - survived} of {len(rows)} noticed"]
    return "\n".join(lines)


def main() -> None:
    """Draw a sample, try it, and say what survives."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--number", type=int, default=200, help="of faults")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", default="", help="modules whose path begins so")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), help="copies of the tree at work")
    parser.add_argument("--output", type=Path, default=Path("mutants.csv"))
    asked = parser.parse_args()
    _, most = resource.getrlimit(resource.RLIMIT_AS)
    resource.setrlimit(resource.RLIMIT_AS, (LARGEST_MEMORY, most))
    drawn = [each for each in all_mutants() if each.row.path.startswith(asked.only)]
    # Drawn from all at once: a larger sample begins with the smaller one of the same seed.
    random.Random(asked.seed).shuffle(drawn)  # noqa: S311 - no secret
    sample = drawn[: asked.number]
    print(f"{len(sample)} of {len(drawn)} faults", flush=True)
    with tempfile.TemporaryDirectory(prefix="mutants-") as folder, ThreadPoolExecutor(asked.jobs) as at_work:
        places = [Path(folder) / str(k) for k in range(asked.jobs)]
        for place in places:
            place.mkdir(mode=0o700)
        attempts = Attempts(asked.output, [Copy(place) for place in places])
        left = [each for each in sample if each.row.what not in attempts.rows]
        list(at_work.map(attempts.with_fault, left))
        rows = [attempts.rows[each.row.what] for each in sample]
        attempts.without_fault(rows)
    print(summary(rows))


if __name__ == "__main__":
    main()
