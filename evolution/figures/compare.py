"""Several experiments beside the paper: a panel for each kind of number, a row for each experiment."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from arm2d import Condition
from arm2d.drawing import FULL, INK, SMALL, STYLE, look
from evolution.agents.subtasks import SUBTASKS
from evolution.figures.classes import SHORT
from evolution.figures.page import FAINT, PAPER, PAPER_DASHES, SERIES
from evolution.results import published
from evolution.results.key_numbers import (
    AT_LIMIT,
    PLATEAU,
    SOLVED,
    WITH_FULL,
    KeyNumber,
    by_condition,
    pass_name,
    top_name,
)
from evolution.results.records import Results
from evolution.results.wording import TITLES
from evolution.search.settings import LARGEST_FITNESS

# Title of each panel and the key numbers in it, with their short names.
COUNTS: Final = {
    AT_LIMIT: "end at 18/7",
    SOLVED: "solve all 28 trials",
    WITH_FULL: "fully compositional",
}
TOPS: Final = {top_name(name): f"sub-task {name}" for name in SUBTASKS}
PASSES: Final = {
    pass_name(kind, word): f"{short}, {word}"
    for kind, short in SHORT.items()
    for word in ("action", "object")
}


def compare_figure(experiments: Mapping[str, Results]) -> Figure:
    """A row of four panels for each condition: plateaus, runs, category 10, transitions."""
    conditions = by_condition(experiments)
    names = list(experiments)
    height = 0.5 + len(conditions) * (1.4 + 0.3 * len(names))
    with look(STYLE):
        figure = Figure(figsize=(FULL, height), layout="constrained")
        panels = figure.subplots(len(conditions), 4, squeeze=False, width_ratios=(1, 1, 1.1, 1.1))
        lowest = _lowest(conditions)
        for row, (condition, by_name) in zip(panels, conditions.items(), strict=True):
            by_number = {name: {number.name: number for number in by_name.get(name, [])} for name in names}
            draw_plateaus(row[0], by_number)
            row[0].set_xlim(lowest - 0.03, LARGEST_FITNESS + 0.03)
            row[0].set_title(TITLES[condition], fontweight="bold")
            draw_numbers(row[1], by_number, COUNTS, runs=True)
            draw_numbers(row[2], by_number, TOPS)
            draw_numbers(row[3], by_number, PASSES)
            for axes, label in zip(row, _labels(), strict=True):
                axes.set_xlabel(label, fontsize=SMALL)
        figure.legend(handles=_handles(names), loc="outside lower center", ncols=6)
    return figure


def draw_plateaus(axes: Axes, by_number: Mapping[str, Mapping[str, KeyNumber]]) -> None:
    """Each run's plateau, a row for each experiment; the largest fitness as a line."""
    axes.axvline(LARGEST_FITNESS, color=FAINT, lw=0.8, ls=PAPER_DASHES)
    for row, (name, numbers) in enumerate(by_number.items()):
        if PLATEAU in numbers:
            values = np.sort(numbers[PLATEAU].runs)
            spread = 0.16 * (np.arange(len(values)) % 3 - 1)
            axes.plot(
                values,
                row + spread,
                "o",
                ms=3.4,
                alpha=0.75,
                color=_colour(name, by_number),
                mec="white",
                mew=0.5,
            )
    axes.set_yticks(range(len(by_number)), list(by_number))
    axes.set_ylim(len(by_number) - 0.4, -0.6)


def draw_numbers(
    axes: Axes,
    by_number: Mapping[str, Mapping[str, KeyNumber]],
    shown: Mapping[str, str],
    *,
    runs: bool = False,
) -> None:
    """Numbers in per cent (of runs, or of agents), a line for each, the paper's as a stroke."""
    names = list(by_number)
    offsets = np.linspace(-0.26, 0.26, len(names)) if len(names) > 1 else [0.0]
    for row, key in enumerate(shown):
        for offset, name in zip(offsets, names, strict=True):
            number = by_number[name].get(key)
            if number is None:
                continue
            colour, scale = _colour(name, by_number), 100 / max(number.of, 1) if runs else 100
            if number.published is not None:
                theirs = 100 * number.published / (published.RUNS if runs else 1)
                axes.plot([theirs] * 2, [row - 0.38, row + 0.38], color=PAPER, lw=1.8, solid_capstyle="butt")
            if len(number.runs):
                shares = 100 * number.runs
                axes.plot(shares, np.full(len(shares), row + offset), "o", ms=2.4, alpha=0.3, color=colour)
            if np.isfinite(number.ours):
                axes.plot(scale * number.ours, row + offset, "o", ms=4.8, color=colour, mec="white", mew=0.6)
    axes.set_yticks(range(len(shown)), list(shown.values()))
    axes.set(xlim=(-3, 103), ylim=(len(shown) - 0.4, -0.6))
    axes.grid(axis="y", color=FAINT, alpha=0.25, lw=0.5)
    axes.spines["left"].set_visible(False)
    axes.tick_params(axis="y", length=0)


def _lowest(conditions: Mapping[Condition, Mapping[str, list[KeyNumber]]]) -> float:
    """The lowest plateau of all, so that all panels share one scale."""
    numbers = [number for by_name in conditions.values() for own in by_name.values() for number in own]
    lowest = [float(number.runs.min()) for number in numbers if number.name == PLATEAU and len(number.runs)]
    return min([*lowest, LARGEST_FITNESS - 0.1])


def _colour(name: str, experiments: Mapping[str, object]) -> str:
    """From deep teal on, one colour for each experiment."""
    return SERIES[list(experiments).index(name) % len(SERIES)]


def _labels() -> tuple[str, str, str, str]:
    return (
        "plateau of each run, best fitness",
        "share of runs [%]",
        "agents in category 10 [%]",
        "pass a transition [%]",
    )


def _handles(names: list[str]) -> list[Line2D]:
    handles = [
        Line2D([], [], ls="", marker="o", ms=4.8, color=_colour(name, dict.fromkeys(names)), label=name)
        for name in names
    ]
    handles.append(Line2D([], [], color=PAPER, lw=1.8, label="the paper"))
    handles.append(Line2D([], [], ls="", marker="o", ms=2.4, alpha=0.5, color=INK, label="a run"))
    limit = {"color": FAINT, "lw": 0.8, "ls": PAPER_DASHES}
    handles.append(Line2D([], [], **limit, label="18/7, the largest fitness"))
    return handles
