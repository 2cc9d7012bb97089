"""Fig. 4: what agents of each class make of a word that changes in mid-trial, transition by transition."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import groupby, pairwise
from typing import Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from arm2d.drawing import FULL, INK, OBJECT_COLOURS, STYLE, look
from evolution.agents.transitions import Transition, action_transitions, object_transitions
from evolution.figures.page import CLASS_COLOURS, FAINT, PAPER_DASHES, beside
from evolution.results.records import ConditionResults, Results
from evolution.results.wording import TITLES

NEEDED: Final = 75  # [%], what has to be exceeded in every transition
GAP: Final = 0.6  # between groups [rows]
SHIFT: Final = 0.24  # between classes, which would hide one another [rows]
HEIGHT: Final = 3.05  # of a condition [in]


def transitions_figure(results: Results) -> Figure:
    """Fig. 4: mean success in every transition, class by class; how many agents pass stands in the legend."""
    with look(STYLE):
        figure = Figure(figsize=(FULL, HEIGHT * len(results.conditions) + 0.2), layout="constrained")
        panels = figure.subplots(len(results.conditions), 2, squeeze=False)
        for pair, (condition, found) in zip(panels, results.conditions.items(), strict=True):
            for axes, test, transitions in (
                (pair[0], "action", action_transitions(condition)),
                (pair[1], "object", object_transitions(condition)),
            ):
                _draw_transitions(axes, found, test, transitions)
                axes.set_title(f"{TITLES[condition]}: {test} word changes", fontweight="bold", pad=30)
        for axes in panels[-1]:
            axes.set_xlabel("successful trials [%]")
        needed = Line2D([], [], color=FAINT, lw=0.8, ls=PAPER_DASHES)
        needed.set_label(f"to pass, an agent needs more than {NEEDED} % in every transition")
        mean = Line2D([], [], ls="", marker="o", ms=4, color=FAINT, label="mean over all agents of a class")
        figure.legend(handles=[mean, needed], loc="outside lower center", ncols=2)
    return figure


def _draw_transitions(
    axes: Axes, results: ConditionResults, test: str, transitions: Sequence[Transition]
) -> None:
    places = _places(transitions, test)
    axes.axvline(NEEDED, color=FAINT, lw=0.8, ls=PAPER_DASHES)
    for shift, (kind, outcome) in zip((-SHIFT, 0.0, SHIFT), results.transitions.items(), strict=True):
        passed, success = getattr(outcome, f"{test}_passed"), getattr(outcome, f"{test}_success")
        look = {"ms": 4, "alpha": 0.9, "color": CLASS_COLOURS[kind]}
        if outcome.agents:
            label = f"{kind}: {passed:,} of {outcome.agents:,} pass"
            axes.plot(100 * success, places + shift, "o", label=label, **look)
        else:
            axes.plot([], [], "o", label=f"{kind}: no agent", **look)
    axes.set_yticks(places, [_change(transition, test) for transition in transitions])
    axes.tick_params(axis="y", length=0)
    axes.set(xlim=(-4, 104), ylim=(places[-1] + 0.7, -0.7))
    axes.spines["left"].set_visible(False)
    axes.grid(axis="y", color=FAINT, alpha=0.25, lw=0.5)
    axes.legend(loc="lower left", bbox_to_anchor=(-0.02, 0.99), borderaxespad=0.2, labelspacing=0.2)
    _name_groups(axes, places, transitions, test)


def _places(transitions: Sequence[Transition], test: str) -> np.ndarray:
    """Heights of the rows, with a gap wherever the word that stays is another, [X]."""
    words = [_staying(transition, test) for transition in transitions]
    new = [0, *(later != earlier for earlier, later in pairwise(words))]
    return np.arange(len(transitions)) + GAP * np.cumsum(new)


def _name_groups(axes: Axes, places: np.ndarray, transitions: Sequence[Transition], test: str) -> None:
    """The word that stays, at the right end of its rows."""
    rows = groupby(range(len(transitions)), lambda row: _staying(transitions[row], test))
    for word, own in rows:
        middle = float(np.mean([places[row] for row in own]))
        colour = {w.name.capitalize(): c for w, c in OBJECT_COLOURS.items()}.get(word, INK)
        place = {"rotation": 270, "ha": "left", "va": "center", "xycoords": ("axes fraction", "data")}
        beside(axes, word, (1.0, middle), (3, 0), color=colour, fontweight="bold", **place)


def _staying(transition: Transition, test: str) -> str:
    """The word that does not change."""
    before = transition.before
    return before.object.name.capitalize() if test == "action" else before.action.name


def _change(transition: Transition, test: str) -> str:
    """What changes."""
    before, after = transition.before, transition.after
    if test == "action":
        return f"{before.action.name} → {after.action.name}"
    return f"{before.object.name.capitalize()} → {after.object.name.capitalize()}"
