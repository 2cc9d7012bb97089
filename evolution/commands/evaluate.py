"""`wordarm evaluate`: one agent on all nine instructions."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from tyro.conf import Positional

from arm2d import Condition

if TYPE_CHECKING:
    from evolution.evaluation import Evaluation
    from evolution.sources import Source


@dataclass(frozen=True)
class Evaluate:
    """Let an agent carry out all nine instructions: a table, a heat map and, for a run, its fitness."""

    source: Positional[str]
    """Run folder, genotype file (.npz, .npy) or name of a shipped champion."""

    generation: int | None = None
    """Generation of the run, from 0. By default its champions are meant."""

    rank: int = 0
    """0 is the best of the generation, of the champions, or of the file."""

    condition: str | None = None
    """Condition of a bare genotype file: with-indicate (the default) or with-ignore."""

    trials_per_area: int = 40
    """Trials of each instruction from each of the two start areas."""

    trial_seed: int = 0
    """Start angles and object positions follow from it."""

    output: Path | None = None
    """Folder for the files. By default `evaluation` in the run folder, or in the current one."""

    def run(self) -> int:
        """Evaluate, print and write."""
        from rich.console import Console

        from evolution.evaluation import evaluate
        from evolution.sources import find_source
        from evolution.tables import terminal_table

        condition = None if self.condition is None else Condition.parse(self.condition)
        source = find_source(self.source, generation=self.generation, rank=self.rank, condition=condition)
        result = evaluate(
            source.genotype,
            source.condition,
            source.readings,
            per_area=self.trials_per_area,
            trial_seed=self.trial_seed,
        )
        home = Path() if source.folder is None else source.folder.path
        folder = self.output or home / "evaluation"
        paths = _write(source, result, folder)
        console = Console()
        console.print(terminal_table(result, source.origin))
        for path in paths:
            print(path)
        return 0


def _write(source: Source, result: Evaluation, folder: Path) -> list[Path]:
    """Write figures and tables; their paths."""
    from evolution.figures import heat_map, save_figure
    from evolution.storage import make_folder, write_atomically
    from evolution.tables import to_csv, to_json

    make_folder(folder)
    paths = save_figure(heat_map(result, source.origin), folder / f"{source.name}-heat-map")
    for suffix, text in ((".csv", to_csv(result)), (".json", to_json(result, source))):
        paths.append(folder / f"{source.name}{suffix}")
        write_atomically(paths[-1], text.encode())
    if source.folder:
        from evolution.commands.plot import write_fitness_curve

        paths += write_fitness_curve(source.folder, folder)
    return paths
