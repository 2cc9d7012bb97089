"""One run, drawn: what its champion makes of the nine instructions, and its fitness over the generations."""

from __future__ import annotations

from typing import Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Rectangle
from numpy.typing import NDArray

from arm2d import ObjectWord
from arm2d.drawing import COLUMN, HEADING, OBJECT_COLOURS, SMALL, STYLE, look
from evolution.figures.page import (
    FAINT,
    OURS,
    PAPER_DASHES,
    SERIES,
    SUCCESS_MAP,
    head,
    ink_on,
)
from evolution.runs.history import History
from evolution.search.evaluation import Evaluation
from evolution.search.settings import LARGEST_FITNESS

# Generations that a running median is of.
MEDIAN_OF: Final = 51
BEST_COLOUR: Final = OURS
MEAN_COLOUR: Final = SERIES[3]


def heat_map(evaluation: Evaluation, origin: str = "") -> Figure:
    """A page with the successes of one agent on all nine instructions.

    Raises:
        ValueError: If the evaluation is of several agents.
    """
    if (n := len(evaluation.successes)) != 1:
        raise ValueError(f"a heat map is of one agent, not of {n}; evaluate one of them")
    with look(STYLE):
        figure = Figure(figsize=(COLUMN, 3.35))
        axes = figure.add_axes((0.2, 0.075, 0.785, 0.68))
        draw_heat_map(axes, evaluation)
        head(figure, "Instructions carried out", origin)
        note = f"{evaluation.trials} trials each, half of them from either start area"
        figure.text(0.2, 0.025, note, fontsize=SMALL, color=FAINT)
    return figure


def draw_heat_map(axes: Axes, evaluation: Evaluation) -> None:
    """Action words by object words: success in per cent, with counts; never-met ones are dashed."""
    actions = list(dict.fromkeys(each.action for each in evaluation.condition.instructions))
    rows = len(actions)
    counts = evaluation.successes[0].sum(axis=-1).reshape(rows, 3)
    shares = counts / evaluation.trials
    axes.imshow(shares, cmap=SUCCESS_MAP, vmin=0.0, vmax=1.0, aspect="auto")
    axes.tick_params(length=0, top=False, labeltop=True, labelbottom=False, pad=4)
    axes.set_yticks(range(rows), [word.name for word in actions], fontsize=HEADING)
    axes.set_xticks(
        range(3), [word.name.capitalize() for word in ObjectWord], fontsize=HEADING, fontweight="bold"
    )
    for label, colour in zip(axes.get_xticklabels(), OBJECT_COLOURS.values(), strict=True):
        label.set_color(colour)
    for edge in axes.spines.values():
        edge.set_visible(False)
    for row, column in np.ndindex(rows, 3):
        never_met = not evaluation.experienced[3 * row + column]
        _draw_cell(axes, row, column, counts[row, column], evaluation.trials, never_met)


def _draw_cell(axes: Axes, row: int, column: int, count: int, trials: int, never_met: bool) -> None:
    """Numbers and frame of one instruction."""
    share = count / trials
    colour = ink_on(share)
    axes.text(column, row - 0.06, f"{100 * share:.0f} %", ha="center", va="center", fontsize=13, color=colour)
    axes.text(
        column, row + 0.24, f"{count} of {trials}", ha="center", va="center", fontsize=SMALL, color=colour
    )
    axes.add_patch(Rectangle((column - 0.5, row - 0.5), 1, 1, fill=False, edgecolor="white", linewidth=3))
    if never_met:
        axes.text(column, row - 0.34, "never met", ha="center", va="center", fontsize=SMALL, color=colour)
        frame = Rectangle((column - 0.445, row - 0.445), 0.89, 0.89, fill=False, edgecolor=colour)
        frame.set(linewidth=0.9, linestyle=(0, (4, 2.5)))
        axes.add_patch(frame)


def fitness_curve(history: History, origin: str = "", largest: float = LARGEST_FITNESS) -> Figure:
    """A page with the fitness of a run over its generations."""
    with look(STYLE):
        figure = Figure(figsize=(COLUMN, 2.45))
        axes = figure.add_axes((0.115, 0.145, 0.865, 0.635))
        draw_fitness_curve(axes, history, largest)
        head(figure, "Fitness over the generations", origin)
    return figure


def draw_fitness_curve(axes: Axes, history: History, largest: float = LARGEST_FITNESS) -> None:
    """Best and mean fitness per generation, their running median, and the largest fitness possible."""
    generations = history.generations
    axes.axhline(largest, color=FAINT, linewidth=0.8, linestyle=PAPER_DASHES)
    for name, values, colour in (("best", history.best, BEST_COLOUR), ("mean", history.mean, MEAN_COLOUR)):
        axes.plot(generations, values, color=colour, linewidth=0.4, alpha=0.35)
        axes.plot(generations, running_median(values), color=colour, linewidth=1.3, label=name)
    axes.set(xlabel="generation", ylabel=_fitness_label(largest), ylim=(0.0, 1.1 * largest))
    axes.set_xlim(generations[0], max(generations[-1], generations[0] + 1))
    handles = [
        *axes.get_legend_handles_labels()[0],
        Line2D([], [], color=FAINT, lw=0.4, label="thin: every generation"),
        Line2D([], [], color=FAINT, lw=0.8, ls=PAPER_DASHES, label=f"the largest, {largest:.3f}"),
    ]
    axes.legend(handles=handles, loc="lower right")


def _fitness_label(largest: float) -> str:
    """What the paper's fitness is a mean of; other tasks have other trials."""
    return "fitness, mean of 28 trials" if largest == LARGEST_FITNESS else "fitness"


def running_median(values: NDArray[np.float64], width: int = MEDIAN_OF) -> NDArray[np.float64]:
    """Median of the `width` generations around each, fewer at both ends, [G]."""
    half = width // 2
    padded = np.pad(values, half, constant_values=np.nan)
    return np.nanmedian(np.lib.stride_tricks.sliding_window_view(padded, 2 * half + 1), axis=-1)
