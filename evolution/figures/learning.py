"""Learners side by side: how they come along on the seven, and what they make of what they never met."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Final

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import PercentFormatter

from arm2d.drawing import FULL, OBJECT_COLOURS, STYLE, look
from evolution.figures.page import FAINT, SERIES, headed
from evolution.results.learning import TRIALS, LearningCurve
from evolution.results.wording import TITLES

# Learning from nothing is shown at a time that a logarithmic axis has [s].
SOONEST: Final = 0.1
# Of the held-out instructions in a row, lest one hide the other.
MARKERS: Final = ("o", "D")
SHIFT: Final = 0.16


def learning_figure(curves: Sequence[LearningCurve]) -> Figure:
    """The seven over time, a colour a learner and a line a seed; beside it both held-out ones in the end."""
    learners = list(dict.fromkeys(curve.learner for curve in curves))
    colours = dict(zip(learners, SERIES, strict=False))
    with look(STYLE):
        figure = Figure(figsize=(FULL, 2.9), layout="constrained")
        over_time, in_the_end = figure.subplots(1, 2, width_ratios=(1.25, 1))
        _draw_over_time(over_time, curves, colours)
        _draw_in_the_end(in_the_end, curves, colours)
        handles = dict(zip(*reversed(over_time.get_legend_handles_labels()), strict=True))
        figure.legend(handles.values(), handles.keys(), loc="outside lower center", ncols=len(learners))
        headed(figure, "What learners make of the instructions", _origin(curves))
    return figure


def _draw_over_time(axes: Axes, curves: Sequence[LearningCurve], colours: Mapping[str, str]) -> None:
    for curve in curves:
        early = int((curve.cpu <= SOONEST).sum())
        shown = slice(max(early - 1, 0), None)  # of what an axis cannot tell apart, the last
        time, colour = curve.cpu.clip(min=SOONEST)[shown], colours[curve.learner]
        axes.plot(time, curve.experienced[shown], color=colour, lw=1.0, alpha=0.8, label=curve.learner)
    axes.set_title("the seven, on average")
    axes.set(xscale="log", ylim=(-0.02, 1.02), xlabel="processor time [s]", ylabel="trials carried out")
    axes.yaxis.set_major_formatter(PercentFormatter(1.0, decimals=0, symbol=" %"))


def _draw_in_the_end(axes: Axes, curves: Sequence[LearningCurve], colours: Mapping[str, str]) -> None:
    """A row for each learner and seed, in which its last test stands."""
    held_out = curves[0].condition.held_out
    for row, curve in enumerate(curves):
        for k, (instruction, share) in enumerate(zip(held_out, curve.held_out[-1], strict=True)):
            place = row + SHIFT * (2 * k - 1)
            colour = OBJECT_COLOURS[instruction.object]
            axes.plot(share, place, MARKERS[k], ms=4.5, color=colour, mec="white", mew=0.5, clip_on=False)
    names = [f"{curve.learner}, {curve.seed}" for curve in curves]
    axes.set_yticks(range(len(curves)), names)
    for label, curve in zip(axes.get_yticklabels(), curves, strict=True):
        label.set_color(colours[curve.learner])
    axes.set_title("never met, in the last test", pad=16)
    axes.set(xlim=(-0.03, 1.03), ylim=(len(curves) - 0.5, -0.5), xlabel="trials carried out")
    axes.xaxis.set_major_formatter(PercentFormatter(1.0, decimals=0, symbol=" %"))
    axes.tick_params(axis="y", length=0)
    axes.grid(axis="y", color=FAINT, alpha=0.25, lw=0.5)
    axes.spines["left"].set_visible(False)
    handles = [
        Line2D([], [], ls="", marker=MARKERS[k], color=OBJECT_COLOURS[word.object], label=str(word))
        for k, word in enumerate(held_out)
    ]
    axes.legend(handles=handles, loc="lower left", bbox_to_anchor=(-0.02, 0.98), ncols=2, borderaxespad=0.2)


def _origin(curves: Sequence[LearningCurve]) -> str:
    tests = f"tests of {TRIALS} fresh trials of each instruction"
    return f"{TITLES[curves[0].condition]}, a line a seed; {tests}; one processor core"
