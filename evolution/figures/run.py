"""One run, drawn: what its champion makes of the nine instructions, and its fitness over the generations."""

from __future__ import annotations

from typing import Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle
from numpy.typing import NDArray

from arm2d import ObjectWord
from arm2d.drawing import OBJECT_COLOURS, look
from evolution.figures.page import FAINT, RIGHT_END, STYLE, SUCCESS_MAP, beside, head, ink_on
from evolution.runs.history import History
from evolution.search.evaluation import Evaluation
from evolution.search.settings import LARGEST_FITNESS

BEST_COLOUR: Final = "#1B4F72"
MEAN_COLOUR: Final = "#8FB3CC"


def heat_map(evaluation: Evaluation, origin: str = "") -> Figure:
    """A page with the successes of one agent on all nine instructions."""
    with look(STYLE):
        figure = Figure(figsize=(6.0, 5.7))
        axes = figure.add_axes((0.175, 0.075, 0.8, 0.74))
        draw_heat_map(axes, evaluation)
        head(figure, "Instructions carried out", origin, left=0.175)
        note = f"{evaluation.trials} trials each, half of them from either start area"
        figure.text(0.175, 0.025, note, fontsize=8.5, color=FAINT)
    return figure


def draw_heat_map(axes: Axes, evaluation: Evaluation) -> None:
    """Action words by object words: success in per cent, with counts; never-met ones are dashed."""
    actions = list(dict.fromkeys(each.action for each in evaluation.condition.instructions))
    rows = len(actions)
    counts = evaluation.successes[0].sum(axis=-1).reshape(rows, 3)
    shares = counts / evaluation.trials
    axes.imshow(shares, cmap=SUCCESS_MAP, vmin=0.0, vmax=1.0, aspect="auto")
    axes.tick_params(length=0, top=False, labeltop=True, labelbottom=False, pad=6)
    axes.set_yticks(range(rows), [word.name for word in actions], fontsize=12)
    axes.set_xticks(range(3), [word.name.capitalize() for word in ObjectWord], fontsize=13, fontweight="bold")
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
    axes.text(column, row - 0.06, f"{100 * share:.0f} %", ha="center", va="center", fontsize=20, color=colour)
    axes.text(column, row + 0.2, f"{count} of {trials}", ha="center", va="center", fontsize=9, color=colour)
    axes.add_patch(Rectangle((column - 0.5, row - 0.5), 1, 1, fill=False, edgecolor="white", linewidth=5))
    if never_met:
        axes.text(column, row - 0.34, "never met", ha="center", va="center", fontsize=9, color=colour)
        frame = Rectangle((column - 0.445, row - 0.445), 0.89, 0.89, fill=False, edgecolor=colour)
        frame.set(linewidth=1.5, linestyle=(0, (4, 2.5)))
        axes.add_patch(frame)


def fitness_curve(history: History, origin: str = "", largest: float = LARGEST_FITNESS) -> Figure:
    """A page with the fitness of a run over its generations."""
    with look(STYLE):
        figure = Figure(figsize=(7.6, 4.6))
        axes = figure.add_axes((0.085, 0.125, 0.89, 0.735))
        draw_fitness_curve(axes, history, largest)
        head(figure, "Fitness over the generations", origin, left=0.085)
    return figure


def draw_fitness_curve(axes: Axes, history: History, largest: float = LARGEST_FITNESS) -> None:
    """Best and mean fitness per generation, their running median, and the largest fitness possible."""
    generations = history.generations
    axes.axhline(largest, color=FAINT, linewidth=1.0, linestyle=(0, (4, 3)))
    look = {"xycoords": RIGHT_END, "ha": "right", "fontsize": 8.5, "color": FAINT}
    beside(axes, f"largest possible, {largest:.3f}", (1.0, largest), (-4, 4), **look)
    for name, values, colour in (("best", history.best, BEST_COLOUR), ("mean", history.mean, MEAN_COLOUR)):
        axes.plot(generations, values, color=colour, linewidth=0.5, alpha=0.35)
        axes.plot(generations, running_median(values), color=colour, linewidth=1.8, label=name)
    axes.set(xlabel="generation", ylabel=_fitness_label(largest), ylim=(0.0, 1.1 * largest))
    axes.set_xlim(generations[0], max(generations[-1], generations[0] + 1))
    axes.spines[["top", "right"]].set_visible(False)
    axes.legend(frameon=False, loc="lower right", ncols=2)


def _fitness_label(largest: float) -> str:
    """What the paper's fitness is a mean of; other tasks have other trials."""
    return "fitness, mean of 28 trials" if largest == LARGEST_FITNESS else "fitness"


def running_median(values: NDArray[np.float64], width: int = 51) -> NDArray[np.float64]:
    """Median of the `width` generations around each, fewer at both ends, [G]."""
    half = width // 2
    padded = np.pad(values, half, constant_values=np.nan)
    return np.nanmedian(np.lib.stride_tricks.sliding_window_view(padded, 2 * half + 1), axis=-1)
