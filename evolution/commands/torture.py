"""`wordarm torture`: whether a file system keeps what runs rely on."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from tyro.conf import Positional


@dataclass(frozen=True)
class TortureCommand:
    """Kill, starve and damage small experiments; each must end with the bits of an undisturbed one.

    For who wants to know whether a file system, such as a cluster's, can be trusted with runs. Linux only.
    """

    folder: Positional[Path]
    """Folder on the file system in question; experiments are made and removed below it."""

    kills: int = 200
    """Processes to be killed."""

    seed: int = 1
    """When and whom follows from it."""

    def run(self) -> int:
        """Torture and print the tally."""
        from evolution.trust.torture import Torture, torture

        if not 1 <= self.kills <= 100_000:
            raise ValueError(f"asked for {self.kills} kills; give 1 to 100000")
        what = Torture(self.folder.resolve(), self.kills, self.seed)
        tally = torture(what, lambda line: print(line, flush=True))
        for line in tally.lines():
            print(line)
        return 0
