"""`wordarm lineage`: the ancestors of an agent, and what they could do."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from tyro.conf import Positional, arg

if TYPE_CHECKING:
    from rich.table import Table

    from evolution.agents.lineage import Lineage
    from evolution.agents.lineage_scores import LineageScores
    from evolution.runs.folder import RunFolder


@dataclass(frozen=True)
class LineageCommand:
    """Rebuild an agent's line of ancestors and show when each skill came."""

    folder: Annotated[Positional[Path], arg(metavar="RUN")]
    """Run folder, finished or not."""

    generation: int | None = None
    """Generation of the agent, from 0. By default the last one."""

    rank: int = 0
    """0 is the best of the generation."""

    trials_per_area: int = 10
    """Trials of each instruction from each of the two start areas, for every ancestor."""

    trial_seed: int = 0
    """Start angles and object positions follow from it."""

    output: Path | None = None
    """Folder for the files. By default `lineage` in the run folder."""

    def run(self) -> int:
        """Rebuild, score, draw and write."""
        from rich.console import Console
        from rich.progress import Progress

        from evolution.agents.lineage import trace_lineage
        from evolution.agents.lineage_scores import score_lineage
        from evolution.runs.folder import RunFolder

        folder = RunFolder.open(self.folder)
        if self.trials_per_area < 1:
            raise ValueError(f"asked for {self.trials_per_area} trials per area; there must be at least 1")
        console, condition = Console(), folder.config.papers_condition
        lineage = trace_lineage(folder, self.generation, self.rank)
        with Progress(console=console, transient=True, disable=not console.is_terminal) as bar:
            task = bar.add_task("ancestors")
            scores = score_lineage(
                lineage,
                condition,
                folder.config.readings,
                per_area=self.trials_per_area,
                trial_seed=self.trial_seed,
                on_ancestor=lambda done, total: bar.update(task, completed=done, total=total),
            )
        paths = _write(folder, lineage, scores, self.rank, self.output or self.folder / "lineage")
        console.print(_table(lineage, scores))
        for path in paths:
            print(path)
        return 0


def _write(folder: RunFolder, lineage: Lineage, scores: LineageScores, rank: int, output: Path) -> list[Path]:
    """Write figure and arrays; their paths."""
    from evolution.agents.innovations import lineage_arrays
    from evolution.figures.lineage import lineage_figure
    from evolution.figures.page import save_figure
    from evolution.runs.storage import make_folder, write_arrays

    make_folder(output)
    generation = len(lineage) - 1
    stem = output / f"generation-{generation:06d}-rank-{rank}"
    config = folder.config
    origin = f"{config.condition}, seed {config.seed}, generation {generation}, rank {rank}"
    paths = save_figure(lineage_figure(scores, origin), stem)
    paths.append(stem.with_name(f"{stem.name}.npz"))
    write_arrays(paths[-1], lineage_arrays(lineage, scores, origin))
    return paths


def _table(lineage: Lineage, scores: LineageScores) -> Table:
    """Skills in the order in which they first came."""
    from rich.table import Table

    from evolution.agents.innovations import innovations

    title = f"{lineage.distinct.shape[0]} distinct ancestors in {len(lineage)} generations"
    table = Table("skill", "first came", "for good", "agent", title=title)
    for came in innovations(scores):
        table.add_row(came.skill, _number(came.first), _number(came.for_good), f"{100 * came.agent:.0f} %")
    return table


def _number(generation: int) -> str:
    return f"{generation:,}" if generation >= 0 else "never"
