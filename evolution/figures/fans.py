"""Trajectory fans by class: one representative agent of each, all nine instructions beneath each other."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from arm2d import Condition, Readings
from arm2d.constants import DT
from arm2d.drawing import COLUMN, FULL, HEADING, SMALL, STYLE, look
from arm2d.records import brief
from evolution.agents.behaviour import Behaviour, record_behaviour
from evolution.agents.classes import Sampling
from evolution.agents.subtasks import AgentClass
from evolution.figures.behaviour import draw_alpha, draw_beta, trajectory_handles
from evolution.figures.page import FAINT, beside, head
from evolution.results.classes import ClassBehaviour
from evolution.results.wording import TITLES
from evolution.runs.recorded import recorded_generation

PER_AREA: Final = 5
ROW: Final = 0.88  # height of an instruction [in]
HEAD, FOOT = 0.98, 0.62  # [in]
ROOM: Final = 0.16  # below it, for a legend of three rows [in]


@dataclass(frozen=True)
class Fan:
    """A class's column.

    Attributes:
        kind: The class.
        name: Of its agent.
        behaviour: Of that agent, in fresh trials.
        readings: Of its world.
    """

    kind: AgentClass
    name: str
    behaviour: Behaviour
    readings: Readings

    __repr__ = brief


def representatives(
    condition: Condition, classes: Mapping[AgentClass, ClassBehaviour], sampling: Sampling
) -> list[Fan]:
    """The classes that have agents, each with one of them in fresh trials.

    It is the observed agent whose success on the nine instructions is nearest to the mean of its class.
    """
    fans = []
    for kind, behaviour in classes.items():
        if behaviour.representative is None:
            continue
        run, generation, rank = behaviour.representative
        genotype = recorded_generation(run, generation).best_genotypes[0, rank]
        name = f"seed {run.config.seed}, generation {generation}, rank {rank}"
        readings = run.config.readings
        trials = {"per_area": PER_AREA, "trial_seed": sampling.trial_seed}
        fans.append(Fan(kind, name, record_behaviour(genotype, condition, readings, **trials), readings))
    return fans


def fans_figure(condition: Condition, fans: Sequence[Fan]) -> Figure:
    """A column for each class, all nine instructions beneath each other."""
    instructions = condition.instructions
    foot = FOOT if len(fans) > 1 else FOOT + ROOM
    height = HEAD + foot + ROW * len(instructions)
    with look(STYLE):
        figure = Figure(figsize=(FULL if len(fans) > 1 else COLUMN, height))
        what = "An agent of each class" if len(fans) > 1 else "An agent of the only class there is"
        trials = f"in {2 * PER_AREA} trials of each instruction"
        head(figure, what, f"{TITLES[condition]}; nearest in success to the mean of its class; {trials}")
        left = 0.45 / figure.get_size_inches()[0]
        grid = figure.add_gridspec(len(instructions), len(fans), hspace=0.42, wspace=0.1)
        grid.update(left=left, right=0.985, top=1 - HEAD / height, bottom=foot / height)
        end = DT * max(int(fan.behaviour.steps.max()) for fan in fans)  # the same for all, to be compared
        for column, fan in enumerate(fans):
            for row, instruction in enumerate(instructions):
                cell = grid[row, column].subgridspec(2, 1, height_ratios=(2.4, 1), hspace=0.08)
                above, below = figure.add_subplot(cell[0]), figure.add_subplot(cell[1])
                draw_alpha(above, fan.behaviour, instruction, fan.readings)
                draw_beta(below, fan.behaviour, instruction)
                _trim(above, below, end, column, row == len(instructions) - 1)
                if row == 0:
                    _title(above, str(fan.kind), 22, fontsize=HEADING, fontweight="bold")
                    _title(above, fan.name, 13.5, fontsize=SMALL, color=FAINT)
        columns = 6 if len(fans) > 1 else 2
        figure.legend(handles=trajectory_handles(), loc="lower center", ncols=columns)
    return figure


def _title(axes: Axes, text: str, height: float, **look: Any) -> None:
    """Text above a column, so many points above its highest panel."""
    beside(axes, text, (0, 1), (0, height), xycoords="axes fraction", **look)


def _trim(above: Axes, below: Axes, end: float, column: int, lowest: bool) -> None:
    """Limits and labels of a pair of panels."""
    for axes in (above, below):
        axes.set_xlim(0, end)
        axes.tick_params(left=not column, labelleft=not column, bottom=lowest and axes is below)
    if not column:
        above.set_ylabel("\u03b1 [°]", fontsize=SMALL)
        below.set_ylabel("\u03b2 [°]", fontsize=SMALL)
    if lowest:
        below.set_xlabel("time [s]")
    else:
        below.tick_params(labelbottom=False)
