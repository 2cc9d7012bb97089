"""The paper's figures from our runs: Fig. 3, Table II as bars, Fig. 4 (section VII).

One function per figure; they draw what `evolution.results.analysis` has computed.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from typing import Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import LinearSegmentedColormap
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from arm2d.drawing import FULL, INK, STYLE, look
from evolution.agents.subtasks import N_CATEGORIES, SUBTASKS
from evolution.figures.generalisers import generalisers_figure
from evolution.figures.page import FAINT, OURS, PAPER_DASHES, RIGHT_END, SERIES, beside
from evolution.figures.run import MEDIAN_OF, running_median
from evolution.figures.transitions import transitions_figure
from evolution.results import published
from evolution.results.records import ConditionResults, Results
from evolution.results.wording import TITLES
from evolution.search.settings import LARGEST_FITNESS

# From pale sand (never) to deep teal (nearly always), lightness falling evenly.
CATEGORY_MAP: Final = LinearSegmentedColormap.from_list(
    "categories", ["#EFECE5", "#CFE0DC", "#7FB8B5", "#2F7F86", "#0D3F4A"]
)
SUBTASK_NAMES: Final = ("the\nseven", "+ MOVE\nBlue", "+ TOUCH\nGreen", "all\nnine")
# The steep rise of the first generations would leave half of the axes empty; so much of a run is not asked
# to fit in.
RISE: Final = 0.02
# Lines that end nearer to each other than this look like one.
APART: Final = 0.02


def fitness_figure(results: Results) -> Figure:
    """Fig. 3: best fitness as running medians, a line per run; a dot where one genotype first solved all."""
    colours = _seed_colours(results.conditions.values())
    with look(STYLE):
        figure = Figure(figsize=(FULL, 2.75), layout="constrained")
        panels = figure.subplots(1, len(results.conditions), sharey=True, squeeze=False)[0]
        for axes, (condition, found) in zip(panels, results.conditions.items(), strict=True):
            _draw_fitness(axes, found, colours)
            axes.set_title(TITLES[condition], fontweight="bold")
        panels[0].set_ylabel(f"best fitness, median of {MEDIAN_OF} generations")
        panels[0].set_ylim(_lowest(results.conditions.values()), LARGEST_FITNESS + 0.04)
        handles = _fitness_handles(colours)
        figure.legend(handles=handles, loc="outside lower center", ncols=min(len(handles), 7))
    return figure


def _seed_colours(conditions: Collection[ConditionResults]) -> dict[int, str]:
    """A colour for each seed; the same for all, if there are more seeds than colours."""
    seeds = sorted({int(seed) for found in conditions for seed in found.seeds})
    several = len(seeds) <= len(SERIES)
    return {seed: SERIES[place] if several else OURS for place, seed in enumerate(seeds)}


def _lowest(conditions: Collection[ConditionResults]) -> float:
    """Lower end of the axis: a little below the lowest run once it has risen."""
    later = [found.best[:, int(RISE * found.best.shape[1]) :] for found in conditions if found.best.size]
    return min([float(best.min()) for best in later], default=0.0) - 0.05


def _draw_fitness(axes: Axes, results: ConditionResults, colours: Mapping[int, str]) -> None:
    axes.axhline(LARGEST_FITNESS, color=FAINT, lw=0.8, ls=PAPER_DASHES)
    alpha = 0.95 if len(set(colours.values())) > 1 else 0.4
    for seed, best, first in zip(results.seeds, results.best, results.first_solved, strict=True):
        look, line = {"color": colours[int(seed)], "alpha": alpha}, running_median(best)
        axes.plot(line, lw=1.0, label=f"seed {seed}", **look)
        if first >= 0:
            axes.plot(first, line[first], "o", ms=4, mec="white", mew=0.6, zorder=4, **look)
    _count_ends(axes, results)
    note = f"{results.at_plateau} of {len(results.runs)} runs end at 18/7"
    axes.set_title(note, loc="right", fontsize="medium", color=FAINT)
    axes.set_xlabel("generation")


def _count_ends(axes: Axes, results: ConditionResults) -> None:
    """How many runs end below 18/7 where lines lie over one another; a title counts those that end there."""
    ends = np.sort([running_median(best)[-1] for best in results.best])
    for group in np.split(ends, np.flatnonzero(np.diff(ends) > APART) + 1):
        if len(group) > 1 and group.mean() < LARGEST_FITNESS - APART:
            look = {"color": FAINT, "va": "center", "xycoords": RIGHT_END}
            beside(axes, f"{len(group)} runs", (1.0, group.mean()), (3, 0), **look)


def _fitness_handles(colours: Mapping[int, str]) -> list[Line2D]:
    """Seeds, and what dots and the dashed line mean."""
    if len(set(colours.values())) > 1:
        runs = [Line2D([], [], color=colour, label=f"seed {seed}") for seed, colour in colours.items()]
    else:
        runs = [Line2D([], [], color=colour, label="a run") for colour in list(colours.values())[:1]]
    dot = {"marker": "o", "ms": 4, "mec": "white", "color": FAINT}
    return [
        *runs,
        Line2D([], [], ls="", **dot, label="one genotype first solves all 28 trials"),
        Line2D([], [], color=FAINT, lw=0.8, ls=PAPER_DASHES, label="18/7, the largest fitness"),
    ]


def table_figure(results: Results) -> Figure:
    """Table II as stacked bars: share of agents by category, ours beside the published ones."""
    with look(STYLE):
        figure = Figure(figsize=(FULL, 2.75), layout="constrained")
        panels = figure.subplots(1, len(results.conditions), sharey=True, squeeze=False)[0]
        for axes, (condition, found) in zip(panels, results.conditions.items(), strict=True):
            _draw_bars(axes, found.counts, published.TABLE_II[condition])
            axes.set_title(TITLES[condition], fontweight="bold")
        panels[0].set_ylabel("share of agents [%]")
        handles = [
            Patch(color=_category_colour(n), label=_category_label(n)) for n in reversed(range(N_CATEGORIES))
        ]
        handles += [
            Patch(fc="none", ec=edge, lw=0.7, label=f"{side} bar: {whose}")
            for edge, side, whose in ((FAINT, "left", "the paper"), (INK, "right", "ours"))
        ]
        least = "successes of 80,\nleast mastered\ninstruction"
        figure.legend(handles=handles, loc="outside right center", title=least)
    return figure


def _draw_bars(axes: Axes, ours: np.ndarray, theirs: np.ndarray) -> None:
    for column in range(len(SUBTASKS)):
        for counts, offset, edge in ((theirs, -0.2, FAINT), (ours, 0.2, INK)):
            shares = 100 * counts[:, column] / max(counts[:, column].sum(), 1)
            bottom = 0.0
            for category, share in enumerate(shares):
                axes.bar(column + offset, share, 0.36, bottom, color=_category_colour(category), lw=0)
                bottom += share
            axes.bar(column + offset, 100, 0.36, color="none", edgecolor=edge, lw=0.7)
    labels = [f"{subtask}\n{name}" for subtask, name in zip(SUBTASKS, SUBTASK_NAMES, strict=True)]
    axes.set_xticks(range(len(SUBTASKS)), labels)
    axes.set_ylim(0, 100)
    axes.tick_params(axis="x", length=0)
    axes.spines["bottom"].set_visible(False)


def _category_colour(category: int) -> tuple[float, float, float, float]:
    return CATEGORY_MAP(category / (N_CATEGORIES - 1))


def _category_label(category: int) -> str:
    return "0" if category == 0 else f"{8 * (category - 1) + 1} to {8 * category}"


def all_figures(results: Results) -> Mapping[str, Figure]:
    """All figures of an experiment, by the name of their files."""
    return {
        "fitness": fitness_figure(results),
        "table-ii": table_figure(results),
        "transitions": transitions_figure(results),
        "generalisers": generalisers_figure(results),
    }
