"""`wordarm status`: how far an experiment has come, from its files."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from tyro.conf import Positional


@dataclass(frozen=True)
class Status:
    """Show how far the runs of an experiment have come; nothing is written, whoever else is at work."""

    path: Positional[Path]
    """Experiment folder, or the folder of one run."""

    def run(self) -> int:
        """Read and print once."""
        from rich.console import Console

        from evolution.experiment import open_experiment
        from evolution.live_table import run_table
        from evolution.standing import pace_of, standing_of

        runs = open_experiment(self.path).all_runs
        standings = [standing_of(run.path, run.config) for run in runs]
        at_work = sum(each.at_work for each in standings)
        Console().print(run_table(standings, pace_of(runs), max(at_work, 1)))
        return 0
