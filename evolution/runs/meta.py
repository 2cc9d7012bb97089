"""meta.json: with what, where and when a run was computed; nothing that determines its result."""

from __future__ import annotations

import json
import os
import platform
import subprocess
import sys
from collections.abc import Mapping
from datetime import UTC, datetime
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from types import MappingProxyType
from typing import Any, Final

from arm2d.files import read_file
from evolution.runs.storage import write_atomically

# What a repository may have in its settings that runs programs when git looks at it, switched off.
NOTHING_RUN: Final = {
    "core.fsmonitor": "false",
    "core.hooksPath": os.devnull,
    "core.pager": "cat",
    # Also ssh, by which missing objects would be fetched.
    "protocol.allow": "never",
}
LARGEST: Final = 16 * 2**20  # [bytes], tens of thousands of starts
PACKAGES: Final = ("wordarm", "numpy", "numba", "llvmlite")
# Of a package that takes part only where a device runs the trials: its module and its name.
OF_DEVICES: Final = ("warp", "warp-lang")


def now() -> str:
    """The time, in UTC."""
    return datetime.now(UTC).isoformat(timespec="seconds")


def versions() -> dict[str, str]:
    """Versions of whatever takes part in the computation."""
    found = {"python": platform.python_version()}
    module, package = OF_DEVICES
    for name in (*PACKAGES, package) if module in sys.modules else PACKAGES:
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
        status = ("status", "--porcelain", "--untracked-files=no", "--ignore-submodules=all")
        modified = "-dirty" if _git(package, *status, settings=_filters(package)) else ""
        return _git(package, "describe", "--always", "--abbrev=12") + modified
    except (OSError, subprocess.SubprocessError):
        return "unknown"


def machine() -> dict[str, Any]:
    """The kind of machine."""
    return {"system": platform.platform(), "processor": _processor(), "cores": os.cpu_count()}


def read_meta(path: Path) -> dict[str, Any]:
    """What was noted before; nothing, if the file is missing or damaged: no result depends on it."""
    try:
        meta = json.loads(read_file(path, LARGEST, links=False))
    except (OSError, ValueError, RecursionError):
        return {"starts": []}
    starts = meta.get("starts") if isinstance(meta, dict) else None
    sound = isinstance(starts, list) and all(_is_start(each) for each in starts)
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


def _is_start(value: object) -> bool:
    """Whether something is what `note_start` notes, as far as anyone reads it."""
    return (
        isinstance(value, dict)
        and all(isinstance(value.get(name, {}), dict) for name in ("versions", "machine"))
        and isinstance(value.get("revision", ""), str)
    )


def _write(path: Path, meta: dict[str, Any]) -> None:
    write_atomically(path, (json.dumps(meta, indent=2) + "\n").encode())


def _git(folder: Path, *arguments: str, settings: Mapping[str, str] = MappingProxyType({})) -> str:
    """What a git command answers; raises if it fails."""
    command = ["git", "--no-optional-locks", "-C", str(folder), *arguments]
    return subprocess.run(  # noqa: S603 - git itself
        command, capture_output=True, text=True, check=True, timeout=10, env=_git_environment(settings)
    ).stdout.strip()


def _git_environment(settings: Mapping[str, str]) -> dict[str, str]:
    """Our environment without what leads git to another repository, and with settings of our own."""
    own = {**NOTHING_RUN, **settings}
    given = {"GIT_CONFIG_COUNT": str(len(own))}
    for n, (name, value) in enumerate(own.items()):
        given |= {f"GIT_CONFIG_KEY_{n}": name, f"GIT_CONFIG_VALUE_{n}": value}
    return {name: value for name, value in os.environ.items() if not name.startswith("GIT_")} | given


def _filters(folder: Path) -> dict[str, str]:
    """Settings that switch off the programs by which a repository wants its files read."""
    try:
        names = _git(folder, "config", "--name-only", "--null", "--get-regexp", r"^filter\.").split("\0")
    except subprocess.CalledProcessError:  # there is none
        return {}
    drivers = {each.rpartition(".")[0] for each in names if each}
    off = {f"{each}.{kind}": "" for each in drivers for kind in ("clean", "smudge", "process")}
    return {**off, **{f"{each}.required": "false" for each in drivers}}


def _processor() -> str:
    """Name of the processor, as Linux tells it."""
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    except OSError:
        return platform.processor() or "unknown"
    return next(
        (line.partition(":")[2].strip() for line in lines if line.startswith("model name")), "unknown"
    )
