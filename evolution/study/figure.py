"""The study in pictures: the effect of every reading on each published figure, and where runs fail."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from arm2d import Condition
from arm2d.drawing import INK, look
from evolution.agents.subtasks import SUBTASKS, AgentClass
from evolution.figures.page import FAINT, STYLE, SUCCESS_MAP, ink_on
from evolution.results import published
from evolution.study.table import AREAS, VariantMeasures, interval

DEFAULT: Final = "default"
ACCENT: Final = "#0072B2"
ROW_HEIGHT: Final = 0.27  # [inch]


@dataclass(frozen=True)
class Column:
    """One published figure: its value for every run, and the value in the paper by condition."""

    title: str
    values: Callable[[VariantMeasures], NDArray[Any]]
    published: Callable[[Condition], float | None]
    limits: tuple[float | None, float]  # None: as low as the runs are


def _plateaus(variant: VariantMeasures) -> NDArray[Any]:
    return variant.plateaus


def _solved(variant: VariantMeasures) -> NDArray[Any]:
    return 100.0 * variant.solved


def _top_share(subtask: str) -> Callable[[VariantMeasures], NDArray[Any]]:
    return lambda each: 100 * each.top_shares[:, SUBTASKS.index(subtask)]


def _published_share(subtask: str) -> Callable[[Condition], float]:
    column = SUBTASKS.index(subtask)
    return lambda condition: 100 * published.TABLE_II[condition][-1, column] / published.AGENTS


def _with_generalisers(each: VariantMeasures) -> NDArray[Any]:
    return 100.0 * (each.class_shares(AgentClass.FULL) > 0)


def _published_generalisers(condition: Condition) -> float | None:
    share = 100 * published.RUNS_WITH_GENERALISERS / published.RUNS
    return share if condition is Condition.WITH_INDICATE else None


PERCENT: Final = (-4.0, 104.0)
COLUMNS: Final = (
    Column("plateau of the\nbest fitness", _plateaus, lambda _: published.PLATEAU, (None, 2.62)),
    Column("runs that solve\nall 28 trials [%]", _solved, lambda _: 100.0, PERCENT),
    Column("category 10 of\nsub-task I [%]", _top_share("I"), _published_share("I"), PERCENT),
    Column("runs with generalists\non all nine [%]", _with_generalisers, _published_generalisers, PERCENT),
)


def effects_figure(variants: Sequence[VariantMeasures], title: str) -> Figure:
    """A row per variant, a column per published figure: runs as dots, their mean with a 95 % interval.

    The dashed line is the paper's value, the shaded band the default's interval. Variants of one condition.
    """
    with look(STYLE):
        figure = Figure(figsize=(9.6, 1.5 + ROW_HEIGHT * len(variants)), layout="constrained")
        panels = figure.subplots(1, len(COLUMNS), sharey=True, squeeze=False)[0]
        for axes, column in zip(panels, COLUMNS, strict=True):
            _draw_effects(axes, column, variants)
        labels = [f"{readable(each)}  ({len(each.runs)})" for each in variants]
        panels[0].set_yticks(range(len(variants)), labels, fontsize=8.5)
        for label, variant in zip(panels[0].get_yticklabels(), variants, strict=True):
            label.set_fontweight("bold" if variant.name == DEFAULT else "normal")
        panels[0].set_ylim(len(variants) - 0.4, -0.6)
        figure.suptitle(title, x=0.01, ha="left", fontsize=11, fontweight="bold")
    return figure


def _draw_effects(axes: Axes, column: Column, variants: Sequence[VariantMeasures]) -> None:
    theirs = column.published(variants[0].condition)
    if theirs is not None:
        axes.axvline(theirs, color=INK, lw=1.1, ls=(0, (4, 3)), zorder=1)
    for row, variant in enumerate(variants):
        values = column.values(variant)
        low, high = interval(values)
        colour = INK if variant.name == DEFAULT else ACCENT
        if variant.name == DEFAULT:
            axes.axvspan(low, high, color=FAINT, alpha=0.13, lw=0, zorder=0)
        spread = np.linspace(-0.22, 0.22, len(values)) if len(values) > 1 else np.zeros(1)
        axes.plot(values, row + spread, "o", ms=2.6, color=colour, alpha=0.35, mew=0, zorder=2)
        axes.plot([low, high], [row, row], color=colour, lw=1.6, zorder=3)
        axes.plot(values.mean(), row, "o", ms=5.2, color=colour, mec="white", mew=0.7, zorder=4)
    axes.set_title(column.title, fontsize=9, loc="left")
    low, high = column.limits
    lowest = min(column.values(each).min() for each in variants)
    axes.set_xlim(lowest - 0.05 if low is None else low, high)
    axes.tick_params(axis="y", length=0)
    axes.tick_params(axis="x", labelsize=8)
    axes.grid(axis="y", color=FAINT, alpha=0.18, lw=0.5)
    axes.spines[["top", "right", "left"]].set_visible(False)


def readable(variant: VariantMeasures) -> str:
    """A variant's name for people: `start-areas-bounds+mutation-sd-0.03` in words."""
    return variant.name.replace("+", ", ").replace("-", " ")


def failures_figure(variants: Sequence[VariantMeasures], title: str) -> Figure:
    """A row per variant: mean success of late agents on each instruction from each start area.

    Variants of one condition; never-met instructions are marked with an asterisk.
    """
    condition = variants[0].condition
    never_met = [each not in condition.experienced for each in condition.instructions]
    names = [
        f"{instruction}{'*' if new else ''}, {area}"
        for instruction, new in zip(condition.instructions, never_met, strict=True)
        for area in AREAS
    ]
    with look(STYLE):
        figure = Figure(figsize=(9.6, 2.2 + ROW_HEIGHT * len(variants)), layout="constrained")
        axes = figure.subplots()
        shares = np.array([each.success_by_area.ravel() for each in variants])
        image = axes.imshow(100 * shares, cmap=SUCCESS_MAP, vmin=0, vmax=100, aspect="auto")
        axes.set_xticks(range(len(names)), names, rotation=60, ha="right", fontsize=8)
        axes.set_yticks(range(len(variants)), [readable(each) for each in variants], fontsize=8.5)
        for (row, place), share in np.ndenumerate(shares):
            number = axes.text(place, row, f"{100 * share:.0f}", ha="center", va="center", fontsize=6.5)
            number.set_color(ink_on(share))
        axes.tick_params(length=0)
        axes.spines[:].set_visible(False)
        figure.colorbar(image, ax=axes, label="successful trials [%]", shrink=0.6, aspect=25)
        figure.suptitle(title, x=0.01, ha="left", fontsize=11, fontweight="bold")
    return figure
