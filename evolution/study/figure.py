"""The study in pictures: the effect of every reading on each published figure, and where runs fail."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from arm2d import Condition
from arm2d.drawing import FULL, INK, OBJECT_COLOURS, SMALL, STYLE, look
from arm2d.records import alike
from evolution.agents.subtasks import SUBTASKS
from evolution.figures.page import (
    FAINT,
    OURS,
    PAPER,
    PAPER_DASHES,
    SUCCESS_MAP,
    beside,
    headed,
    ink_on,
    paper_handle,
)
from evolution.results import published
from evolution.results.wording import TITLES
from evolution.study.drawn import AND, Drawn, base_of
from evolution.study.table import interval

# What tables call the default of then, and pictures by its name: another has taken its place.
DEFAULT, PLAIN_READINGS = "default", "plain"
ROW_HEIGHT: Final = 0.19  # [inch]


@dataclass(frozen=True)
class Column:
    """One published figure: its value for every run, and the value in the paper by condition."""

    title: str
    values: Callable[[Drawn], NDArray[Any]]
    published: Callable[[Condition], float | None]
    limits: tuple[float | None, float]  # None: as low as the runs are

    __eq__ = alike


def _published_share(condition: Condition) -> float:
    return 100 * published.TABLE_II[condition][-1, SUBTASKS.index("I")] / published.AGENTS


def _published_generalisers(condition: Condition) -> float | None:
    share = 100 * published.RUNS_WITH_GENERALISERS / published.RUNS
    return share if condition is Condition.WITH_INDICATE else None


PERCENT: Final = (-4.0, 104.0)
COLUMNS: Final = (
    Column(
        "plateau of the\nbest fitness", lambda own: own.plateaus, lambda _: published.PLATEAU, (None, 2.62)
    ),
    Column("runs that solve\nall 28 trials [%]", lambda own: 100.0 * own.solved, lambda _: 100.0, PERCENT),
    Column(
        "agents in\ncategory 10 of\nsub-task I [%]",
        lambda own: 100 * own.top_shares,
        _published_share,
        PERCENT,
    ),
    Column(
        "runs with fully\ncompositional\nagents [%]",
        lambda own: 100.0 * own.generalists,
        _published_generalisers,
        PERCENT,
    ),
)


def effects_figure(variants: Sequence[Drawn], base: Drawn | None = None) -> Figure:
    """A row per variant, a column per published figure: runs as dots, their mean with a 95 % interval.

    Args:
        variants: Of one condition.
        base: What all of them stand on, if it is not among them; drawn first.
    """
    rows = [*([] if base is None else [base]), *variants]
    compared = _compared_with(rows)
    with look(STYLE):
        figure = Figure(figsize=(FULL, 1.35 + ROW_HEIGHT * len(rows)), layout="constrained")
        panels = figure.subplots(1, len(COLUMNS), sharey=True, squeeze=False)[0]
        for axes, column in zip(panels, COLUMNS, strict=True):
            _draw_effects(axes, column, rows, compared)
        _name_rows(panels[0], rows, compared)
        panels[0].set_ylim(len(rows) - 0.4, -0.6)
        handles = _handles(compared, published=True)
        figure.legend(handles=handles, loc="outside lower center", ncols=len(handles))
        headed(figure, "What each reading changes", _about(rows))
    return figure


def _compared_with(variants: Sequence[Drawn]) -> str | None:
    """The variant that the others are compared with: what most of them stand on, else the plain one."""
    names = [variant.name for variant in variants]
    return next((name for name in (base_of(variants), DEFAULT) if name in names), None)


def _draw_effects(axes: Axes, column: Column, variants: Sequence[Drawn], compared: str | None) -> None:
    theirs = column.published(variants[0].condition)
    if theirs is not None:
        axes.axvline(theirs, color=PAPER, lw=0.9, ls=PAPER_DASHES, zorder=1)
    for row, variant in enumerate(variants):
        values = column.values(variant)
        low, high = interval(values)
        colour = INK if variant.name == compared else OURS
        if variant.name == compared:
            axes.axvspan(low, high, color=FAINT, alpha=0.15, lw=0, zorder=0)
        spread = np.linspace(-0.25, 0.25, len(values)) if len(values) > 1 else np.zeros(1)
        axes.plot(values, row + spread, "o", ms=2.0, color=colour, alpha=0.4, mew=0, zorder=2)
        axes.plot([low, high], [row, row], color=colour, lw=1.3, zorder=3)
        axes.plot(values.mean(), row, "o", ms=4.2, color=colour, mec="white", mew=0.6, zorder=4)
    axes.set_title(column.title, fontsize=SMALL)
    low, high = column.limits
    lowest = min(column.values(each).min() for each in variants)
    axes.set_xlim(lowest - 0.05 if low is None else low, high)
    axes.xaxis.set_major_locator(MaxNLocator(2, steps=[1, 2, 5, 10]))
    axes.tick_params(axis="y", length=0)
    axes.grid(axis="y", color=FAINT, alpha=0.18, lw=0.5)
    axes.spines["left"].set_visible(False)


def _handles(compared: str | None, *, published: bool) -> list[Line2D | Patch]:
    """What dots, bars, band and dashed line mean."""
    dot: dict[str, Any] = {"marker": "o", "color": OURS}
    handles: list[Line2D | Patch] = [
        Line2D([], [], ls="", ms=2.0, mew=0, alpha=0.6, **dot, label="a run"),
        Line2D([], [], lw=1.3, ms=4.2, mec="white", mew=0.6, **dot, label="mean over runs, 95 % interval"),
    ]
    if compared is not None:
        handles.append(Patch(fc=FAINT, alpha=0.15, lw=0, label="the interval of the row in bold"))
    return [*handles, paper_handle()] if published else handles


def _name_rows(axes: Axes, variants: Sequence[Drawn], compared: str | None) -> None:
    """Names at the left, the row that the others are compared with in bold."""
    axes.set_yticks(range(len(variants)), row_names(variants))
    for label, variant in zip(axes.get_yticklabels(), variants, strict=True):
        label.set_fontweight("bold" if variant.name == compared else "normal")


def row_names(variants: Sequence[Drawn]) -> list[str]:
    """Variants in words; a plus is what most of them stand on, and runs are counted where they differ."""
    base = base_of(variants)
    counted = len({len(variant.seeds) for variant in variants}) > 1
    names = []
    for variant in variants:
        readings = variant.name.split(AND)
        on_top = base in readings and len(readings) > 1
        words = ", ".join(readable(reading) for reading in readings if not (on_top and reading == base))
        count = f"  ({len(variant.seeds)})" if counted else ""
        names.append(f"{'+ ' if on_top else ''}{words}{count}")
    return names


def readable(reading: str) -> str:
    """A reading's name for people: `mutation-sd-0.03` in words; what the tables call the default is plain."""
    return PLAIN_READINGS if reading == DEFAULT else reading.replace("-", " ")


def _about(variants: Sequence[Drawn]) -> str:
    """What all rows share."""
    counts = sorted({len(variant.seeds) for variant in variants})
    runs = f"{counts[0]} runs each" if len(counts) == 1 else "runs in brackets"
    about = f"{TITLES[variants[0].condition]}, {variants[0].generations} generations, {runs}"
    base = base_of(variants)
    return about if base is None else f"{about}; +: on top of {readable(base)}"


def failures_figure(variants: Sequence[Drawn], base: Drawn | None = None) -> Figure:
    """A row per variant: mean success of late agents on each instruction from each start area.

    Args:
        variants: Of one condition.
        base: What all of them stand on, if it is not among them; drawn first.
    """
    rows = [*([] if base is None else [base]), *variants]
    shares = np.array([variant.success.mean(axis=0).ravel() for variant in rows])
    with look(STYLE):
        figure = Figure(figsize=(FULL, 1.15 + ROW_HEIGHT * len(rows)), layout="constrained")
        axes = figure.subplots()
        axes.imshow(100 * shares, cmap=SUCCESS_MAP, vmin=0, vmax=100, aspect="auto")
        for (row, place), share in np.ndenumerate(shares):
            number = axes.text(place, row, f"{100 * share:.0f}", ha="center", va="center", fontsize=SMALL)
            number.set_color(ink_on(share))
        _name_rows(axes, rows, _compared_with(rows))
        _name_columns(axes, variants[0].condition)
        axes.spines[:].set_visible(False)
        shown = "Successful trials [%] from the right (R) and the left (L) start area"
        about = f"{_about(rows)}. {shown}; *\u00a0never\u00a0met"
        headed(figure, "What late agents carry out", about)
    return figure


def _name_columns(axes: Axes, condition: Condition) -> None:
    """Start areas below each other's objects, and these below their action words."""
    axes.tick_params(length=0, top=False, labeltop=True, labelbottom=False)
    axes.set_xticks(range(18), ["R", "L"] * 9)
    for place, instruction in enumerate(condition.instructions):
        star = "" if instruction in condition.experienced else "*"
        look = {"ha": "center", "xycoords": ("data", "axes fraction"), "fontweight": "bold"}
        name = f"{instruction.object.name.capitalize()}{star}"
        colour = OBJECT_COLOURS[instruction.object]
        beside(axes, name, (2 * place + 0.5, 1.0), (0, 11), color=colour, fontsize=SMALL, **look)
        if place % 3 == 0:
            beside(axes, instruction.action.name, (2 * place + 2.5, 1.0), (0, 20), **look)
        axes.axvline(2 * place - 0.5, color="white", lw=2.0 if place % 3 == 0 else 0.8)
