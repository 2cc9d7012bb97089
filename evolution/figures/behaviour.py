"""What an agent does: trajectories of the nine instructions, and what lesions leave of them."""

from __future__ import annotations

from typing import Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, Rectangle
from numpy.typing import NDArray

from arm2d import NON_EXPERIENCED, Instruction, ObjectWord, Readings
from arm2d.constants import ALPHA_MAX, ALPHA_MIN, BETA_MAX, DT
from arm2d.drawing import FULL, INK, OBJECT_COLOURS, SMALL, STYLE, look
from evolution.agents.behaviour import Behaviour
from evolution.agents.firsts import NEVER
from evolution.agents.lesions import LESIONS, LesionScores
from evolution.figures.page import FAINT, SUCCESS_MAP, beside, draw_alike, head, ink_on

FAILED: Final = "#A8A49B"
DASHES: Final = (0, (4, 2.5))
# Of lines from the right and from the left start area.
AREA_STYLES: Final = ("-", (0, (3, 1.2)))
SHOWN_PER_AREA: Final = 10
MARGIN: Final = 7.0  # beyond the bounds [deg], lest a line at one lie under the frame


def trajectories_figure(behaviour: Behaviour, readings: Readings, origin: str = "") -> Figure:
    """A page with both joint angles over time, a panel for each instruction."""
    with look(STYLE):
        figure = Figure(figsize=(FULL, 7.3))
        head(figure, "What the arm does", origin)
        grid = figure.add_gridspec(
            3, 3, left=0.075, right=0.985, top=0.905, bottom=0.085, hspace=0.24, wspace=0.08
        )
        end = DT * behaviour.steps.max()
        for place, instruction in enumerate(behaviour.condition.instructions):
            cell = grid[place // 3, place % 3].subgridspec(2, 1, height_ratios=(2.6, 1), hspace=0.07)
            above, below = figure.add_subplot(cell[0]), figure.add_subplot(cell[1])
            draw_alpha(above, behaviour, instruction, readings)
            draw_beta(below, behaviour, instruction)
            for axes in (above, below):
                axes.set_xlim(0, end)
                if place % 3:
                    axes.set_yticklabels([])
            if place % 3 == 0:
                above.set_ylabel("alpha [°]")
                below.set_ylabel("beta [°]")
            below.set_xlabel("time [s]" if place > 5 else "")
        figure.legend(handles=trajectory_handles(), loc="lower center", ncols=6)
    return figure


def draw_alpha(axes: Axes, behaviour: Behaviour, instruction: Instruction, readings: Readings) -> None:
    """S1's angle over time in the trials of an instruction; the objects' sectors lie behind it."""
    for object_, centre in zip(ObjectWord, readings.sector_centres, strict=True):
        low, high = centre - readings.sector_half_width, centre + readings.sector_half_width
        axes.axhspan(low, high, color=OBJECT_COLOURS[object_], alpha=0.13, lw=0)
    _draw_lines(axes, behaviour, instruction, behaviour.alpha)
    axes.set(ylim=(ALPHA_MIN - MARGIN, ALPHA_MAX + MARGIN), yticks=[30, 90, 150, 210], xticklabels=[])
    colour = OBJECT_COLOURS[instruction.object]
    rate = f"{100 * behaviour.success[behaviour.of(instruction)].mean():.0f} %"
    never_met = ", never met" if instruction in NON_EXPERIENCED else ""
    axes.set_title(f"{instruction}", fontsize="medium", fontweight="bold", color=colour, pad=3)
    axes.set_title(f"{rate}{never_met}", loc="right", fontsize=SMALL, color=INK, pad=3)
    _frame(axes, instruction)


def draw_beta(axes: Axes, behaviour: Behaviour, instruction: Instruction) -> None:
    """S2's angle over time in the trials of an instruction; 90 is bent, 0 straight."""
    _draw_lines(axes, behaviour, instruction, behaviour.beta)
    axes.set(ylim=(-MARGIN, BETA_MAX + MARGIN), yticks=[0, 90])
    _frame(axes, instruction)


def _draw_lines(
    axes: Axes, behaviour: Behaviour, instruction: Instruction, angles: NDArray[np.float64]
) -> None:
    """A line for each trial, with first sight and first touch marked."""
    trials = behaviour.of(instruction)
    shown = np.concatenate([trials[behaviour.areas[trials] == area][:SHOWN_PER_AREA] for area in (0, 1)])
    paths = {trial: _over_time(angles[trial, : behaviour.steps[trial] + 1]) for trial in shown}
    for good, colour in ((False, FAILED), (True, OBJECT_COLOURS[instruction.object])):
        for area, style in enumerate(AREA_STYLES):
            alike = shown[(behaviour.success[shown] == good) & (behaviour.areas[shown] == area)]
            draw_alike(axes, [paths[trial] for trial in alike], color=colour, ls=style, lw=0.7, alpha=0.8)
    look = {"ms": 2.2, "mec": INK, "mew": 0.4, "zorder": 4, "clip_on": False}
    for rows, marker, face in ((behaviour.first_sight, "o", "white"), (behaviour.first_touch, "D", INK)):
        met = shown[rows[shown] != NEVER]
        axes.plot(DT * rows[met], angles[met, rows[met]], marker, mfc=face, **look)


def _over_time(values: NDArray[np.float64]) -> NDArray[np.float64]:
    """Times [s] and values of steps, [K, 2]."""
    return np.stack([DT * np.arange(len(values), dtype=np.float64), values], axis=1)


def trajectory_handles() -> list[Line2D | Patch]:
    """What lines and markers mean."""
    return [
        *(
            Line2D([], [], color=INK, ls=style, label=label)
            for style, label in zip(AREA_STYLES, ("from the right", "from the left"), strict=True)
        ),
        Line2D([], [], color=FAILED, label="not carried out"),
        Line2D([], [], ls="", marker="o", ms=4, mfc="white", mec=INK, label="first sight of the target"),
        Line2D([], [], ls="", marker="D", ms=4, color=INK, label="first touch of the target"),
        Patch(fc=FAINT, alpha=0.2, lw=0, label="the objects' sectors"),
    ]


def lesions_figure(scores: LesionScores, origin: str = "") -> Figure:
    """A page with success without and with each lesion, a row for each instruction; a mean over agents."""
    with look(STYLE):
        figure = Figure(figsize=(FULL, 4.0))
        head(figure, "Which word is needed, and when", origin)
        axes = figure.add_axes((0.14, 0.085, 0.85, 0.65))
        draw_lesions(axes, scores)
        note = f"Success in {2 * scores.per_area} trials, the same in every column. "
        note += "Exchanged: a mean over both other words. Dashed: never met."
        figure.text(0.14, 0.03, note, fontsize=SMALL, color=FAINT)
    return figure


def draw_lesions(axes: Axes, scores: LesionScores) -> None:
    """Instructions by lesions: success in per cent, a mean over agents."""
    table = np.vstack([scores.intact.mean(axis=0), scores.lesioned.mean(axis=0)]).T  # [9, 1 + lesions]
    # Room between the intact agent, the lesions it should not mind, and those it should.
    places = np.array([0.0, *(1.3 + i + 0.3 * (not lesion.harmless) for i, lesion in enumerate(LESIONS))])
    for row, instruction in enumerate(scores.condition.instructions):
        for place, share in zip(places, table[row], strict=True):
            axes.add_patch(
                Rectangle((place + 0.02, row + 0.04), 0.96, 0.92, fc=SUCCESS_MAP(share), ec="none")
            )
            number = axes.text(place + 0.5, row + 0.52, f"{100 * share:.0f}")
            number.set(ha="center", va="center", color=ink_on(share))
        if instruction in NON_EXPERIENCED:
            frame = Rectangle((-0.04, row - 0.02), places[-1] + 1.08, 1.04, fill=False, ec=FAINT)
            frame.set(linestyle=DASHES, linewidth=0.9, zorder=3, clip_on=False)
            axes.add_patch(frame)
    axes.set(xlim=(0, places[-1] + 1), ylim=(9, 0))
    axes.set_yticks(np.arange(9) + 0.5, [str(word) for word in scores.condition.instructions])
    for label, instruction in zip(axes.get_yticklabels(), scores.condition.instructions, strict=True):
        label.set(color=OBJECT_COLOURS[instruction.object], fontweight="bold")
    names = ["intact", *(f"{lesion.word} word\n{lesion.manner}\n{lesion.time}" for lesion in LESIONS)]
    axes.set_xticks(places + 0.5, names)
    axes.tick_params(length=0, pad=4, top=False, labeltop=True, labelbottom=False)
    axes.spines[:].set_visible(False)
    for start, text in ((1, "the paper's agent would not mind"), (5, "the paper's agent would fail")):
        middle = (places[start] + places[start + 3] + 1) / 2
        beside(axes, text, (middle, 0), (0, 34), ha="center", fontweight="bold")


def _frame(axes: Axes, instruction: Instruction) -> None:
    """Plain axes, or a dashed frame round what was never met."""
    if instruction in NON_EXPERIENCED:
        axes.spines[:].set(visible=True, linestyle=DASHES, color=OBJECT_COLOURS[instruction.object])
