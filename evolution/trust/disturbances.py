"""What else can befall an experiment: damaged files, a full disk, a folder that cannot be written."""

from __future__ import annotations

import os
import random
import resource
import subprocess
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Final

from arm2d.files import handle_to_overwrite
from evolution.answers import BAD_INPUT
from evolution.child import python
from evolution.runs.folder import CHAMPIONS, CHECKPOINT, RunFolder
from evolution.trust.killing import TortureError
from evolution.trust.repair import repair
from evolution.trust.stages import stage_of, temporaries
from evolution.trust.tally import Tally

# Too small for a part, large enough for config.toml and meta.json [bytes].
LARGEST_FILE: Final = 20_000
READ_ONLY: Final = 0o555
WRITABLE: Final = 0o755


def truncated(data: bytes, rng: random.Random) -> bytes:
    """As after a crash of the system: the end is missing."""
    return data[: rng.randrange(len(data))]


def flipped(data: bytes, rng: random.Random) -> bytes:
    """As after an error of disk or memory: one bit is another."""
    bit = rng.randrange(8 * len(data))
    changed = bytearray(data)
    changed[bit // 8] ^= 1 << bit % 8
    return bytes(changed)


def zeroed(data: bytes, rng: random.Random) -> bytes:
    """As after a power cut on some file systems: the length is right, the content was never written."""
    start = rng.randrange(len(data))
    return data[:start] + bytes(len(data) - start)


DAMAGES: Final[Mapping[str, Callable[[bytes, random.Random], bytes]]] = {
    "truncated": truncated, "one bit flipped": flipped, "zeroed": zeroed,
}  # fmt: skip


def damage_and_repair(run: Path, rng: random.Random, tally: Tally, at_once: int = 3) -> None:
    """Damage some files of a run that nobody works on, and have them named and computed again.

    Raises:
        TortureError: If a damaged file is not named, or comes back with other bits.
    """
    files = sorted(each for each in run.glob("*/*.npz") if each.parent.name in REPAIRED)
    files += [each for each in (run / CHECKPOINT, run / CHAMPIONS) if each.exists()]
    before: dict[Path, bytes] = {}
    for file in rng.sample(files, min(at_once, len(files))):
        how = rng.choice(sorted(DAMAGES))
        before[file] = file.read_bytes()
        with os.fdopen(handle_to_overwrite(file), "wb") as damaged:
            damaged.write(DAMAGES[how](before[file], rng))
        tally.damages[how, stage_of(file)] += 1
    notes: list[str] = []
    repair(run, notes.append)
    for file, data in before.items():
        _check_repaired(RunFolder.open(run), file, data, notes)


REPAIRED: Final = ("parts", "postevaluation", "transitions")


def _check_repaired(run: RunFolder, file: Path, data: bytes, notes: list[str]) -> None:
    """A damaged file must have been named, and have the bits it had."""
    if not any(file.name in each for each in notes):
        raise TortureError(f"{file} was damaged, and nobody named it: {'; '.join(notes)}")
    if file.read_bytes() != data:
        raise TortureError(f"{file} was damaged, and was repaired with other bits in {run.path}")


def refuse_where_files_cannot_grow(command: tuple[str, ...], folder: Path, tally: Tally) -> None:
    """Start a run where no file may be larger than `LARGEST_FILE`, as on a full disk."""

    def limit() -> None:
        resource.setrlimit(resource.RLIMIT_FSIZE, (LARGEST_FILE, LARGEST_FILE))

    _must_be_refused(command, folder, "File too large", limit)
    tally.refusals["files that may not grow, as on a full disk"] += 1


def refuse_where_nothing_can_be_written(command: tuple[str, ...], folder: Path, tally: Tally) -> None:
    """Go on with a run in a folder that is read-only; left out for root, whom no permission stops."""
    if os.geteuid() == 0:
        return
    before = _contents(folder)
    folder.chmod(READ_ONLY)
    try:
        _must_be_refused(command, folder, "cannot be written: Permission denied")
    finally:
        folder.chmod(WRITABLE)
    if _contents(folder) != before:
        raise TortureError(f"{folder} was read-only, and is not what it was")
    tally.refusals["a folder that is read-only"] += 1


def _must_be_refused(
    command: tuple[str, ...], folder: Path, sentence: str, prepare: Callable[[], None] | None = None
) -> None:
    """Run a command that has to fail as bad input does, with nothing half-written."""
    done = subprocess.run(  # noqa: S603 - our own program
        python("-m", "evolution", *command), capture_output=True, text=True, preexec_fn=prepare
    )
    if done.returncode != BAD_INPUT or sentence not in done.stderr or done.stderr.count("\n") != 1:
        raise TortureError(f"expected one sentence with {sentence!r}, but had: {done.stderr or done.stdout}")
    if left := temporaries(folder):
        raise TortureError(f"{sorted(left)[0]} was left half-written by a command that was refused")


def _contents(folder: Path) -> dict[Path, bytes]:
    return {each: each.read_bytes() for each in folder.rglob("*") if each.is_file()}
