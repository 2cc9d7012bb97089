"""Every level's effect in one picture: both conditions side by side, the published values as lines."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator

from arm2d import Condition
from arm2d.drawing import FULL, INK, SMALL, STYLE, look
from evolution.figures.page import CONDITION_COLOURS, FAINT, PAPER_DASHES, headed
from evolution.results.wording import TITLES
from evolution.study.declared.factors import FACTORS
from evolution.study.declared.regression import SIGNIFICANT, Model

OFFSETS: Final = {Condition.WITH_INDICATE: -0.16, Condition.WITH_IGNORE: 0.16}
ROW_HEIGHT: Final = 0.13  # [inch]
GAP: Final = 0.6  # between factors [rows]


def levels_figure(models: Mapping[Condition, Sequence[Model]], title: str, about: str = "") -> Figure:
    """A row for each level, a column for each outcome: what runs come to on average with that level.

    Dots with 95 % intervals, filled where the factor's corrected p is below 0.05; the thin line is the mean
    over all levels, the dashed one the paper's value. Each condition has its colour.
    """
    rows = _rows()
    outcomes = [model.outcome for model in next(iter(models.values()))]
    height = 1.2 + ROW_HEIGHT * (rows[-1][2] + 1)
    with look(STYLE):
        figure = Figure(figsize=(FULL, height), layout="constrained")
        panels = figure.subplots(1, len(outcomes), sharey=True, squeeze=False)[0]
        for column, axes in enumerate(panels):
            for condition, own in models.items():
                _draw(axes, own[column], condition, rows)
            _finish(axes, outcomes[column].name, is_share=outcomes[column].is_share)
        panels[0].set_yticks([y for *_, y in rows], [_label(f, level) for f, level, _ in rows])
        for label, (_, level, _) in zip(panels[0].get_yticklabels(), rows, strict=True):
            label.set_fontweight("bold" if level == 0 else "normal")
        panels[0].set_ylim(rows[-1][2] + 0.7, -0.7)
        figure.legend(handles=_legend(models), loc="outside lower center", ncols=3)
        headed(figure, title, about)
    return figure


def _legend(conditions: Iterable[Condition]) -> list[Line2D]:
    """What colours and marks mean."""
    dot = {"marker": "o", "ms": 3.2}
    return [
        *(Line2D([], [], color=CONDITION_COLOURS[c], **dot, label=TITLES[c]) for c in conditions),
        Line2D([], [], color=INK, ls="", **dot, label="the factor matters: p < 0.05 after Holm"),
        Line2D([], [], color=INK, ls="", **dot, mfc="white", label="not shown to matter"),
        Line2D([], [], color=INK, lw=0.9, ls=PAPER_DASHES, label="the paper"),
        Line2D([], [], color=INK, lw=0.5, label="mean over all levels"),
    ]


def _rows() -> list[tuple[int, int, float]]:
    """(factor, level, height of its row); the default is a factor's first."""
    rows, y = [], 0.0
    for factor, own in enumerate(FACTORS):
        for level in range(len(own.levels)):
            rows.append((factor, level, y))
            y += 1
        y += GAP
    return rows


def _label(factor: int, level: int) -> str:
    own = FACTORS[factor]
    name = list(own.levels)[level].replace("_", " ").replace("+-", "±")
    return f"{own.name.replace('_', ' ')}: {name}" if level == 0 else name


def _draw(axes: Axes, model: Model, condition: Condition, rows: Sequence[tuple[int, int, float]]) -> None:
    """One outcome of one condition."""
    scale, colour = 100 if model.outcome.is_share else 1, CONDITION_COLOURS[condition]
    means = [model.level_mean(factor, level) for factor, level, _ in rows]
    matters = np.array([model.corrected[factor] < SIGNIFICANT for factor, _, _ in rows])
    y = np.array([row for *_, row in rows]) + OFFSETS[condition]
    low, value, high = (
        scale * np.array([getattr(m, name) for m in means]) for name in ("low", "value", "high")
    )
    # One artist for all rows: hundreds of them would take seconds to draw.
    axes.hlines(y, low, high, color=colour, lw=0.9, zorder=3, capstyle="projecting")
    for shown, face in ((matters, colour), (~matters, "white")):
        axes.plot(value[shown], y[shown], "o", ms=2.8, mfc=face, mec=colour, mew=0.7, zorder=4)
    axes.axvline(scale * float(model.predict(model.levels).mean()), color=colour, lw=0.5, zorder=1)
    published = scale * model.outcome.published(condition)
    axes.axvline(published, color=colour, lw=0.9, ls=PAPER_DASHES, zorder=2)


def _finish(axes: Axes, name: str, *, is_share: bool) -> None:
    name = name.replace(" of ", "\nof ")
    axes.set_title(f"{name} [%]" if is_share else name, fontsize=SMALL, color=INK)
    axes.tick_params(axis="y", length=0)
    axes.xaxis.set_major_locator(MaxNLocator(3))
    axes.grid(axis="y", color=FAINT, alpha=0.15, lw=0.5)
    axes.spines["left"].set_visible(False)
