"""Trying things in child processes: a broken library may end the process that loads it."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

TIMEOUT_S: Final = 120.0


@dataclass(frozen=True)
class Attempt:
    """What became of a child process.

    Attributes:
        works: Whether it ended well.
        lines: What it printed.
        reason: Why it did not end well, in one line.
    """

    works: bool
    lines: tuple[str, ...]
    reason: str = ""


def attempt(code: str, *arguments: str, environment: Mapping[str, str] | None = None) -> Attempt:
    """Run Python code in a child process that searches modules as `wordarm` does.

    Args:
        code: What to run.
        arguments: Its `sys.argv[1:]`.
        environment: Variables on top of our own.
    """
    # -P: the current folder is no place to import from, as for an installed command.
    command = [sys.executable, "-P", "-c", code, *arguments]
    variables = {**os.environ, **(environment or {})}
    try:
        done = subprocess.run(  # noqa: S603 - our own interpreter and text
            command,
            env=variables,
            stdin=subprocess.DEVNULL,
            capture_output=True,
            text=True,
            errors="replace",
            timeout=TIMEOUT_S,
            check=False,
        )
    except subprocess.TimeoutExpired:
        return Attempt(False, (), f"no answer in {TIMEOUT_S:.0f} s")
    lines = tuple(done.stdout.splitlines())
    if done.returncode == 0:
        return Attempt(True, lines)
    if done.returncode < 0:
        return Attempt(False, lines, f"the process was ended by {signal.Signals(-done.returncode).name}")
    said = [line for line in done.stderr.splitlines() if line.strip()]
    return Attempt(False, lines, said[-1].strip() if said else f"exit code {done.returncode}")
