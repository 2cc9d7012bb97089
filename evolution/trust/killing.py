"""One experiment under fire: its processes are killed while they write, and at other moments."""

from __future__ import annotations

import os
import subprocess
import time
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final

from arm2d.files import handle_to_overwrite, is_temporary
from evolution.answers import BAD_INPUT
from evolution.child import python
from evolution.runs.lock import last_word
from evolution.runs.storage import make_folder
from evolution.trust.stages import RUN_FOLDERS, SHARES, Schedule, stage_of, temporaries
from evolution.trust.tally import ORPHAN, PARENT, STARTER, WORKER, Tally
from evolution.trust.victims import kill, members, names, session_of, starts_workers
from evolution.trust.watch import OpenedFiles

LOG: Final = "torture.log"
# After so many starts of the parent somebody is also killed at a moment that has nothing to do with writing,
# within so long [s]; not oftener, or a slow machine would never get on.
STARTS_WITH_ANOTHER_KILL: Final = 1 / 3
OTHER_KILL_WITHIN: Final = 20.0
WAIT: Final = 0.05  # [s]
# Of the kills at a write, so many hit the parent of all workers instead of the writer.
PARENT_SHARE: Final = 0.2
# A kill is sent so long after a file was opened, at most [s]: before its first byte, or when it is whole.
LONGEST_DELAY: Final = 0.001
TOLD_EVERY: Final = 10  # kills


class TortureError(ValueError):
    """A promise was broken: something was lost, half-written, or not named."""


@dataclass
class Ordeal:
    """An experiment that is being killed.

    Attributes:
        folder: Of the experiment.
        runs: The folders of its runs.
        command: What starts its parent, or goes on with it, after `python -m evolution`.
        schedule: When to kill.
        tally: Is added to.
        kills: Stop killing when the tally has so many.
        tell: Is told how it gets on.
        parents: The parents so far, each the leader of a session with its workers; the last is at work.
        counted: Unfinished files that earlier kills left, with the time they were last written.
    """

    folder: Path
    runs: tuple[Path, ...]
    command: tuple[str, ...]
    schedule: Schedule
    tally: Tally
    kills: int
    tell: Callable[[str], None] = lambda line: None
    parents: list[int] = field(default_factory=list)
    counted: set[tuple[Path, int]] = field(default_factory=set)

    @property
    def over(self) -> bool:
        """Whether there were enough kills."""
        return self.tally.kills >= self.kills

    def writer(self, file: Path) -> int:
        """The process that writes a file: the one that works on its run, else the parent; 0 if unknown."""
        run = next((each for each in self.runs if each in file.parents), None)
        if run is None:
            return self.parents[-1]
        if file.parent.name in UNLOCKED:
            return next((each for each in members(self.parents[-1]) if names(each, run)), 0)
        return last_word(run).process


# Results about a run that are written without holding it.
UNLOCKED: Final = ("lineage", "behaviour")


def run_to_its_end(ordeal: Ordeal) -> None:
    """Start the parent again and again, and kill, until the experiment is finished.

    Raises:
        TortureError: If it ends badly although nobody was killed.
        OSError: If the folders cannot be watched.
    """
    folders = _make_watched_folders(ordeal)
    while True:
        before = ordeal.tally.kills
        with OpenedFiles(folders) as opened:
            code = _one_parent(ordeal, opened)
        if ordeal.tally.kills // TOLD_EVERY > before // TOLD_EVERY:
            ordeal.tell(f"{ordeal.tally.kills} kills, {ordeal.tally.writes.total()} in the middle of a write")
        if code == 0:
            return
        if code == BAD_INPUT:
            ordeal.tally.given_up += _given_up(ordeal.folder)
        if ordeal.tally.kills == before:
            raise TortureError(f"exit code {code} without a kill; its words are in {ordeal.folder / LOG}")


def _make_watched_folders(ordeal: Ordeal) -> list[Path]:
    """The folders to watch, made beforehand so that no file in them escapes."""
    below = [run / each for run in ordeal.runs for each in RUN_FOLDERS]
    folders = [*below, *ordeal.runs, ordeal.folder / "results", ordeal.folder]
    for folder in folders:
        make_folder(folder)
    return folders


def _one_parent(ordeal: Ordeal, opened: OpenedFiles) -> int:
    """From a start of the parent to its end; its exit code."""
    ordeal.tally.starts += 1
    with os.fdopen(handle_to_overwrite(ordeal.folder / LOG), "wb") as log:
        parent = subprocess.Popen(  # noqa: S603 - our own program
            python("-m", "evolution", *ordeal.command),
            stdin=subprocess.DEVNULL, stdout=log, stderr=subprocess.STDOUT, start_new_session=True,
        )  # fmt: skip
    ordeal.parents.append(parent.pid)
    rng = ordeal.schedule.draw(ordeal.folder / "start")
    is_due = rng.random() < STARTS_WITH_ANOTHER_KILL
    due = time.monotonic() + rng.uniform(0.0, OTHER_KILL_WITHIN)
    while parent.poll() is None:
        for path in opened.wait(WAIT):
            if is_temporary(path.name):
                _perhaps_kill_at_a_write(ordeal, path)
        if is_due and time.monotonic() >= due and not ordeal.over:
            is_due = False
            _kill(ordeal, rng.choice(members(parent.pid) or [0]))
    return parent.returncode


def _perhaps_kill_at_a_write(ordeal: Ordeal, file: Path) -> None:
    """Kill the writer of a file, or the parent, if its number is up."""
    rng = ordeal.schedule.draw(file)
    if not ordeal.over and rng.random() < SHARES[stage_of(file)]:
        victim = ordeal.parents[-1] if rng.random() < PARENT_SHARE else ordeal.writer(file)
        time.sleep(rng.uniform(0.0, LONGEST_DELAY))
        _kill(ordeal, victim)


def _kill(ordeal: Ordeal, victim: int) -> None:
    """Kill a process; the unfinished file it leaves behind, if any, tells what it was writing."""
    who = _role(ordeal, victim)
    if not any(kill(victim, each) for each in reversed(ordeal.parents)):
        return
    held = [each for each in ordeal.runs if last_word(each).process == victim]
    left = _unfinished(ordeal.folder) - ordeal.counted
    stages = sorted(stage_of(each) for each, _ in left if _may_have_written(ordeal, victim, held, each))
    if stages:
        ordeal.counted |= left
        ordeal.tally.writes[who, stages[0]] += 1
    else:
        ordeal.tally.others[who] += 1


def _unfinished(folder: Path) -> set[tuple[Path, int]]:
    """The unfinished files below a folder, each with the time it was last written."""
    found = set()
    for temporary in temporaries(folder):
        with suppress(FileNotFoundError):  # another process has just given it its final name
            found.add((temporary, temporary.stat().st_mtime_ns))
    return found


def _role(ordeal: Ordeal, process: int) -> str:
    """Who a process is, for the tally."""
    parent = ordeal.parents[-1]
    if process == parent:
        return PARENT
    if starts_workers(process, parent):
        return STARTER
    return WORKER if session_of(process) == parent else ORPHAN


def _may_have_written(ordeal: Ordeal, victim: int, held: list[Path], file: Path) -> bool:
    """Whether an unfinished file can be that of a process that is no more."""
    if victim in ordeal.parents:
        return not any(run in file.parents for run in ordeal.runs)
    return any(run in file.parents for run in held) or (not held and file.parent.name in UNLOCKED)


def _given_up(folder: Path) -> int:
    """How many jobs the parent says it gave up."""
    lines = (folder / LOG).read_text(encoding="utf-8", errors="replace").splitlines()
    return sum(", given up while " in each for each in lines)
