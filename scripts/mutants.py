"""Put small faults into the sources, one at a time, and say which of them no test notices.

    python -m scripts.mutants --number 200 --seed 1 --output mutants.csv

A random sample of all faults (`scripts.faults`) of the modules below is tried in copies of the tree,
each with the tests that concern its module: those of its name and those that import it first, the slow
ones only if no other notices it. The tree itself is not touched. What was tried stands in the output and
is not tried again. A fault with which a test does not end is noticed, and so is one with which nothing
can be imported.

Two programs that do the like were tried. mutmut (3.8) leaves constants and decorated functions alone: in
the solver, whose functions are all compiled, it finds no fault to put in. cosmic-ray (8.7) rewrites the
tree where it stands, knows one test command for all modules, and draws no sample.
"""

from __future__ import annotations

import argparse
import difflib
import hashlib
import os
import re
import resource
import tempfile
from collections.abc import Mapping
from concurrent.futures import ThreadPoolExecutor
from itertools import groupby
from pathlib import Path
from typing import Final

from scripts.equivalents import Key, key_of, reasons
from scripts.faults import faults_in
from scripts.trying_faults import ROOT, Attempts, Copy, Mutant, Row, row_of

# Which tests concern which modules, the quickest first; the first pattern that fits counts.
KERNEL: Final = (
    "tests/arm2d/kernel/test_interpreted.py",
    "tests/arm2d/test_world.py",
    "tests/arm2d/test_arithmetic.py",
    "tests/evolution/runs/test_golden.py",
    "tests/arm2d/kernel/test_kernel.py",
    "tests/arm2d/kernel/test_camera_at_end.py",
    "tests/arm2d/worlds/test_stepping.py",
)
RUNS: Final = (
    "tests/evolution/runs",
    "tests/evolution/trust/test_verify.py",
    "tests/evolution/test_library.py",
)
FILMED: Final = (
    "tests/models",
    "tests/mujoco_port/film/test_gaze.py",
    "tests/mujoco_port/live/test_scene.py",
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
        "tests/arm2d/kernel/test_kernel.py",
    ),
    "arm2d/network/controller.py": (
        "tests/arm2d/network/test_controller.py",
        "tests/arm2d/kernel/test_kernel.py",
    ),
    "arm2d/readings.py": (
        "tests/arm2d/test_readings.py",
        "tests/test_ledger.py",
        "tests/arm2d/test_trials.py",
        "tests/evolution/runs/test_golden.py",
    ),
    "arm2d/instructions.py": ("tests/arm2d/test_instructions.py",),
    "arm2d/worlds/*.py": ("tests/arm2d/worlds",),
    "evolution/search/*.py": ("tests/evolution/search", "tests/evolution/runs/test_golden.py"),
    "evolution/results/statistics.py": ("tests/evolution/results",),
    "evolution/results/comparisons.py": ("tests/evolution/results",),
    "evolution/study/declared/regression.py": ("tests/evolution/study/declared/test_regression.py",),
    "evolution/study/declared/beta_binomial.py": ("tests/evolution/study/declared",),
    "evolution/study/declared/confirmation/verdict.py": ("tests/evolution/study/declared",),
    "evolution/runs/*.py": RUNS,
    "mujoco_port/reach/*.py": ("tests/mujoco_port/reach",),
    # A session goes on with other words in mid-trial, which nobody else does.
    "mujoco_port/acting/rollout.py": ("tests/mujoco_port/acting", "tests/mujoco_port/live/test_session.py"),
    "mujoco_port/acting/*.py": ("tests/mujoco_port/acting",),
    "models/presence.py": FILMED,
    "models/filmed.py": FILMED,
    "models/*.py": (
        "tests/models",
        "tests/mujoco_port/reach/test_search.py",
        "tests/mujoco_port/reach/test_workspace.py",
        "tests/mujoco_port/reach/test_certificate.py",
        "tests/mujoco_port/reach/test_kinematics.py",
        "tests/mujoco_port/acting/test_contacts.py",
        "tests/mujoco_port/acting/test_control.py",
    ),
}
# What only draws is looked at by people.
LEFT_OUT: Final = ("mujoco_port/reach/certificate_figure.py", "models/appearance.py")
# A fault may ask for any amount of memory [bytes].
LARGEST_MEMORY: Final = 16 * 2**30


def all_mutants() -> list[Mutant]:
    """Every fault of every module that has tests here; of equal lines in a module the first."""
    paths = {path for pattern in TESTS for path in ROOT.glob(pattern)} - {ROOT / name for name in LEFT_OUT}
    mutants: dict[tuple[str, ...], Mutant] = {}
    for path in sorted(paths):
        source = path.read_bytes()
        name = path.relative_to(ROOT).as_posix()
        tests, nearest = witnesses_of(name), nearest_of(name)
        for fault in faults_in(source):
            row = row_of(name, source, fault)
            mutants.setdefault(row.what, Mutant(row, fault, tests, nearest))
    return list(mutants.values())


def sample_of(mutants: list[Mutant], seed: int, number: int) -> list[Mutant]:
    """Those whose digests with the seed come first.

    A larger sample begins with the smaller one of the same seed, and where sources have changed since, what
    they still hold of it is drawn again.
    """
    return sorted(mutants, key=lambda each: _digest(seed, *each.row.what))[:number]


def _digest(seed: int, *words: str) -> bytes:
    return hashlib.sha256("\0".join([str(seed), *words]).encode()).digest()


def witnesses_of(path: str) -> tuple[str, ...]:
    """The tests that concern a module."""
    return next(tests for pattern, tests in TESTS.items() if Path(path).match(pattern))


def nearest_of(path: str) -> tuple[str, ...]:
    """Those among them that have its name or import it, or else the first."""
    module = path.removesuffix(".py").replace("/", ".")
    imports = re.compile(rf"^(from|import) {re.escape(module)}\b", re.MULTILINE)
    tests = witnesses_of(path)
    named = ROOT / "tests" / Path(path).parent / f"test_{Path(path).stem}.py"
    if tests is KERNEL:  # compiling costs more than all else
        return (*([named.relative_to(ROOT).as_posix()] if named.exists() else []), KERNEL[0])
    files = [found for test in tests for found in _test_files(ROOT / test)]
    importing = [file for file in files if imports.search(file.read_text(encoding="utf-8"))]
    nearest = [file.relative_to(ROOT).as_posix() for file in (named, *importing) if file.exists()]
    return tuple(dict.fromkeys(nearest)) or tests[:1]


def _test_files(test: Path) -> list[Path]:
    return sorted(test.rglob("test_*.py")) if test.is_dir() else [test]


def summary(rows: list[Row], equivalent: Mapping[Key, str]) -> str:
    """How many were noticed, room by room, what survived, and what of it cannot be noticed."""
    survivors = [row for row in rows if row.outcome == "survived"]
    unnoticeable = [row for row in survivors if key_of(row) in equivalent]
    counted = [row for row in rows if row not in unnoticeable]
    lines = [_noticed(list(room), name) for name, room in groupby(sorted(counted, key=_room), _room)]
    for row in survivors:
        lines += ["", f"{row.path}:{row.line}: {row.kind}, survived"]
        if row in unnoticeable:
            lines[-1] += f"; equivalent: {equivalent[key_of(row)]}"
        change = difflib.ndiff(row.before.splitlines(), row.after.splitlines())
        lines += [line for line in change if line[0] in "-+"]
    also = f"; {len(unnoticeable)} more are equivalent" if unnoticeable else ""
    return "\n".join([*lines, "", _noticed(counted) + also])


def _noticed(rows: list[Row], room: str = "") -> str:
    noticed = sum(row.outcome != "survived" for row in rows)
    return f"{room}: {noticed} of {len(rows)} noticed".removeprefix(": ")


def _room(row: Row) -> str:
    return str(Path(row.path).parent)


def main() -> None:
    """Draw a sample, try it, and say what survives."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--number", type=int, default=200, help="of faults")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", default="", help="modules whose path begins so")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), help="copies of the tree at work")
    parser.add_argument("--again", action="store_true", help="try once more what survived")
    parser.add_argument("--output", type=Path, default=Path("mutants.csv"))
    asked = parser.parse_args()
    _, most = resource.getrlimit(resource.RLIMIT_AS)
    resource.setrlimit(resource.RLIMIT_AS, (LARGEST_MEMORY, most))
    drawn = [each for each in all_mutants() if each.row.path.startswith(asked.only)]
    sample = sample_of(drawn, asked.seed, asked.number)
    print(f"{len(sample)} of {len(drawn)} faults", flush=True)
    with tempfile.TemporaryDirectory(prefix="mutants-") as folder, ThreadPoolExecutor(asked.jobs) as at_work:
        places = [Path(folder) / str(k) for k in range(asked.jobs)]
        for place in places:
            place.mkdir(mode=0o700)
        copies = [Copy(place) for place in places]
        attempts = Attempts(asked.output, copies, again=asked.again)
        left = [each for each in sample if each.row.what not in attempts.rows]
        list(at_work.map(attempts.with_fault, left))
        rows = [attempts.rows[each.row.what] for each in sample]
        attempts.without_fault(rows)
    print(summary(rows, reasons()))


if __name__ == "__main__":
    main()
