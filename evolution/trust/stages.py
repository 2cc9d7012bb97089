"""Which file of an experiment is which, and how likely a kill is while it is written."""

from __future__ import annotations

import random
from pathlib import Path
from typing import Final

from arm2d.files import final_name, is_temporary
from evolution.agents import solving
from evolution.agents.postevaluation import POST_EVALUATION
from evolution.agents.transitions import TRANSITION_TEST
from evolution.runs.folder import CHAMPIONS, CHECKPOINT, CONFIG, META, PARTS

# What is written, and the share of its writes at which somebody is killed. What comes seldom is hit more
# often; what is written at every start, or a dozen times by one process, less: else nothing would get on.
SHARES: Final = {
    "config": 0.6,
    "meta": 0.08,
    "part": 0.45,
    "checkpoint": 0.4,
    "champions": 0.7,
    "post-evaluation part": 0.5,
    "transition part": 0.5,
    "solved trials": 0.7,
    "lineage": 0.15,
    "behaviour": 0.07,
    "results": 0.02,
    "report": 0.5,
    "other file": 0.0,
}
NAMES: Final = {
    CONFIG: "config", META: "meta", CHECKPOINT: "checkpoint", CHAMPIONS: "champions",
    solving.FILE: "solved trials", "report.html": "report",
}  # fmt: skip
FOLDERS: Final = {
    PARTS: "part", POST_EVALUATION.folder: "post-evaluation part", TRANSITION_TEST.folder: "transition part",
    "lineage": "lineage", "behaviour": "behaviour", "results": "results",
}  # fmt: skip
# Folders of a run that can be made, and watched, before anything stands in them.
RUN_FOLDERS: Final = (PARTS, POST_EVALUATION.folder, TRANSITION_TEST.folder, "lineage", "behaviour")


def stage_of(path: Path) -> str:
    """What a file, or the temporary file that becomes it, is."""
    name = final_name(path.name)
    return NAMES.get(name) or FOLDERS.get(path.parent.name, "other file")


def temporaries(folder: Path) -> set[Path]:
    """The files below a folder that are unfinished."""
    return {each for each in folder.rglob(".*.tmp") if is_temporary(each.name)}


class Schedule:
    """When to kill whom: drawn for the n-th write of each file, whatever else goes on.

    The operating system decides how the processes take turns, so two tortures with one seed are alike, but
    not the same to the last instruction.
    """

    def __init__(self, seed: int, number: int) -> None:
        self._place = f"{seed} {number}"
        self._seen: dict[str, int] = {}

    def draw(self, file: Path) -> random.Random:
        """The generator of the next event of a file; the same for the same event."""
        name = f"{file.parent.parent.name}/{file.parent.name}/{final_name(file.name)}"
        self._seen[name] = n = self._seen.get(name, 0) + 1
        return random.Random(f"{self._place} {name} {n}")  # noqa: S311 - no secret
