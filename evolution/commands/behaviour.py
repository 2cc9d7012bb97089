"""`wordarm behaviour`: how an agent, or the classes of an experiment, carry out instructions."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Final

from tyro.conf import Positional, arg

from arm2d.tasks.task import papers_condition
from evolution.commands.agent import AgentCommand

if TYPE_CHECKING:
    from rich.table import Table

    from evolution.agents.behaviour import Behaviour
    from evolution.agents.lesions import LesionScores
    from evolution.agents.variance import VarianceShares
    from evolution.runs.sources import Agent


# Trials of each instruction from each start area: of one agent, and of each agent of a class.
OF_AN_AGENT, OF_A_CLASS = 20, 10
AGENTS: Final = 10


@dataclass(frozen=True)
class BehaviourCommand(AgentCommand):
    """Show what an agent does and what goes on inside: trajectories, neurons, lesions, state space.

    For the folder of an experiment that was post-evaluated: how its compositional, partial and
    non-compositional agents do it, which word they follow and which they need. Every run is then the unit:
    its agents are averaged first. Repeat the command to go on where it was stopped.
    """

    source: Annotated[Positional[str], arg(metavar="AGENT|EXPERIMENT")]
    """Run folder, genotype file (.npz, .npy) or name of a shipped champion; or folder of an experiment."""

    trials_per_area: int | None = None
    """Trials of each instruction from each of the two start areas. By default 20, for classes 10."""

    trial_seed: int = 0
    """Start angles and object positions follow from it."""

    output: Path | None = None
    """Folder for the files. By default `behaviour` in the run folder, or in the current one; for classes
    `results` in the experiment's folder."""

    classes: bool = False
    """Classes of agents, also of a run; the folder of an experiment does not need it."""

    agents: int | None = None
    """Of classes: agents of each class and run, at most, distinct and spread over the generations. By
    default 10."""

    figures: bool = True
    """Of classes: only keep the observations beside each run, without tables and figures."""

    def run(self) -> int:
        """Look at an agent, or at classes of agents."""
        if self.classes or _is_experiment(Path(self.source)):
            return self._look_at_classes()
        if self.agents is not None or not self.figures:
            raise ValueError("--agents and --no-figures are about classes; give --classes or an experiment")
        return self._look_at_agent()

    def _look_at_classes(self) -> int:
        from evolution.agents.classes import Sampling
        from evolution.commands.classes import observe_classes

        if self.generation is not None or self.rank or self.condition is not None:
            raise ValueError(
                "--generation, --rank and --condition name one agent; leave them out to look at classes"
            )
        sampling = Sampling(
            AGENTS if self.agents is None else self.agents,
            OF_A_CLASS if self.trials_per_area is None else self.trials_per_area,
            self.trial_seed,
        )
        output = self.output or Path(self.source) / "results"
        observe_classes(Path(self.source), sampling, output if self.figures else None)
        return 0

    def _look_at_agent(self) -> int:
        """Record, silence words, draw and write."""
        from rich.console import Console

        from evolution.agents.behaviour import record_behaviour
        from evolution.agents.lesions import lesion_scores
        from evolution.agents.variance import shares_by_event

        source = self.find_agent()
        condition = papers_condition(source.condition, "this analysis")
        world = (source.genotype, condition, source.readings)
        per_area = OF_AN_AGENT if self.trials_per_area is None else self.trials_per_area
        trials = {"per_area": per_area, "trial_seed": self.trial_seed}
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


def _is_experiment(path: Path) -> bool:
    """Whether a folder holds runs and is none itself."""
    from evolution.runs.folder import CONFIG, LAYOUTS

    if not path.is_dir() or (path / CONFIG).exists():
        return False
    return any(next(path.glob(f"{layout}/{CONFIG}"), None) for layout in LAYOUTS)


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
    for event, own in shares.items():
        word = event.split()[1]  # start, sight, touch
        arrays.update({f"{word}_shares_{name}": array for name, array in own.arrays().items()})
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
