"""The paper's figures from our runs: Fig. 3, Table II as bars, Fig. 4 (section VII).

One function per figure; they draw what `evolution.results.analysis` has computed.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Final

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import LinearSegmentedColormap
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from arm2d.drawing import INK, look
from evolution.agents.subtasks import N_CATEGORIES, SUBTASKS
from evolution.agents.transitions import Transition, action_transitions, object_transitions
from evolution.figures.generalisers import CLASS_COLOURS, generalisers_figure
from evolution.figures.page import FAINT, STYLE
from evolution.figures.run import running_median
from evolution.results import published
from evolution.results.records import ConditionResults, Results
from evolution.results.wording import TITLES
from evolution.search.settings import LARGEST_FITNESS

# From pale sand (never) to deep teal (nearly always), lightness falling evenly.
CATEGORY_MAP: Final = LinearSegmentedColormap.from_list(
    "categories", ["#EFECE5", "#CFE0DC", "#7FB8B5", "#2F7F86", "#0D3F4A"]
)


def fitness_figure(results: Results) -> Figure:
    """Fig. 3: best fitness per generation, a line per run; a dot where one genotype first solved all."""
    with look(STYLE):
        figure = Figure(figsize=(9.2, 4.1), layout="constrained")
        panels = figure.subplots(1, len(results.conditions), sharey=True, squeeze=False)[0]
        for axes, (condition, found) in zip(panels, results.conditions.items(), strict=True):
            _draw_fitness(axes, found)
            axes.set_title(TITLES[condition], loc="left", fontweight="bold")
        panels[0].set_ylabel("best fitness, mean of 28 trials")
    return figure


def _draw_fitness(axes: Axes, results: ConditionResults) -> None:
    axes.axhline(LARGEST_FITNESS, color=FAINT, lw=1.0, ls=(0, (4, 3)))
    colours = mpl.colormaps["viridis"](np.linspace(0.05, 0.85, max(len(results.runs), 1)))
    for seed, best, first, colour in zip(
        results.seeds, results.best, results.first_solved, colours, strict=True
    ):
        axes.plot(running_median(best), color=colour, lw=1.2, label=f"seed {seed}")
        if first >= 0:
            axes.plot(first, best[first], "o", ms=4.5, color=colour, mec="white", mew=0.7, zorder=4)
    note = f"{results.at_plateau} of {len(results.runs)} runs end at 18/7"
    axes.text(0.98, 0.04, note, transform=axes.transAxes, ha="right", fontsize=8.5, color=FAINT)
    axes.legend(frameon=False, fontsize=7, ncols=2, loc="lower right", bbox_to_anchor=(1.0, 0.09))
    axes.set(xlabel="generation", ylim=(0.0, 2.75))
    axes.spines[["top", "right"]].set_visible(False)


def table_figure(results: Results) -> Figure:
    """Table II as stacked bars: share of agents by category, ours beside the published ones."""
    with look(STYLE):
        figure = Figure(figsize=(9.2, 3.9), layout="constrained")
        panels = figure.subplots(1, len(results.conditions), sharey=True, squeeze=False)[0]
        for axes, (condition, found) in zip(panels, results.conditions.items(), strict=True):
            _draw_bars(axes, found.counts, published.TABLE_II[condition])
            axes.set_title(TITLES[condition], loc="left", fontweight="bold")
        panels[0].set_ylabel("share of agents [%]")
        handles = [
            Patch(color=_category_colour(n), label=_category_label(n)) for n in reversed(range(N_CATEGORIES))
        ]
        place = {"loc": "outside right center", "frameon": False}
        figure.legend(handles=handles, fontsize=7.5, title="successes of 80", title_fontsize=8, **place)
    return figure


def _draw_bars(axes: Axes, ours: np.ndarray, theirs: np.ndarray) -> None:
    for column in range(len(SUBTASKS)):
        for counts, offset, edge in ((theirs, -0.2, FAINT), (ours, 0.2, INK)):
            shares = 100 * counts[:, column] / max(counts[:, column].sum(), 1)
            bottom = 0.0
            for category, share in enumerate(shares):
                axes.bar(column + offset, share, 0.36, bottom, color=_category_colour(category), lw=0)
                bottom += share
            axes.bar(column + offset, 100, 0.36, color="none", edgecolor=edge, lw=0.8)
    labels = [f"paper  ours\n{name}" for name in SUBTASKS]
    axes.set_xticks(range(len(SUBTASKS)), labels, fontsize=8.5)
    axes.set_ylim(0, 100)
    axes.tick_params(axis="x", length=0)
    axes.spines[["top", "right", "bottom"]].set_visible(False)


def transitions_figure(results: Results) -> Figure:
    """Fig. 4: mean success in every transition, class by class; how many agents pass stands in the legend."""
    with look(STYLE):
        figure = Figure(figsize=(9.2, 4.3 * len(results.conditions)), layout="constrained")
        panels = figure.subplots(len(results.conditions), 2, squeeze=False, sharey=True)
        for pair, (condition, found) in zip(panels, results.conditions.items(), strict=True):
            for axes, test, transitions in (
                (pair[0], "action", action_transitions(condition)),
                (pair[1], "object", object_transitions(condition)),
            ):
                _draw_transitions(axes, found, test, transitions)
                title = f"{TITLES[condition]}: {test} word changes"
                axes.set_title(title, loc="left", fontweight="bold", pad=46)
            pair[0].set_ylabel("successful trials [%]")
    return figure


def _draw_transitions(
    axes: Axes, results: ConditionResults, test: str, transitions: Sequence[Transition]
) -> None:
    places = np.arange(len(transitions))
    axes.axhline(75, color=FAINT, lw=0.8, ls=(0, (4, 3)))
    for kind, outcome in results.transitions.items():
        passed, success = getattr(outcome, f"{test}_passed"), getattr(outcome, f"{test}_success")
        label = f"{kind}: {passed:,} of {outcome.agents:,} pass"
        if outcome.agents:
            axes.plot(places, 100 * success, "o", ms=5, alpha=0.9, color=CLASS_COLOURS[kind], label=label)
        else:
            axes.plot([], [], "o", ms=5, color=CLASS_COLOURS[kind], label=f"{kind}: no agent")
    axes.set_xticks(
        places, [_short(transition, test) for transition in transitions], rotation=60, ha="right", fontsize=7
    )
    axes.set_ylim(-4, 104)
    axes.spines[["top", "right"]].set_visible(False)
    axes.grid(axis="x", color=FAINT, alpha=0.25, lw=0.5)
    above = {"loc": "lower left", "bbox_to_anchor": (-0.02, 0.99), "borderaxespad": 0.2}
    axes.legend(frameon=False, fontsize=7.5, labelspacing=0.25, **above)


def _short(transition: Transition, test: str) -> str:
    """What changes, with what stays in brackets."""
    before, after = transition.before, transition.after
    if test == "action":
        return f"{before.action.name} → {after.action.name} ({before.object.name.capitalize()})"
    return f"{before.object.name.capitalize()} → {after.object.name.capitalize()} ({before.action.name})"


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
