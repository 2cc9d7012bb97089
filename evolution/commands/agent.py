"""Commands about one agent: how the agent is named, and `wordarm evaluate`."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from tyro.conf import Positional, arg

from arm2d.tasks.task import as_paper

if TYPE_CHECKING:
    from evolution.runs.folder import RunFolder
    from evolution.runs.sources import Agent
    from evolution.search.evaluation import Evaluation


@dataclass(frozen=True)
class AgentCommand:
    """The options of a command about one agent."""

    source: Annotated[Positional[str], arg(metavar="AGENT")]
    """Run folder, genotype file (.npz, .npy) or name of a shipped champion."""

    generation: int | None = None
    """Generation of the run, from 0. By default its champions are meant; before its end, the newest."""

    rank: int = 0
    """0 is the best of the generation, of the champions, or of the file."""

    condition: str | None = None
    """Condition of a bare genotype file: with-indicate (the default), with-ignore or with-both."""

    def find_agent(self) -> Agent:
        """The agent's genotype and its world."""
        from evolution.runs.sources import find_agent

        condition = None if self.condition is None else as_paper(self.condition)
        return find_agent(self.source, generation=self.generation, rank=self.rank, condition=condition)


@dataclass(frozen=True)
class Evaluate(AgentCommand):
    """Let an agent carry out all instructions: a table, a heat map and, for a run, its fitness."""

    trials_per_area: int = 40
    """Trials of each instruction from each of the two start areas."""

    trial_seed: int = 0
    """Start angles and object positions follow from it."""

    output: Path | None = None
    """Folder for the files. By default `evaluation` in the run folder, or in the current one."""

    def run(self) -> int:
        """Evaluate, print and write."""
        from rich.console import Console

        from evolution.report.evaluation import terminal_table
        from evolution.search.evaluation import evaluate

        source = self.find_agent()
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


def _write(source: Agent, result: Evaluation, folder: Path) -> list[Path]:
    """Write figures and tables; their paths."""
    from evolution.figures.page import save_figure
    from evolution.figures.run import heat_map
    from evolution.report.evaluation import instruction_table, to_json
    from evolution.runs.storage import make_folder, write_atomically

    make_folder(folder)
    paths = save_figure(heat_map(result, source.origin), folder / f"{source.name}-heat-map")
    for suffix, text in ((".csv", instruction_table(result).to_csv()), (".json", to_json(result, source))):
        paths.append(folder / f"{source.name}{suffix}")
        write_atomically(paths[-1], text.encode())
    if source.folder:
        paths += _write_fitness_curve(source.folder, folder)
    return paths


def _write_fitness_curve(run_folder: RunFolder, output: Path) -> list[Path]:
    """Write fitness.png and fitness.svg; their paths."""
    from evolution.figures.page import save_figure
    from evolution.figures.run import fitness_curve
    from evolution.runs.recorded import recorded_history

    history = recorded_history(run_folder)
    config = run_folder.config
    origin = f"{config.condition}, seed {config.seed}, {len(history)} generations"
    figure = fitness_curve(history, origin, config.task.largest_fitness)
    return save_figure(figure, output / "fitness")
