"""`wordarm doctor`: what works on this machine, and whether its file system keeps what runs rely on."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Final

UNWELL: Final = 1
# Unless told otherwise: enough for a night's doubt, some minutes on two cores.
KILLS: Final = 200
SEED: Final = 1


@dataclass(frozen=True)
class Doctor:
    """Examine this machine: packages, drawing without a screen, cores, cache, disk, video encoder, robots.

    Exit code 1 if something that is needed is missing. With --torture a file system is examined instead.
    """

    torture: Path | None = None
    """Folder on a file system, such as a cluster's: kill, starve and damage small experiments below it, each
    of which must end with the bits of an undisturbed one. Linux only."""

    kills: int | None = None
    """With --torture, processes to be killed. By default 200."""

    seed: int | None = None
    """With --torture, when and whom follows from it. By default 1."""

    def run(self) -> int:
        """Examine and print."""
        if self.torture is not None:
            return self._torture(self.torture)
        if self.kills is not None or self.seed is not None:
            raise ValueError("--kills and --seed are about --torture FOLDER; give it too, or leave them out")
        from mujoco_port.doctor.examination import examine, report
        from mujoco_port.doctor.findings import lacks

        findings = examine()
        print(report(findings))
        return UNWELL if lacks(findings) else 0

    def _torture(self, folder: Path) -> int:
        """Torture and print the tally."""
        from evolution.trust.torture import Torture, torture

        kills = KILLS if self.kills is None else self.kills
        if not 1 <= kills <= 100_000:
            raise ValueError(f"asked for {kills} kills; give 1 to 100000")
        what = Torture(folder.resolve(), kills, SEED if self.seed is None else self.seed)
        tally = torture(what, lambda line: print(line, flush=True))
        for line in tally.lines():
            print(line)
        return 0
