"""The torture as a whole: experiment after experiment, each compared with one that nobody disturbed."""

from __future__ import annotations

import os
import random
import shutil
import subprocess
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from arm2d import Condition
from evolution.child import python
from evolution.experiments.plan import Plan
from evolution.runs.storage import make_folder, write_atomically
from evolution.search.config import RunConfig
from evolution.search.settings import Settings
from evolution.trust.disturbances import (
    damage_and_repair,
    refuse_where_files_cannot_grow,
    refuse_where_nothing_can_be_written,
)
from evolution.trust.killing import Ordeal, TortureError, run_to_its_end
from evolution.trust.stages import Schedule
from evolution.trust.tally import Tally

Tell = Callable[[str], None]

UNDISTURBED: Final = "undisturbed"
# Far from the paper, so that every stage comes soon: five parts, the last one short.
SETTINGS: Final = Settings(population=10, elites=2, parents=5, generations=430)
WORKERS: Final = 2
# What depends on when things happened; everything else must have the bits of the undisturbed experiment.
COMPARED: Final = (".npz", ".csv", ".toml")
NOT_COMPARED: Final = "times.csv"
# In every folder that may be removed.
MARK: Final = "made-by-torture"


@dataclass(frozen=True)
class Torture:
    """What is to be done to experiments in a folder.

    Attributes:
        folder: Where; made if it is not there.
        kills: How many.
        seed: When and whom follows from it, as far as the operating system lets it.
        settings: Of the runs.
    """

    folder: Path
    kills: int = 200
    seed: int = 1
    settings: Settings = SETTINGS

    def plan(self, name: str) -> Plan:
        """A run of each condition, in a folder of the torture's."""
        configs = tuple(RunConfig(condition, settings=self.settings) for condition in Condition)
        return Plan(self.folder / name, configs)


def torture(what: Torture, tell: Tell, undisturbed: Path | None = None) -> Tally:
    """Torture experiments until there were enough kills, and compare each with an undisturbed one.

    Args:
        what: Is to be done.
        tell: Is told how it gets on.
        undisturbed: The experiment to compare with, if it was made before.

    Raises:
        TortureError: If a promise was broken; the experiment is then left for inspection.
        ValueError: If something that is not ours stands in the way.
        OSError: If the folder cannot be written, or not watched.
    """
    for left in sorted(what.folder.glob("tortured-*")):
        _refuse_foreign(left)
    make_folder(what.folder)
    tally = Tally()
    if undisturbed is None:
        undisturbed = _make_undisturbed(what, tell)
    while tally.kills < what.kills:
        _one_round(what, undisturbed, tally, tell)
        tell(f"{tally.kills} kills so far; experiment {tally.rounds} has the bits of the undisturbed one")
    return tally


def results_of(folder: Path) -> dict[str, bytes]:
    """Everything in an experiment that follows from its configs, by name."""
    files = (each for each in folder.rglob("*") if each.suffix in COMPARED and each.name != NOT_COMPARED)
    return {str(each.relative_to(folder)): each.read_bytes() for each in sorted(files)}


def _make_undisturbed(what: Torture, tell: Tell) -> Path:
    """The experiment that nobody disturbs; what an earlier torture made of it is taken over."""
    path = what.plan(UNDISTURBED).folder
    tell(f"{path}: an experiment that nobody disturbs")
    done = subprocess.run(  # noqa: S603 - our own program
        python("-m", "evolution", *_command(what, path)), capture_output=True, text=True
    )
    if done.returncode:
        raise TortureError(f"undisturbed, it ended with exit code {done.returncode}: {done.stdout[-500:]}")
    return path


def _one_round(what: Torture, undisturbed: Path, tally: Tally, tell: Tell) -> None:
    """One experiment: refused, killed, finished, damaged, repaired, compared."""
    plan, rng = what.plan(f"tortured-{tally.rounds + 1}"), random.Random(f"{what.seed} {tally.rounds}")  # noqa: S311
    _make_anew(plan.folder)
    runs = tuple(plan.path(each) for each in plan.configs)
    condition = plan.configs[0].condition
    evolve = ("evolve", f"--condition={condition}", *_flags(what.settings), f"--output={runs[0]}")
    refuse_where_files_cannot_grow(evolve, runs[0], tally)
    refuse_where_nothing_can_be_written(evolve, runs[0], tally)
    command, schedule = _command(what, plan.folder), Schedule(what.seed, tally.rounds)
    run_to_its_end(Ordeal(plan.folder, runs, command, schedule, tally, what.kills, tell))
    for run in runs:
        damage_and_repair(run, rng, tally)
    _compare(results_of(undisturbed), results_of(plan.folder), plan.folder)
    tally.rounds += 1
    shutil.rmtree(plan.folder)


def _command(what: Torture, folder: Path) -> tuple[str, ...]:
    """The user's command that reproduces the plan, after `wordarm`."""
    return ("reproduce", "--runs=1", f"--jobs={WORKERS}", *_flags(what.settings), f"--output={folder}")


def _flags(settings: Settings) -> list[str]:
    return [f"--{name.replace('_', '-')}={value}" for name, value in settings.to_mapping().items()]


def _make_anew(folder: Path) -> None:
    """An empty folder with our mark, in the place of one that an earlier torture left; refuse any other."""
    _refuse_foreign(folder)
    shutil.rmtree(folder, ignore_errors=True)
    make_folder(folder)
    write_atomically(folder / MARK, b"wordarm torture made this folder, and removes it.\n")


def _refuse_foreign(folder: Path) -> None:
    """Refuse to remove what no torture made."""
    if os.path.lexists(folder) and (folder.is_symlink() or not (folder / MARK).is_file()):
        raise ValueError(
            f"{folder} is not of an earlier torture (it has no {MARK}), and would be removed; "
            "give another folder, or move it away"
        )


def _compare(expected: dict[str, bytes], found: dict[str, bytes], folder: Path) -> None:
    """Refuse any difference."""
    names = sorted(expected.keys() | found.keys())
    if differing := [each for each in names if expected.get(each) != found.get(each)]:
        raise TortureError(
            f"{folder} differs from the undisturbed experiment in {len(differing)} files: "
            f"{', '.join(differing[:5])}; compare them before you remove it"
        )
