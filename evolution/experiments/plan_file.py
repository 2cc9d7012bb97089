"""plan.toml: which runs an experiment is meant to have, so that whoever looks at its folder knows them too.

No result depends on it; each run has its config.toml. It is written anew by every command that carries out
a plan.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any, Final

import tomli_w

from arm2d import Condition, Readings
from arm2d.files import NoFileError, read_file
from evolution.experiments.plan import Plan
from evolution.experiments.variants import check_name
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
    """The text of plan.toml: one table for each variant and condition, with its seeds."""
    seeds: dict[RunConfig, list[int]] = {}
    for each in plan.configs:
        seeds.setdefault(replace(each, seed=0), []).append(each.seed)
    tables = [
        {
            "name": plan.variants[shared.readings, shared.settings],
            "condition": str(shared.condition),
            "seeds": found,
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
    """
    path = folder / FILE
    try:
        text = read_file(path, LONGEST).decode()
    except FileNotFoundError:
        return None
    except (OSError, ValueError):
        raise _unsound(path, "it cannot be read") from None
    try:
        return _plan_of(folder, read_toml(text, LONGEST))
    except (ValueError, KeyError, TypeError, AttributeError) as error:
        raise _unsound(path, " ".join(str(error).split())) from None


def _plan_of(folder: Path, values: dict[str, Any]) -> Plan:
    """A plan from the values of its file; any of several errors if they are none."""
    if values["format"] != FORMAT:
        raise ValueError(f"format {values['format']!r} is not known here; this version reads format {FORMAT}")
    configs, names = [], {}
    for table in values["runs"]:
        base = RunConfig(
            Condition.parse(table["condition"]),
            0,
            Settings.from_mapping(table["settings"]),
            Readings.from_mapping(table["readings"]),
        )
        names[base.readings, base.settings] = check_name(table["name"])
        configs += [replace(base, seed=seed) for seed in table["seeds"]]
    return Plan(folder, tuple(configs), values["post_evaluate"] is True, names)


def _holds(path: Path, text: bytes) -> bool:
    """Whether a file is this text."""
    try:
        return read_file(path, len(text)) == text
    except (OSError, NoFileError):
        return False


def _unsound(path: Path, found: str) -> ValueError:
    return ValueError(f"{path} cannot be understood ({found}); repeat the command that made it, or remove it")
