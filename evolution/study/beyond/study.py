"""The study as a whole: which runs it has, where their rows are kept, and what is written of them."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Final

from evolution.experiments.plan_file import read_plan
from evolution.study.beyond.cells import GENERATIONS, beyond
from evolution.study.beyond.results import write_results
from evolution.study.beyond.rows import MEASUREMENT, CellRun
from evolution.study.declared.parts import DeclaredPart
from evolution.study.declared.plan import RowFile

ROWS: Final = "rows.csv"


class BeyondStudy:
    """The runs of all cells, in one folder."""

    def __init__(self, folder: Path, generations: int | None = None) -> None:
        """Nothing is read yet.

        Args:
            folder: Of the study.
            generations: Of every run, by default as declared.
        """
        self.folder = folder
        self.part = beyond(generations or GENERATIONS)

    def rows(self, part: DeclaredPart) -> RowFile[CellRun]:
        """The file of rows.

        Raises:
            ValueError: If the folder is that of another experiment.
        """
        self._refuse_other(part)
        return RowFile(self.folder / ROWS, part, MEASUREMENT)

    def write(
        self, part: DeclaredPart, runs: Sequence[CellRun], results: Path
    ) -> tuple[list[Path], list[str]]:
        """Write what these runs say by now: files, and sentences.

        Raises:
            ValueError: If there are none.
            OSError: If a file cannot be written.
        """
        return write_results(runs, results)

    def _refuse_other(self, part: DeclaredPart) -> None:
        """Refuse a folder that was begun with other runs, before anything is written."""
        plan, own = read_plan(self.folder), set(part.configs)
        strange = next((each for each in plan.configs if each not in own), None) if plan else None
        if strange is not None:
            raise ValueError(
                f"{self.folder} was begun with other runs, such as {strange.condition}, seed {strange.seed}, "
                "that are not of this study with these readings and generations; choose another output folder"
            )
