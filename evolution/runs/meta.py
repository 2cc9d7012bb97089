"""meta.json: with what, where and when a run was computed; nothing that determines its result."""

from __future__ import annotations

import json
import os
import platform
import subprocess
from datetime import UTC, datetime
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any, Final

from evolution.runs.storage import write_atomically

PACKAGES: Final = ("wordarm", "numpy", "numba", "llvmlite")


def now() -> str:
    """The time, in UTC."""
    return datetime.now(UTC).isoformat(timespec="seconds")


def versions() -> dict[str, str]:
    """Versions of whatever takes part in the computation."""
    found = {"python": platform.python_version()}
    for name in PACKAGES:
        try:
            found[name] = version(name)
        except PackageNotFoundError:
            found[name] = "unknown"
    return found


def revision() -> str:
    """Revision of the source, with "-dirty" if files were changed since; "unknown" if it has none."""
    package = Path(__file__).parent
    try:
        # In a folder of another project's repository, our files are not tracked.
        _git(package, "ls-files", "--error-unmatch", "run.py")
        # Not `describe --dirty`: that locks the index, and whoever is killed in it leaves the lock behind.
        modified = "-dirty" if _git(package, "status", "--porcelain", "--untracked-files=no") else ""
        return _git(package, "describe", "--always", "--abbrev=12") + modified
    except (OSError, subprocess.SubprocessError):
        return "unknown"


def machine() -> dict[str, Any]:
    """The kind of machine."""
    return {"system": platform.platform(), "processor": _processor(), "cores": os.cpu_count()}


def read_meta(path: Path) -> dict[str, Any]:
    """What was noted before; nothing, if the file is missing or damaged: no result depends on it."""
    try:
        meta = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError, RecursionError):
        return {"starts": []}
    starts = meta.get("starts") if isinstance(meta, dict) else None
    sound = isinstance(starts, list) and all(isinstance(each, dict) for each in starts)
    return meta if sound else {"starts": []}


def note_start(path: Path, generation: int) -> None:
    """Add that the run is started, or gone on with, at a generation."""
    start = {
        "started": now(),
        "first_generation": generation,
        "ended": None,
        "versions": versions(),
        "revision": revision(),
        "machine": machine(),
    }
    _write(path, {"starts": [*read_meta(path)["starts"], start]})


def note_end(path: Path, generation: int, cpu_seconds: float) -> None:
    """Complete the newest start by where and when it ended."""
    meta = read_meta(path)
    if meta["starts"]:
        end = {"ended": now(), "next_generation": generation, "cpu_seconds": round(cpu_seconds, 2)}
        meta["starts"][-1].update(end)
    _write(path, meta)


def _write(path: Path, meta: dict[str, Any]) -> None:
    write_atomically(path, (json.dumps(meta, indent=2) + "\n").encode())


def _git(folder: Path, *arguments: str) -> str:
    """What a git command answers; raises if it fails."""
    command = ["git", "--no-optional-locks", "-C", str(folder), *arguments]
    return subprocess.run(command, capture_output=True, text=True, check=True, timeout=10).stdout.strip()  # noqa: S603


def _processor() -> str:
    """Name of the processor, as Linux tells it."""
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    except OSError:
        return platform.processor() or "unknown"
    return next(
        (line.partition(":")[2].strip() for line in lines if line.startswith("model name")), "unknown"
    )
