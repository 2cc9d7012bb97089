"""The worlds of the confirmation in one picture: every run, means, and the published values as lines."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator

from arm2d import Condition
from arm2d.drawing import FULL, INK, SMALL, STYLE, look
from evolution.figures.page import (
    CONDITION_COLOURS,
    FAINT,
    PAPER_DASHES,
    RIGHT_END,
    beside,
    headed,
    paper_handle,
    save_figure,
)
from evolution.results import wording
from evolution.results.statistics import mean_interval
from evolution.search.randomness import Purpose, generator
from evolution.study.declared.confirmation.worlds import DEFAULT, PRINTED, RunsOfWorlds
from evolution.study.declared.outcomes import FIGURES, Outcome
from evolution.study.declared.rows import MeasuredRun

OFFSETS: Final = {Condition.WITH_INDICATE: -0.2, Condition.WITH_IGNORE: 0.2}
SPREAD: Final = 0.13  # of runs about the line of their world and condition [rows]
ROW_HEIGHT: Final = 0.42  # [inch]
# What tables call them, in the words of the declaration.
LABELS: Final = {
    "a": "A",
    "b": "B",
    "smallest-departure": "smallest\ndeparture",
    DEFAULT: "plain",
    PRINTED: "printed",
}
# By the part of the study.
TITLES: Final = {
    "fresh": "Fresh seeds in the worlds that were declared",
    "decision": "The winner and the printed readings, with seeds of their own",
}


def draw_worlds(runs: RunsOfWorlds, distances: Mapping[str, float], title: str, stem: Path) -> list[Path]:
    """Draw the worlds beside the paper and write them; the paths of PNG and SVG.

    Raises:
        OSError: If they cannot be written.
    """
    seeds = sorted({run.config.seed for own in runs.values() for found in own.values() for run in found})
    about = f"Seeds {seeds[0]} to {seeds[-1]}; in brackets: distance from the paper"
    return save_figure(worlds_figure(runs, distances, title, about), stem)


def worlds_figure(runs: RunsOfWorlds, distances: Mapping[str, float], title: str, about: str = "") -> Figure:
    """A row for each world with its distance from the paper, a column for each figure that is compared.

    A faint dot is a run, a full one the mean of a condition's runs with its 95 % bootstrap interval, the
    dashed line what the paper has. Beside the plateaus: how many runs end at 18/7.
    """
    height = 1.3 + ROW_HEIGHT * len(runs)
    with look(STYLE):
        figure = Figure(figsize=(FULL, height), layout="constrained")
        panels = figure.subplots(1, len(FIGURES), sharey=True, width_ratios=[1.5, 1, 1, 1, 1])
        for axes, outcome in zip(panels, FIGURES, strict=True):
            for row, own in enumerate(runs.values()):
                for condition, found in own.items():
                    _draw(axes, outcome, found, condition, row)
            _finish(axes, outcome)
        for row, own in enumerate(runs.values()):
            for condition, found in own.items():
                _count(panels[0], found, condition, row)
        names = [f"{LABELS.get(name, name)} ({distances[name]:.2f})" for name in runs]
        panels[0].set_yticks(range(len(runs)), names)
        panels[0].set_ylim(len(runs) - 0.5, -0.5)
        figure.legend(handles=_legend(), loc="outside lower center", ncols=5)
        headed(figure, title, about)
    return figure


def _draw(axes: Axes, outcome: Outcome, runs: Sequence[MeasuredRun], condition: Condition, row: int) -> None:
    """One world's runs of one condition."""
    scale, colour, y = _scale(outcome), CONDITION_COLOURS[condition], row + OFFSETS[condition]
    values = scale * outcome.values(runs)
    # Side by side in the order of their seeds: nothing is random in a picture.
    places = y + np.linspace(-SPREAD, SPREAD, len(values))
    axes.plot(values, places, "o", ms=1.6, mfc=colour, mec="none", alpha=0.35, zorder=2)
    low, high = mean_interval(values, generator(0, Purpose.STATISTICS))
    axes.plot([low, high], [y, y], color=colour, lw=1.2, zorder=3)
    axes.plot([values.mean()], [y], "o", ms=3.6, mfc=colour, mec="white", mew=0.5, zorder=4)
    published = scale * outcome.published(condition)
    axes.plot([published] * 2, [y - 0.2, y + 0.2], color=colour, lw=1.1, ls=PAPER_DASHES, zorder=5)


def _count(axes: Axes, runs: Sequence[MeasuredRun], condition: Condition, row: int) -> None:
    """How many runs end at the largest fitness, at the right end of the plateaus."""
    text = f"{sum(run.at_limit for run in runs)} of {len(runs)}"
    place, style = (1.0, row + OFFSETS[condition]), {"va": "center", "ha": "left", "fontsize": SMALL}
    beside(axes, text, place, (4.0, 0.0), xycoords=RIGHT_END, color=CONDITION_COLOURS[condition], **style)


def _finish(axes: Axes, outcome: Outcome) -> None:
    name = outcome.name.replace(" of ", "\nof ")
    axes.set_title(f"{name} [%]" if outcome.is_share else f"{name},\nruns at 18/7", fontsize=SMALL, color=INK)
    axes.tick_params(axis="y", length=0)
    axes.xaxis.set_major_locator(MaxNLocator(3))
    axes.grid(axis="x", color=FAINT, alpha=0.15, lw=0.5)
    axes.spines["left"].set_visible(False)
    if outcome.is_share:
        axes.set_xlim(left=-3.0)


def _scale(outcome: Outcome) -> float:
    return 100.0 if outcome.is_share else 1.0


def _legend() -> list[Line2D]:
    """What colours and marks mean."""
    dot = {"marker": "o", "ms": 3.6}
    return [
        *(Line2D([], [], color=CONDITION_COLOURS[c], **dot, label=wording.TITLES[c]) for c in Condition),
        Line2D([], [], color=INK, ls="", marker="o", ms=1.6, alpha=0.35, label="a run"),
        Line2D([], [], color=INK, lw=1.2, **dot, label="mean, 95 %"),
        paper_handle(),
    ]
