"""`wordarm behaviour`: how an agent carries out its instructions."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from evolution.commands.agent import AgentCommand

if TYPE_CHECKING:
    from rich.table import Table

    from evolution.agents.behaviour import Behaviour
    from evolution.agents.lesions import LesionScores
    from evolution.agents.variance import VarianceShares
    from evolution.runs.sources import Agent


@dataclass(frozen=True)
class BehaviourCommand(AgentCommand):
    """Show what an agent does and what goes on inside: trajectories, neurons, lesions, state space."""

    trials_per_area: int = 20
    """Trials of each instruction from each of the two start areas."""

    trial_seed: int = 0
    """Start angles and object positions follow from it."""

    output: Path | None = None
    """Folder for the files. By default `behaviour` in the run folder, or in the current one."""

    def run(self) -> int:
        """Record, silence words, draw and write."""
        from rich.console import Console

        from evolution.agents.behaviour import record_behaviour
        from evolution.agents.lesions import lesion_scores
        from evolution.agents.variance import shares_by_event

        source = self.find_agent()
        world = (source.genotype, source.condition, source.readings)
        trials = {"per_area": self.trials_per_area, "trial_seed": self.trial_seed}
        behaviour = record_behaviour(*world, **trials)
        lesions = lesion_scores(*world, **trials)
        shares = shares_by_event(behaviour)
        home = Path() if source.folder is None else source.folder.path
        paths = _write(source, behaviour, lesions, shares, self.output or home / "behaviour")
        console = Console()
        console.print(_shares_table(shares, source.origin))
        console.print(_lesions_table(lesions))
        for path in paths:
            print(path)
        return 0


def _write(
    source: Agent,
    behaviour: Behaviour,
    lesions: LesionScores,
    shares: dict[str, VarianceShares],
    output: Path,
) -> list[Path]:
    """Write figures and arrays; their paths."""
    from evolution.figures.behaviour import lesions_figure, trajectories_figure
    from evolution.figures.neurons import activity_figure, variance_figure
    from evolution.figures.page import save_figure
    from evolution.figures.states import state_space_figure
    from evolution.runs.storage import make_folder, write_arrays

    make_folder(output)
    origin = source.origin
    figures = {
        "trajectories": trajectories_figure(behaviour, source.readings, origin),
        "activity": activity_figure(behaviour, origin),
        "variance": variance_figure(shares, origin),
        "lesions": lesions_figure(lesions, origin),
        "state-space": state_space_figure(behaviour, origin),
    }
    paths = []
    for name, figure in figures.items():
        paths += save_figure(figure, output / f"{source.name}-{name}")
    paths.append(output / f"{source.name}-behaviour.npz")
    arrays = {**behaviour.arrays(), **lesions.arrays()}
    for event, each in shares.items():
        word = event.split()[1]  # start, sight, touch
        arrays.update({f"{word}_shares_{name}": array for name, array in each.arrays().items()})
    write_arrays(paths[-1], arrays)
    return paths


def _shares_table(shares: dict[str, VarianceShares], origin: str) -> Table:
    """Mean shares of variance before and after first sight, and after first touch."""
    from rich.table import Table

    from evolution.agents.variance import WINDOWS

    table = Table("share of the neurons' variance", "object word", "action word", "both", title=origin)
    for name, (event, start, stop) in WINDOWS.items():
        values = shares[event].mean(start, stop)
        table.add_row(name, *("-" if value != value else f"{100 * value:.0f} %" for value in values))
    return table


def _lesions_table(scores: LesionScores) -> Table:
    """Success of the experienced instructions, and of all nine, with each lesion."""
    from rich.table import Table

    from evolution.agents.lesions import LESIONS

    condition = scores.condition
    known = [condition.instructions.index(each) for each in condition.experienced]
    table = Table("lesion", "experienced", "all nine", title="mean success")
    rows = [("none", scores.intact[0])]
    rows += [
        (f"{each.word} word {each.manner} {each.time}", scores.lesioned[0, i])
        for i, each in enumerate(LESIONS)
    ]
    for name, shares in rows:
        table.add_row(name, f"{100 * shares[known].mean():.0f} %", f"{100 * shares.mean():.0f} %")
    return table
