"""What each departure of the winner is worth, in one picture: every seed, means, and runs at 18/7."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator

from arm2d import Condition, Readings
from arm2d.drawing import FULL, INK, SMALL, STYLE, look
from evolution.figures.page import CONDITION_COLOURS, FAINT, RIGHT_END, beside, headed
from evolution.study.declared.confirmation.less_one import Cost
from evolution.study.declared.confirmation.verdict import JUDGED
from evolution.study.declared.factors import DECLARED_DEFAULT, FACTORS, levels_of
from evolution.study.declared.outcomes import Outcome
from evolution.study.declared.regression import SIGNIFICANT

SPREAD: Final = 0.26  # of seeds about the line of their departure [rows]
ROW_HEIGHT: Final = 0.36  # [inch]
COLOUR: Final = CONDITION_COLOURS[Condition.WITH_INDICATE]


def less_one_figure(costs: Sequence[Cost], winner: Readings, title: str, about: str = "") -> Figure:
    """A row for each departure that is taken back, a column for each figure: the change, seed by seed.

    A faint dot is a seed, the large one their mean with its 95 % bootstrap interval, filled where the
    corrected p is below 0.05. To the left of the line fewer get there without the departure: it helps.
    Beside the plateaus: how many runs end at 18/7, without the departure and with it.
    """
    factors = list(dict.fromkeys(cost.factor for cost in costs))
    with look(STYLE):
        size = (FULL, 1.2 + ROW_HEIGHT * len(factors))
        figure = Figure(figsize=size, layout="constrained")
        panels = figure.subplots(1, len(JUDGED), sharey=True)
        for axes, outcome in zip(panels, JUDGED, strict=True):
            for cost in costs:
                if cost.outcome == outcome:
                    _draw(axes, cost, factors.index(cost.factor))
            _finish(axes, outcome)
        _head(panels[0])
        for cost in costs:
            if cost.outcome == JUDGED[0]:
                _count(panels[0], cost, factors.index(cost.factor))
        panels[0].set_yticks(range(len(factors)), taken_back(winner, factors))
        panels[0].set_ylim(len(factors) - 0.5, -0.5)
        figure.legend(handles=_legend(), loc="outside lower center", ncols=3)
        headed(figure, title, about)
    return figure


def taken_back(winner: Readings, factors: Sequence[str]) -> list[str]:
    """What is taken back by each of these factors: the winner's level, and the level in its place."""
    names = [factor.name for factor in FACTORS]
    ours, theirs = (dict(zip(names, levels_of(world), strict=True)) for world in (winner, DECLARED_DEFAULT))
    return [_plain(f"{factor}: {theirs[factor]}\nin place of {ours[factor]}") for factor in factors]


def _plain(name: str) -> str:
    return name.replace("_", " ").replace("+-", "±")


def _draw(axes: Axes, cost: Cost, row: int) -> None:
    """One departure's change in one figure."""
    scale = _scale(cost.outcome)
    # Side by side in the order of their seeds: nothing is random in a picture.
    places = row + np.linspace(-SPREAD, SPREAD, len(cost.differences))
    axes.plot(scale * cost.differences, places, "o", ms=1.8, mfc=COLOUR, mec="none", alpha=0.35, zorder=2)
    change, face = cost.difference, COLOUR if cost.corrected < SIGNIFICANT else "white"
    axes.plot([scale * change.low, scale * change.high], [row, row], color=COLOUR, lw=1.3, zorder=3)
    axes.plot([scale * change.value], [row], "o", ms=4.2, mfc=face, mec=COLOUR, mew=0.9, zorder=4)


def _head(axes: Axes) -> None:
    """What the counts at the right end of the plateaus are."""
    style = {"va": "bottom", "ha": "left", "fontsize": SMALL}
    beside(
        axes, "at 18/7,\nwithout : with", (1.0, -0.5), (4.0, 2.0), xycoords=RIGHT_END, color=FAINT, **style
    )


def _count(axes: Axes, cost: Cost, row: int) -> None:
    """How many runs end at the largest fitness without the departure, at the right end of the plateaus."""
    text = f"{cost.at_limit} : {cost.winners_at_limit}"
    style = {"va": "center", "ha": "left", "fontsize": SMALL}
    beside(axes, text, (1.0, row), (4.0, 0.0), xycoords=RIGHT_END, color=INK, **style)


def _finish(axes: Axes, outcome: Outcome) -> None:
    told = f"{outcome.name} [points]" if outcome.is_share else outcome.name
    axes.set_title(told, fontsize=SMALL, color=INK)
    axes.set_xlabel("without the departure less with it")
    axes.axvline(0.0, color=INK, lw=0.7, zorder=1, label="zero")
    axes.tick_params(axis="y", length=0)
    axes.xaxis.set_major_locator(MaxNLocator(5))
    axes.grid(axis="x", color=FAINT, alpha=0.15, lw=0.5)
    axes.spines["left"].set_visible(False)


def _scale(outcome: Outcome) -> float:
    return 100.0 if outcome.is_share else 1.0


def _legend() -> list[Line2D]:
    """What marks mean."""
    known = Line2D([], [], color=COLOUR, marker="o", lw=1.3, ms=4.2, label="mean, 95 %; p < 0.05 after Holm")
    unknown = Line2D(
        [], [], color=COLOUR, marker="o", lw=1.3, ms=4.2, mfc="white", label="not shown to matter"
    )
    return [
        Line2D([], [], color=COLOUR, marker="o", ls="", ms=1.8, alpha=0.5, label="a seed"),
        known,
        unknown,
    ]
