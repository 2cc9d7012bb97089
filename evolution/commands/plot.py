"""`wordarm plot`: the fitness of a run, finished or not."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from tyro.conf import Positional, arg

if TYPE_CHECKING:
    from evolution.runs.folder import RunFolder


@dataclass(frozen=True)
class Plot:
    """Draw best and mean fitness of a run over its generations, even while it is going on."""

    folder: Annotated[Positional[Path], arg(metavar="RUN")]
    """Run folder."""

    output: Path | None = None
    """Folder for the figure. By default `evaluation` in the run folder."""

    def run(self) -> int:
        """Draw what is recorded so far."""
        from evolution.runs.folder import RunFolder
        from evolution.runs.storage import make_folder

        run_folder = RunFolder.open(self.folder)
        output = self.output or self.folder / "evaluation"
        make_folder(output)
        for path in write_fitness_curve(run_folder, output):
            print(path)
        return 0


def write_fitness_curve(run_folder: RunFolder, output: Path) -> list[Path]:
    """Write fitness.png and fitness.svg; their paths."""
    from evolution.figures.page import save_figure
    from evolution.figures.run import fitness_curve
    from evolution.runs.recorded import recorded_history

    history = recorded_history(run_folder)
    config = run_folder.config
    origin = f"{config.condition}, seed {config.seed}, {len(history)} generations"
    return save_figure(fitness_curve(history, origin), output / "fitness")
