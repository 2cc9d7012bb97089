"""The skills of an agent's ancestors over the generations, one thin row for each skill."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import ArrayLike, NDArray

from arm2d import NON_EXPERIENCED, Instruction
from arm2d.drawing import FULL, INK, OBJECT_COLOURS, SMALL, STYLE, look
from arm2d.records import alike, brief
from evolution.agents.firsts import NEVER
from evolution.agents.lineage_scores import IN_A_ROW, LineageScores, Skills
from evolution.figures.page import FAINT, SHARE_COLOURS, beside, head

ROW_HEIGHT: Final = 0.28  # [in]
GROUP_GAP: Final = 0.24  # [in]
HEAD: Final = 0.7  # [in]
FOOT: Final = 0.66  # [in]
LEFT, RIGHT = 0.19, 0.965
TICKS: Final = (0, 10, 50, 100, 250, 500, 1000, 2000, 3000, 4000, 5000, 6000)
BENT_COLOUR: Final = SHARE_COLOURS["action"]
# What lies under a flag's number, so that it can be read on any row.
PAPER: Final = {"boxstyle": "round,pad=0.15", "fc": "white", "ec": "none", "alpha": 0.88}


@dataclass(frozen=True)
class Row:
    """One skill.

    Attributes:
        label: What it is called.
        colour: Of its object.
        shares: [G], share of trials in which ancestors had it.
        first: Generation in which it first came, or -1.
        for_good: Generation in which it came for good, or -1.
        never_met: Whether it was never asked for during evolution.
        beside: [G], a weaker form of the skill, drawn faintly; or nothing.
    """

    label: str
    colour: str
    shares: NDArray[np.float64]
    first: int
    for_good: int
    never_met: bool = False
    beside: NDArray[np.float64] | None = None

    __repr__ = brief
    __eq__ = alike


def lineage_figure(scores: LineageScores, origin: str = "") -> Figure:
    """A page with twelve rows: S1 on the target with S2 bent by action word, then the nine instructions."""
    groups = skill_rows(scores)
    n_rows = sum(len(rows) for _, rows in groups)
    height = HEAD + FOOT + n_rows * ROW_HEIGHT + len(groups) * GROUP_GAP
    with look(STYLE):
        figure = Figure(figsize=(FULL, height))
        head(figure, "The agent's line of ancestors", origin)
        top = height - HEAD
        for title, rows in groups:
            figure.text(0.015, (top + 0.03) / height, title, fontweight="bold", va="bottom")
            for row in rows:
                top -= ROW_HEIGHT
                axes = figure.add_axes((LEFT, top / height, RIGHT - LEFT, 0.82 * ROW_HEIGHT / height))
                draw_skill(axes, row)
            top -= GROUP_GAP
        _draw_generations(axes, len(scores.success.shares))
        figure.text(0.015, 0.06 / height, _legend(scores), fontsize=SMALL, color=FAINT, linespacing=1.3)
    return figure


def skill_rows(scores: LineageScores) -> list[tuple[str, Sequence[Row]]]:
    """The rows of the figure by the title of their group."""
    actions = [word.action for word in scores.condition.instructions[::3]]
    held, beside = scores.held_bent, scores.reached_bent.shares
    bent = [
        Row(f"hearing {action.name}", BENT_COLOUR, *_column(held, column), beside=beside[:, column])
        for column, action in enumerate(actions)
    ]
    rows = [
        _instruction_row(instruction, *_column(scores.success, column))
        for column, instruction in enumerate(scores.condition.instructions)
    ]
    groups = [(action.name, rows[3 * i : 3 * i + 3]) for i, action in enumerate(actions)]
    return [("S1 on the target, S2 bent, for 1 s", bent), *groups]


def _instruction_row(instruction: Instruction, shares: NDArray[np.float64], first: int, for_good: int) -> Row:
    """The row of carrying out an instruction, in the colour of its object."""
    name, colour = instruction.object.name.capitalize(), OBJECT_COLOURS[instruction.object]
    return Row(name, colour, shares, first, for_good, never_met=instruction in NON_EXPERIENCED)


def draw_skill(axes: Axes, row: Row) -> None:
    """One row: the share of trials from 0 to 100 %, and where the skill came to stay."""
    generations = np.arange(len(row.shares))
    axes.set_xscale("function", functions=(_root, np.square))
    axes.set(xlim=(0, max(len(generations) - 1, 1)), ylim=(0, 1.0), yticks=[], xticks=[])
    axes.minorticks_off()
    axes.set_facecolor("#F6F5F2")
    if row.beside is not None:
        axes.fill_between(generations, row.beside, step="post", color=row.colour, alpha=0.16, lw=0)
    axes.fill_between(generations, row.shares, step="post", color=row.colour, alpha=0.75, lw=0)
    axes.spines[:].set_visible(False)
    axes.set_ylabel(row.label, rotation=0, ha="right", va="center", color=row.colour, fontweight="bold")
    if row.never_met:
        axes.spines[:].set(visible=True, color=row.colour, linestyle=(0, (4, 2.5)), linewidth=0.8)
        axes.set_ylabel(f"never met   {row.label}", rotation=0, ha="right", va="center", color=row.colour)
    # What came with the last few generations has had no time to go again.
    lasts = row.for_good not in (NEVER, row.first) and row.for_good <= len(row.shares) - IN_A_ROW
    if lasts:
        _mark(axes, row.for_good, FAINT, leftwards=_place(axes, row.for_good) > 0.94)
    if row.first != NEVER:
        room = 0.07 if lasts else 0.94
        _mark(axes, row.first, INK, leftwards=_place(axes, row.first) > room)


def _mark(axes: Axes, generation: int, colour: str, *, leftwards: bool) -> None:
    """A flag where a skill came, with its number on either side."""
    axes.axvline(generation, color=colour, lw=1.0)
    look = {"va": "center", "fontsize": SMALL, "fontweight": "bold", "color": colour, "bbox": PAPER}
    offset, side = ((-4, 0), "right") if leftwards else ((4, 0), "left")
    beside(axes, f"{generation:,}", (generation, 0.5), offset, ha=side, **look)


def _place(axes: Axes, generation: int) -> float:
    """Where a generation stands between the left (0) and the right end (1) of its row."""
    return float(_root(generation) / _root(axes.get_xlim()[1]))


def _draw_generations(axes: Axes, n_generations: int) -> None:
    """The axis below the lowest row."""
    ticks = [tick for tick in TICKS if tick < n_generations]
    axes.set_xticks(ticks, [f"{tick:,}" for tick in ticks])
    axes.set_xlabel("generation (square-root scale)")


def _legend(scores: LineageScores) -> str:
    """What is to be seen."""
    return (
        f"Height of a row: share of {2 * scores.per_area} trials carried out, 0 to 100 %. "
        "Flags: generation in which the skill first came\n"
        f"(black: {IN_A_ROW} generations in a row above 75 %) and in which it came for good, "
        f"if later (grey: {IN_A_ROW} at least,\nthe agent, and nine tenths of the rest). "
        "S2 bent: beta above 45° while S1 is on the target, for a second (dark) or at all (pale)."
    )


def _column(skills: Skills, column: int) -> tuple[NDArray[np.float64], int, int]:
    """Shares of trials [G] and both innovations of one skill."""
    return skills.shares[:, column], int(skills.first[column]), int(skills.for_good[column])


def _root(values: ArrayLike) -> NDArray[np.float64]:
    """The square root, which gives the early generations room; 0 for what an axis tries below it."""
    return np.sqrt(np.maximum(values, 0))
