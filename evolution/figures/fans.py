"""Trajectory fans by class: one representative agent of each, all nine instructions beneath each other."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Final

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from arm2d import Condition
from arm2d.constants import DT
from arm2d.drawing import look
from evolution.agents.behaviour import record_behaviour
from evolution.agents.classes import Sampling
from evolution.agents.subtasks import AgentClass
from evolution.figures.behaviour import draw_alpha, draw_beta, trajectory_handles
from evolution.figures.page import FAINT, STYLE, beside, head
from evolution.results.classes import ClassBehaviour
from evolution.results.wording import TITLES
from evolution.runs.recorded import recorded_generation

PER_AREA: Final = 5
ROW: Final = 1.16  # height of an instruction [in]
HEAD, FOOT = 1.25, 0.75  # [in]


def fans_figure(
    condition: Condition, classes: Mapping[AgentClass, ClassBehaviour], sampling: Sampling
) -> Figure | None:
    """A column for each class that has agents: its representative in fresh trials; None if no class has.

    The representative is the observed agent whose success on the nine instructions is nearest to the mean
    of its class.
    """
    shown = {
        kind: behaviour.representative for kind, behaviour in classes.items() if behaviour.representative
    }
    if not shown:
        return None
    instructions = condition.instructions
    height = HEAD + FOOT + ROW * len(instructions)
    with look(STYLE):
        figure = Figure(figsize=(3.35 * len(shown) + 0.6, height))
        what = "An agent of each class" if len(shown) > 1 else "An agent of the only class there is"
        head(figure, what, f"{TITLES[condition]}; nearest in success to the mean of its class")
        left = 0.75 / figure.get_size_inches()[0]
        grid = figure.add_gridspec(len(instructions), len(shown), hspace=0.42, wspace=0.1)
        grid.update(left=left, right=0.985, top=1 - HEAD / height, bottom=FOOT / height)
        for column, (kind, (run, generation, rank)) in enumerate(shown.items()):
            genotype = recorded_generation(run, generation).best_genotypes[0, rank]
            readings = run.config.readings
            behaviour = record_behaviour(
                genotype, condition, readings, per_area=PER_AREA, trial_seed=sampling.trial_seed
            )
            end = DT * behaviour.steps.max()
            for row, instruction in enumerate(instructions):
                cell = grid[row, column].subgridspec(2, 1, height_ratios=(2.4, 1), hspace=0.08)
                above, below = figure.add_subplot(cell[0]), figure.add_subplot(cell[1])
                draw_alpha(above, behaviour, instruction, readings)
                draw_beta(below, behaviour, instruction)
                _trim(above, below, end, column, row == len(instructions) - 1)
                if row == 0:
                    name = f"seed {run.config.seed}, generation {generation}, rank {rank}"
                    _title(above, str(kind), 32, fontsize=11.5, fontweight="bold")
                    _title(above, name, 20, fontsize=8.5, color=FAINT)
        handles = trajectory_handles()
        figure.legend(
            handles=handles, loc="lower center", frameon=False, ncols=min(5, 2 * len(shown)), fontsize=8
        )
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
        above.set_ylabel("alpha [°]", fontsize=8)
        below.set_ylabel("beta", fontsize=8)
    if lowest:
        below.set_xlabel("time [s]", fontsize=9)
    else:
        below.tick_params(labelbottom=False)
