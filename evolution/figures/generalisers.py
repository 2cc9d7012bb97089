"""Compositional agents over time: a row for each run, with five lanes, one for each rank of a generation.

Fully compositional agents are few; each is a mark of its own, however many others lie about it.
"""

from __future__ import annotations

from typing import Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import to_rgba
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from numpy.typing import NDArray

from arm2d.drawing import FULL, INK, SMALL, STYLE, look
from evolution.agents.subtasks import AgentClass, classify
from evolution.figures.page import CLASS_COLOURS, FAINT, RIGHT_END, beside
from evolution.results.generalisers import Generalisers
from evolution.results.records import ConditionResults, Results
from evolution.results.wording import TITLES
from evolution.search.settings import N_BEST

FULL_COLOUR, PARTIAL_COLOUR = CLASS_COLOURS[AgentClass.FULL], CLASS_COLOURS[AgentClass.PARTIAL]
# Heights of rows: of runs with a fully compositional agent, with partial ones only, with neither [in].
TALL, MIDDLE, FLAT = 0.55, 0.34, 0.145
# Generations that share one cell of the drawing of partial agents.
CELL: Final = 5
# The same in every run, without an edge: a mark that hid its neighbours would make many look like few.
MARK: Final = {"ls": "", "marker": "d", "ms": 3.6, "mew": 0, "color": FULL_COLOUR}


def generalisers_figure(results: Results) -> Figure:
    """Fully and partially compositional agents among the five best of each late generation, run by run."""
    heights = [
        [_height(found, run) for run in range(len(found.runs))] for found in results.conditions.values()
    ]
    tall = [max(sum(own), FLAT) for own in heights]
    with look(STYLE):
        figure = Figure(figsize=(FULL, 0.85 + sum(tall) + 0.3 * len(tall)), layout="constrained")
        panels = figure.subplots(len(tall), 1, sharex=True, squeeze=False, height_ratios=tall)[:, 0]
        for axes, own, (condition, found) in zip(panels, heights, results.conditions.items(), strict=True):
            _draw_condition(axes, found, own)
            axes.set_title(TITLES[condition], fontweight="bold")
        panels[-1].set_xlabel("generation")
        figure.legend(handles=_handles(), loc="outside lower center")
    return figure


def _height(results: ConditionResults, run: int) -> float:
    if len(results.generalisers[run]):
        return TALL
    return MIDDLE if results.members[AgentClass.PARTIAL][run] else FLAT


def _draw_condition(axes: Axes, results: ConditionResults, heights: list[float]) -> None:
    """All runs of a condition, from the top down."""
    top, middles = 0.0, []
    for run, height in enumerate(heights):
        middles.append(top - height / 2)
        axes.axhline(top - height, color=FAINT, lw=0.4, alpha=0.5)
        if results.members[AgentClass.PARTIAL][run]:
            partial = _members(results, run, AgentClass.PARTIAL)
            draw_density(axes, results.generations, partial, top - 0.04, top - height + 0.04)
        if len(results.generalisers[run]):
            draw_marks(axes, results.generalisers[run], top - 0.04, top - height + 0.04)
        _note(axes, results, run, middles[-1])
        top -= height
    axes.set_yticks(middles, [str(seed) for seed in results.seeds])
    axes.set_ylabel("seed")
    axes.set_ylim(min(top, -FLAT), 0)
    if len(results.generations):
        axes.set_xlim(results.generations[0], results.generations[-1] + 1)
    axes.tick_params(axis="y", length=0)
    axes.spines["left"].set_visible(False)


def draw_density(
    axes: Axes, generations: NDArray[np.integer], members: NDArray[np.bool_], top: float, bottom: float
) -> None:
    """Partial agents [L, 5]: five lanes, the darker a cell, the more of its generations have one there."""
    n_cells = -(-len(members) // CELL)
    padded = np.zeros((n_cells * CELL, N_BEST))
    padded[: len(members)] = members
    shares = padded.reshape(n_cells, CELL, N_BEST).mean(axis=1).T  # [5, cells]
    picture = np.tile(to_rgba(PARTIAL_COLOUR), (*shares.shape, 1))
    picture[..., 3] = 0.75 * shares
    extent = (generations[0], generations[0] + n_cells * CELL, bottom, top)
    axes.imshow(picture, extent=extent, aspect="auto", interpolation="nearest", zorder=1)


def draw_marks(axes: Axes, found: Generalisers, top: float, bottom: float) -> None:
    """Fully compositional agents, each in the lane of its rank, the generation's best in the top lane."""
    lanes = top - (found.ranks + 0.5) * (top - bottom) / N_BEST
    axes.plot(found.generations, lanes, zorder=3, clip_on=False, **MARK)


def _note(axes: Axes, results: ConditionResults, run: int, middle: float) -> None:
    """What there is in a row, at its right end."""
    full, partial = (int(results.members[kind][run]) for kind in (AgentClass.FULL, AgentClass.PARTIAL))
    text = f"{full:,} fully, {partial:,} partially" if full or partial else "none"
    look = {"color": INK, "fontweight": "bold"} if full else {"color": FAINT}
    beside(axes, text, (1.0, middle), (6, 0), xycoords=RIGHT_END, va="center", fontsize=SMALL, **look)


def _members(results: ConditionResults, run: int, kind: AgentClass) -> NDArray[np.bool_]:
    """Which agents of a run belong to a class, [L, 5]."""
    successes = results.successes[run]
    agents = successes.reshape(-1, successes.shape[-1])
    return classify(agents, results.condition)[kind].reshape(successes.shape[:2])


def _handles() -> list[Line2D | Patch]:
    full = "a fully compositional agent; lanes: the five best of a generation, the best on top"
    partial = f"partially compositional agents, paler where fewer of {CELL} generations have one"
    return [
        Line2D([], [], label=full, **MARK),
        Patch(color=PARTIAL_COLOUR, alpha=0.75, lw=0, label=partial),
    ]
