"""What goes on inside: the neurons' activity round each event, and which word it follows."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from numpy.typing import NDArray

from arm2d import ObjectWord
from arm2d.drawing import FULL, INK, OBJECT_COLOURS, STYLE, look
from arm2d.network.genes import counted
from evolution.agents.behaviour import Behaviour
from evolution.agents.variance import VarianceShares, bin_times, events_of, mean_by_instruction
from evolution.figures.page import FAINT, SHARE_COLOURS, head

ACTION_STYLES: Final = ("-", (0, (5, 1.6)), (0, (1.2, 1.4)))
SHARE_LABELS: Final = {
    "object": "object word",
    "action": "action word",
    "crossed": "both, beyond their sum",
    "rest": "neither (start, positions, history)",
}


def activity_figure(behaviour: Behaviour, origin: str = "") -> Figure:
    """A page with each inter-neuron's mean output round each event, a line for each instruction."""
    with look(STYLE):
        count = behaviour.activity.shape[-1]
        name, row = ("output of neuron", 3.65 / 3) if count <= 3 else ("neuron", 0.75)
        height = 1.35 + count * row
        figure = Figure(figsize=(FULL, height))
        head(figure, f"What the {counted(count)} {'does' if count == 1 else 'do'}", origin)
        panels = figure.subplots(count, 3, sharey=True, sharex="col", squeeze=False)
        top, bottom = 1 - 0.65 / height, 0.7 / height
        figure.subplots_adjust(left=0.075, right=0.985, top=top, bottom=bottom, hspace=0.1, wspace=0.06)
        for column, (event, rows) in enumerate(events_of(behaviour).items()):
            means = mean_by_instruction(behaviour, rows)
            for neuron in range(count):
                draw_activity(panels[neuron, column], means[..., neuron])
            panels[0, column].set_title(event, fontweight="bold")
            panels[-1, column].set_xlabel("time from it [s]")
        for neuron in range(count):
            panels[neuron, 0].set_ylabel(f"{name} {neuron + 1}")
        handles = object_handles() + _action_handles(behaviour)
        figure.legend(handles=handles, loc="lower center", ncols=6)
    return figure


def draw_activity(axes: Axes, means: NDArray[np.float64]) -> None:
    """Mean outputs of one neuron, [9, B]."""
    axes.axvline(0, color=FAINT, lw=0.8)
    for instruction, mean in enumerate(means):
        colour, style = OBJECT_COLOURS[ObjectWord(instruction % 3)], ACTION_STYLES[instruction // 3]
        axes.plot(bin_times(), mean, color=colour, ls=style, lw=1.1)
    axes.set(ylim=(-0.03, 1.03), yticks=[0, 0.5, 1])


def variance_figure(shares: Mapping[str, VarianceShares], origin: str = "") -> Figure:
    """A page with the shares of variance round each event, by the event's name."""
    with look(STYLE):
        figure = Figure(figsize=(FULL, 2.9))
        head(figure, "Which word the activity follows", origin)
        panels = figure.subplots(1, len(shares), sharey=True, squeeze=False)[0]
        figure.subplots_adjust(left=0.075, right=0.985, top=0.785, bottom=0.23, wspace=0.14)
        for axes, (event, own) in zip(panels, shares.items(), strict=True):
            draw_variance(axes, own)
            axes.set_title(event, fontweight="bold")
            axes.set_xlabel("time from it [s]")
        panels[0].set_ylabel("share of variance [%]")
        handles = [
            Line2D([], [], color=SHARE_COLOURS[name], lw=5, label=text) for name, text in SHARE_LABELS.items()
        ]
        figure.legend(handles=handles, loc="lower center", ncols=4)
    return figure


def draw_variance(axes: Axes, shares: VarianceShares) -> None:
    """Shares of variance stacked to 100 %, where enough trials are left."""
    known = np.isfinite(shares.object)
    if known.any():
        stack = [100 * getattr(shares, name)[known] for name in SHARE_LABELS]
        axes.stackplot(shares.time[known], *stack, colors=list(SHARE_COLOURS.values()), lw=0)
        axes.axvline(0, color=INK, lw=0.8)
        axes.set_xlim(shares.time[known].min(), shares.time[known].max())
    else:
        text = "too few instructions\ncome to it"
        axes.text(0.5, 0.5, text, transform=axes.transAxes, ha="center", va="center", color=FAINT)
        axes.set_xticks([])
    axes.set_ylim(0, 100)


def object_handles() -> list[Line2D]:
    """Colours of the object words."""
    return [
        Line2D([], [], color=OBJECT_COLOURS[word], lw=2.0, label=word.name.capitalize())
        for word in ObjectWord
    ]


def _action_handles(behaviour: Behaviour) -> list[Line2D]:
    """Line styles of the action words."""
    actions = [word.action.name for word in behaviour.condition.instructions[::3]]
    return [
        Line2D([], [], color=INK, lw=1.1, ls=style, label=name)
        for name, style in zip(actions, ACTION_STYLES, strict=True)
    ]
