"""`wordarm status`: how far an experiment has come, from its files."""

from __future__ import annotations

import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Final

from tyro.conf import Positional, arg

MOST_ROWS: Final = 60


@dataclass(frozen=True)
class Status:
    """Show how far the runs of an experiment have come; nothing is written, whoever else is at work."""

    path: Positional[Path]
    """Experiment folder, with variants or without, or the folder of one run."""

    every_run: Annotated[bool, arg(name="all")] = False
    """A row for each run, however many there are; else more than 60 are summed up."""

    def run(self) -> int:
        """Read and print once."""
        from rich.console import Console

        from evolution.experiments.live_table import run_table
        from evolution.experiments.plan_file import experiment_standings
        from evolution.experiments.standing import pace_of
        from evolution.runs.folder import RunFolder

        standings, unreadable = experiment_standings(self.path)
        at_work = sum(each.at_work for each in standings.values())
        started = [RunFolder(path, each.config) for path, each in standings.items() if each.generations]
        most_rows = None if self.every_run else MOST_ROWS
        # A pipe has no width: nothing is to be cut there.
        console = Console(highlight=False, markup=False, soft_wrap=not sys.stdout.isatty())
        width = None if console.soft_wrap else console.width
        console.print(
            run_table(list(standings.values()), pace_of(started), max(at_work, 1), most_rows, width)
        )
        for sentence in unreadable:
            console.print(sentence, style="red")
        return 0
