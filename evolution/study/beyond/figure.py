"""The study in one picture: a row for each cell, a column for each outcome, both conditions side by side."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from arm2d import NON_EXPERIENCED, Condition, Instruction
from arm2d.drawing import FULL, INK, SMALL, STYLE, look
from arm2d.tasks.task import task_of
from evolution.figures.page import CONDITION_COLOURS, FAINT, SERIES, headed
from evolution.results.wording import TITLES
from evolution.study.beyond.cells import CELLS, PAPER
from evolution.study.beyond.comparisons import Comparison, verdict_of
from evolution.study.beyond.groups import Group
from evolution.study.beyond.outcomes import OUTCOMES, TESTED, UNDERSTOOD, Outcome

# By the third action: where in its row a group is drawn, in which colour, and what that is called.
LOOKS: Final = {
    "indicate": (-0.19, CONDITION_COLOURS[Condition.WITH_INDICATE], TITLES[Condition.WITH_INDICATE]),
    "ignore": (0.19, CONDITION_COLOURS[Condition.WITH_IGNORE], TITLES[Condition.WITH_IGNORE]),
    "both": (0.0, SERIES[2], "INDICATE and IGNORE"),
}
ROW_HEIGHT: Final = 0.27  # [inch]
PERCENT: Final = (-4.0, 104.0)
# Half of the height that the dots of runs are spread over [rows].
SPREAD: Final = 0.11
DOTTED: Final = (0, (1, 1))
NOT_COMPARED: Final = "s"
PAPER_WIDTH: Final = 0.6


def cells_figure(groups: Sequence[Group], found: Sequence[Comparison]) -> Figure:
    """Means over runs with 95 % intervals, runs as dots; filled where a cell differs from the paper's task.

    Args:
        groups: Of measured runs.
        found: Their comparisons.
    """
    cells = [cell for cell in CELLS if any(group.cell == cell for group in groups)]
    with look(STYLE):
        figure = Figure(figsize=(FULL, 1.6 + ROW_HEIGHT * len(cells)), layout="constrained")
        panels = figure.subplots(1, len(OUTCOMES), sharey=True, squeeze=False)[0]
        for axes, outcome in zip(panels, OUTCOMES, strict=True):
            for group in groups:
                _draw(axes, group, outcome, cells.index(group.cell), found)
                _draw_paper(axes, group, outcome, cells.index(group.cell), groups)
            _finish(axes, outcome, groups)
        panels[0].set_yticks(range(len(cells)), [cell.title for cell in cells])
        for label, cell in zip(panels[0].get_yticklabels(), cells, strict=True):
            label.set_fontweight("bold" if cell == PAPER else "normal")
        panels[0].set_ylim(len(cells) - 0.4, -0.6)
        figure.legend(handles=_handles(groups), loc="outside lower center", ncols=3)
        headed(figure, "Other tasks, other networks, more and less held out", _about(groups))
    return figure


def drawn_words(group: Group, outcome: Outcome) -> tuple[Instruction, ...]:
    """The held-out instructions over which a group is drawn: of understanding, those it is compared by."""
    return tuple(word for word in group.held_out if word in NON_EXPERIENCED or outcome != UNDERSTOOD)


def _draw_paper(axes: Axes, group: Group, outcome: Outcome, row: int, groups: Sequence[Group]) -> None:
    """The mean of the paper's task: through all rows, and once more where it is of fewer instructions.

    How often all that is held out is understood can be set beside it only where as much is held out.
    """
    offset, colour, _ = LOOKS[task_of(group.task).third]
    words = drawn_words(group, outcome)
    for paper in _papers_of(group, groups):
        mean = 100 * outcome.values(paper.runs, words).mean()
        theirs = LOOKS[task_of(paper.task).third][1]
        if outcome not in TESTED:
            if len(group.held_out) == len(paper.held_out):
                axes.plot([mean] * 2, [row - 0.5, row + 0.5], color=theirs, lw=PAPER_WIDTH, zorder=1)
        elif group.cell == PAPER:
            axes.axvline(mean, color=colour, lw=PAPER_WIDTH, zorder=1)
        elif outcome == UNDERSTOOD and len(words) < len(paper.held_out):
            ends = [row + offset - 0.17, row + offset + 0.17]
            axes.plot([mean] * 2, ends, color=colour, lw=1.6, ls=DOTTED, zorder=1)


def _papers_of(group: Group, groups: Sequence[Group]) -> list[Group]:
    """The paper's task in the condition of a group, or in both."""
    third = task_of(group.task).third
    return [each for each in groups if each.cell == PAPER and third in ("both", task_of(each.task).third)]


def _draw(axes: Axes, group: Group, outcome: Outcome, row: int, found: Sequence[Comparison]) -> None:
    """One group's runs, mean and interval."""
    offset, colour, _ = LOOKS[task_of(group.task).third]
    words = drawn_words(group, outcome)
    own, y = outcome.estimate(group.runs, words), row + offset
    if not outcome.counts_runs:
        values = 100 * outcome.values(group.runs, words)
        spread = np.linspace(-SPREAD, SPREAD, len(values)) if len(values) > 1 else np.zeros(1)
        axes.plot(values, y + spread, "o", ms=1.8, color=colour, alpha=0.4, mew=0, zorder=2)
    axes.plot([100 * own.low, 100 * own.high], [y, y], color=colour, lw=1.2, zorder=3)
    differs = verdict_of(group, outcome, found) != "undecided"
    face, marker = colour if differs else "white", "o" if outcome in TESTED else NOT_COMPARED
    axes.plot(100 * own.value, y, marker, ms=4.0, mfc=face, mec=colour, mew=0.9, zorder=4)


def _finish(axes: Axes, outcome: Outcome, groups: Sequence[Group]) -> None:
    axes.set_title(outcome.title, fontsize=SMALL)
    lowest = min(100 * outcome.values(group.runs, drawn_words(group, outcome)).min() for group in groups)
    # Only plateaus never come near 0.
    axes.set_xlim(PERCENT[0] if lowest < 20 else lowest - 4, PERCENT[1])
    axes.tick_params(axis="y", length=0)
    axes.grid(axis="y", color=FAINT, alpha=0.18, lw=0.5)
    axes.spines["left"].set_visible(False)


def _handles(groups: Sequence[Group]) -> list[Line2D]:
    """What colours, dots and lines mean."""
    shown = {task_of(group.task).third for group in groups}
    mark: dict[str, Any] = {"marker": "o", "ms": 4.0, "mew": 0.9}
    return [
        *(
            Line2D([], [], color=colour, lw=1.2, mfc="white", mec=colour, label=name, **mark)
            for third, (_, colour, name) in LOOKS.items()
            if third in shown
        ),
        Line2D([], [], color=INK, ls="", **mark, label="differs from the paper's task: p < 0.05 after Holm"),
        Line2D([], [], color=INK, ls="", mfc="white", **mark, label="not shown to differ"),
        Line2D(
            [], [], color=INK, ls="", mfc="white", marker=NOT_COMPARED, ms=4.0, mew=0.9, label="not compared"
        ),
        Line2D([], [], color=INK, ls="", marker="o", ms=1.8, alpha=0.4, mew=0, label="a run"),
        Line2D([], [], color=INK, lw=PAPER_WIDTH, label="mean of the paper's task"),
        Line2D([], [], color=INK, lw=1.6, ls=DOTTED, label="the same, of the words held out here"),
    ]


def _about(groups: Sequence[Group]) -> str:
    counts = sorted({len(group.runs) for group in groups})
    runs = f"{counts[0]}" if len(counts) == 1 else f"{counts[0]} to {counts[-1]}"
    generations = groups[0].runs[0].config.settings.generations
    return (
        f"means over {runs} runs of {generations} generations with 95 % intervals; a cell differs from the "
        "paper's task in what its name says"
    )
