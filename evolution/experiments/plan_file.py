"""plan.toml: which runs an experiment is meant to have, and how far all runs in its folder have come.

No result depends on it; each run has its config.toml. It is written anew by every command that carries out
a plan.
"""

from __future__ import annotations

import os
from dataclasses import replace
from pathlib import Path
from typing import Any, Final

import tomli_w

from arm2d import Readings
from arm2d.files import NoFileError, read_file
from arm2d.tasks.task import read_task
from evolution.experiments.experiment import open_experiment
from evolution.experiments.plan import Plan
from evolution.experiments.standing import Standing, standing_of
from evolution.experiments.variants import Variant, check_name
from evolution.runs.folder import CONFIG, LAYOUTS, RunFolder
from evolution.runs.storage import make_folder, write_atomically
from evolution.search.config import FORMAT, RunConfig
from evolution.search.settings import Settings
from evolution.search.toml import read_toml

FILE: Final = "plan.toml"
# A hundred thousand seeds, one a line.
LONGEST: Final = 4_000_000
HEADING: Final = "# The runs this folder is meant to hold; written by wordarm, for wordarm status.\n"


def write_plan(plan: Plan) -> None:
    """Write a plan's file, unless it is there already.

    Raises:
        OSError: If it cannot be written.
    """
    make_folder(plan.folder)
    path, text = plan.folder / FILE, plan_text(plan).encode()
    if not _holds(path, text):
        write_atomically(path, text)


def plan_text(plan: Plan) -> str:
    """The text of plan.toml: a table for each variant and condition, with its seeds and those known."""
    seeds: dict[RunConfig, list[int]] = {}
    for config in plan.configs:
        seeds.setdefault(replace(config, seed=0), []).append(config.seed)
    known = {
        shared: [seed for seed in found if replace(shared, seed=seed) in plan.known]
        for shared, found in seeds.items()
    }
    tables = [
        {
            "name": plan.variants[Variant.of(shared)],
            "condition": shared.task.condition_name,
            **({"task": special} if (special := shared.task.to_mapping()) else {}),
            "seeds": found,
            **({"known": known[shared]} if known[shared] else {}),
            "settings": shared.settings.to_mapping(),
            "readings": shared.readings.to_mapping(),
        }
        for shared, found in seeds.items()
    ]
    values = {"format": FORMAT, "post_evaluate": plan.post_evaluate, "runs": tables}
    return HEADING + tomli_w.dumps(values)


def read_plan(folder: Path) -> Plan | None:
    """The plan of an experiment; None if it has none.

    Raises:
        ValueError: If its file cannot be understood.
        OSError: If it cannot be read.
    """
    path = folder / FILE
    try:
        text = read_file(path, LONGEST).decode()
    except FileNotFoundError:
        return None
    except OSError as error:
        raise OSError(f"{path} cannot be read: {error.strerror}") from None
    except ValueError:
        raise _unsound(path, "it is not text in UTF-8") from None
    try:
        return _plan_of(folder, read_toml(text, LONGEST))
    except (ValueError, KeyError, TypeError, AttributeError) as error:
        raise _unsound(path, " ".join(str(error).split())) from None


def _plan_of(folder: Path, values: dict[str, Any]) -> Plan:
    """A plan from the values of its file; any of several errors if they are none."""
    if values["format"] != FORMAT:
        raise ValueError(f"format {values['format']!r} is not known here; this version reads format {FORMAT}")
    configs, known, names = [], set(), {}
    for table in values["runs"]:
        base = RunConfig(
            read_task(table["condition"], table.get("task")),
            0,
            Settings.from_mapping(table["settings"]),
            Readings.from_mapping(table["readings"]),
        )
        names[Variant.of(base)] = check_name(table["name"])
        configs += [replace(base, seed=seed) for seed in table["seeds"]]
        known |= {replace(base, seed=seed) for seed in table.get("known", ())}
    return Plan(folder, tuple(configs), values["post_evaluate"] is True, names, known)


def experiment_standings(path: Path) -> tuple[dict[Path, Standing], list[str]]:
    """The standing of every run, by its folder, and a sentence for every file that cannot be understood.

    Args:
        path: Folder of an experiment, of one of its variants, or of a run. First come the runs of its plan,
            then others that are found.

    Raises:
        ValueError: If there is neither run nor plan, or none of them can be understood.
        OSError: If the folder cannot be read.
    """
    _refuse_what_is_no_folder(path)
    plan, unreadable = _plan_or_sentence(path)
    standings = {plan.path(each): plan.standing(each) for each in plan.configs} if plan else {}
    to_be_tested = _tests_belong_to(path.absolute())
    for folder in _folders_of_runs(path):
        if folder in standings:
            continue
        try:
            config = RunFolder.open(folder).config
        except OSError as error:
            unreadable.append(f"{folder} cannot be read: {error.strerror}")
            continue
        except ValueError as error:
            unreadable.append(str(error))
            continue
        variant = folder.parts[-3] if len(folder.relative_to(path).parts) == 3 else ""
        standings[folder] = standing_of(folder, config, variant=variant, to_be_tested=to_be_tested)
    if not standings and unreadable:
        raise ValueError("; ".join(unreadable))
    if not standings:
        open_experiment(path)  # says what would be right
    return standings, unreadable


def _folders_of_runs(path: Path) -> list[Path]:
    """The folders with a config.toml at the places of runs, and those that may not be looked into."""
    found = []
    for folder in (path, *sorted(each for layout in LAYOUTS for each in path.glob(layout))):
        try:
            if (folder / CONFIG).exists():
                found.append(folder)
        except OSError:
            found.append(folder)
    return found


def _refuse_what_is_no_folder(path: Path) -> None:
    """Say what a path is that leads to no folder, or to one that may not be read."""
    try:
        os.listdir(path)
    except FileNotFoundError:
        raise ValueError(f"{path} is not there; give the folder of an experiment or of a run") from None
    except NotADirectoryError:
        raise ValueError(f"{path} is not a folder; give that of an experiment or of a run") from None
    except OSError as error:
        raise OSError(f"{path} cannot be read: {error.strerror}; ask whoever owns it") from None


def _plan_or_sentence(folder: Path) -> tuple[Plan | None, list[str]]:
    """The plan of an experiment, if there is one, or what is wrong with it."""
    try:
        return read_plan(folder), []
    except (ValueError, OSError) as error:
        return None, [str(error)]


def _tests_belong_to(path: Path) -> bool | None:
    """Whether post-evaluation is part of the runs, as a plan here or above says; None if there is none."""
    for above in (path, *path.parents[:3]):
        if plan := _plan_or_sentence(above)[0]:
            return plan.post_evaluate
    return None


def _holds(path: Path, text: bytes) -> bool:
    """Whether a file is this text."""
    try:
        return read_file(path, len(text)) == text
    except (OSError, NoFileError):
        return False


def _unsound(path: Path, found: str) -> ValueError:
    return ValueError(f"{path} cannot be understood ({found}); repeat the command that made it, or remove it")
