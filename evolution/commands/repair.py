"""`wordarm repair`: damaged or missing files of a run, computed again."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

from tyro.conf import Positional, arg


@dataclass(frozen=True)
class Repair:
    """Compute the damaged or missing files of a run again, with the bits they had."""

    folder: Annotated[Positional[Path], arg(metavar="RUN")]
    """Run folder."""

    def run(self) -> int:
        """Repair what can be repaired."""
        from evolution.trust.repair import repair

        n_repaired = repair(self.folder, print)
        print(f"{self.folder} is sound" + (f": {n_repaired} files repaired" if n_repaired else ""))
        return 0
