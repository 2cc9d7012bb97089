"""How agents of each class do it: which word their neurons follow and when, and what they need."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from arm2d import Condition
from arm2d.drawing import FULL, INK, SMALL, STYLE, look
from evolution.agents.classes import PARTS
from evolution.agents.lesions import LESIONS
from evolution.agents.subtasks import AgentClass
from evolution.agents.variance import WINDOWS
from evolution.figures.neurons import SHARE_LABELS
from evolution.figures.page import CLASS_COLOURS, FAINT, SHARE_COLOURS
from evolution.results.classes import ClassBehaviour
from evolution.results.wording import TITLES

Behaviours = Mapping[Condition, Mapping[AgentClass, ClassBehaviour]]

# Windows that are shown, of `WINDOWS`: the search, and what follows sight.
SHOWN_WINDOWS: Final = (0, 1)
# A narrower part of a bar has no room for its number [%].
LEAST_TOLD: Final = 9
SHORT: Final = {
    AgentClass.FULL: "fully",
    AgentClass.PARTIAL: "partially",
    AgentClass.NONE: "non-comp.",
}


def classes_figure(behaviours: Behaviours) -> Figure:
    """A row for each condition: shares of variance before and after sight; success with each lesion."""
    with look(STYLE):
        figure = Figure(figsize=(FULL, 0.7 + 3.0 * len(behaviours)), layout="constrained")
        panels = figure.subplots(len(behaviours), 2, squeeze=False, width_ratios=(1, 1.15))
        for (left, right), (condition, classes) in zip(panels, behaviours.items(), strict=True):
            draw_shares(left, list(classes.values()))
            draw_success(right, list(classes.values()))
            left.set_title(f"{TITLES[condition]}: what the neurons follow", fontweight="bold")
            right.set_title("what is left without a word", fontweight="bold")
        shares = [Patch(color=SHARE_COLOURS[part], label=SHARE_LABELS[part]) for part in PARTS]
        figure.legend(handles=shares, loc="outside lower left", ncols=2)
        figure.legend(handles=_class_handles(), loc="outside lower right", ncols=3)
    return figure


def draw_shares(axes: Axes, classes: Sequence[ClassBehaviour]) -> None:
    """A bar for each class in each window, stacked to 100 %; a mean over runs."""
    places, labels = [], []
    for group, window in enumerate(SHOWN_WINDOWS):
        start = group * (len(classes) + 1.1)
        axes.text(0, start - 0.62, list(WINDOWS)[window], fontweight="bold", va="center")
        for row, behaviour in enumerate(classes):
            places.append(start + row)
            labels.append(f"{SHORT[behaviour.kind]}\n{_count(behaviour)}")
            _draw_bar(axes, places[-1], behaviour, window)
    axes.set_yticks(places, labels)
    axes.set(xlim=(0, 100), ylim=(places[-1] + 0.6, -1.0), xlabel="share of the variance [%]")
    axes.tick_params(axis="y", length=0)
    axes.spines["left"].set_visible(False)


def _draw_bar(axes: Axes, place: float, behaviour: ClassBehaviour, window: int) -> None:
    values = behaviour.windows[:, window] if len(behaviour.seeds) else np.empty((0, len(PARTS)))
    values = values[np.isfinite(values).all(axis=1)]
    if not len(values):
        why = "no such agent" if not len(behaviour.seeds) else "too few trials come so far"
        axes.text(1, place, why, va="center", fontsize=SMALL, color=FAINT)
        return
    left = 0.0
    for part, share in zip(PARTS, 100 * values.mean(axis=0), strict=True):
        axes.barh(place, share, 0.78, left=left, color=SHARE_COLOURS[part], lw=0)
        if round(share) >= LEAST_TOLD and part != "rest":
            ink = "white" if part == "action" else INK
            axes.text(
                left + share / 2, place, f"{share:.0f}", ha="center", va="center", fontsize=SMALL, color=ink
            )
        left += share


def draw_success(axes: Axes, classes: Sequence[ClassBehaviour]) -> None:
    """Success of the experienced instructions, intact and with each lesion: runs pale, their mean full."""
    harmless = sum(lesion.harmless for lesion in LESIONS)
    places = np.array([0.0, *(1.6 + i + 1.0 * (not lesion.harmless) for i, lesion in enumerate(LESIONS))])
    for offset, behaviour in zip((-0.24, 0.0, 0.24), classes, strict=True):
        if not len(behaviour.seeds):
            continue
        colour, success = CLASS_COLOURS[behaviour.kind], 100 * behaviour.success(known=True)
        axes.plot(
            success.T, np.tile(places + offset, (len(success), 1)).T, "o", ms=2.4, alpha=0.35, color=colour
        )
        axes.plot(success.mean(axis=0), places + offset, "o", ms=4.8, color=colour, mec="white", mew=0.6)
    for first, text in ((1, "the paper's agent would not mind"), (1 + harmless, "it would fail")):
        axes.text(0, places[first] - 0.72, text, fontweight="bold", va="center")
    names = ["intact", *(f"{lesion.word} word {lesion.manner} {lesion.time}" for lesion in LESIONS)]
    axes.set_yticks(places, names)
    axes.set(xlim=(-2, 102), ylim=(places[-1] + 0.6, -0.7), xlabel="success, experienced instructions [%]")
    axes.grid(axis="y", color=FAINT, alpha=0.25, lw=0.5)
    axes.tick_params(axis="y", length=0)
    axes.spines["left"].set_visible(False)


def _count(behaviour: ClassBehaviour) -> str:
    """Agents and runs behind a bar."""
    agents, runs = int(behaviour.agents.sum()), len(behaviour.seeds)
    if not runs:
        return "none"
    return f"{agents} agent{'s' if agents != 1 else ''}, {runs} run{'s' if runs != 1 else ''}"


def _class_handles() -> list[Line2D]:
    dot: dict[str, Any] = {"ls": "", "marker": "o"}
    return [
        *(
            Line2D([], [], **dot, ms=4.8, color=colour, mec="white", label=str(kind))
            for kind, colour in CLASS_COLOURS.items()
        ),
        Line2D([], [], **dot, ms=4.8, color=INK, mec="white", label="a mean over runs"),
        Line2D([], [], **dot, ms=2.4, color=INK, alpha=0.35, mew=0, label="a run"),
    ]
