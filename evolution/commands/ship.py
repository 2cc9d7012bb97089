"""`wordarm ship`: keep an experiment's notable agents by name."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from tyro.conf import Positional


@dataclass(frozen=True)
class Ship:
    """Write best generaliser, best specialist and best With-Ignore agent to files of their own."""

    experiment: Positional[Path]
    """Folder of an experiment that was post-evaluated."""

    output: Path = Path("champions")
    """Folder for the files; those in evolution/champions are known by their names."""

    def run(self) -> int:
        """Choose, write and print."""
        from evolution.experiments.experiment import open_experiment
        from evolution.results.analysis import analyse
        from evolution.results.notable import ship

        for path in ship(analyse(open_experiment(self.experiment)), self.output):
            print(path)
        return 0
