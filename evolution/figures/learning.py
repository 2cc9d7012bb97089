"""Learning curves side by side: how much of the seven instructions and of those never met is carried out."""

from __future__ import annotations

from collections.abc import Sequence

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import PercentFormatter

from arm2d.drawing import FULL, STYLE, look
from evolution.figures.page import SERIES, headed
from evolution.results.learning import TRIALS, LearningCurve

# Learning from nothing is shown at a time that a logarithmic axis has [s].
SOONEST = 0.1


def learning_figure(curves: Sequence[LearningCurve]) -> Figure:
    """A panel for the seven and one for each held-out instruction; a colour a learner, a line a seed."""
    condition = curves[0].condition
    held_out = [str(instruction) for instruction in condition.held_out]
    with look(STYLE):
        figure = Figure(figsize=(FULL, 2.5), layout="constrained")
        panels = figure.subplots(1, 1 + len(held_out), sharex=True, sharey=True)
        for axes, title in zip(
            panels, ["the seven, on average", *(f"{w}, never met" for w in held_out)], strict=True
        ):
            axes.set_title(title)
            axes.set_xlabel("processor time [s]")
        learners = list(dict.fromkeys(curve.learner for curve in curves))
        for curve in curves:
            _draw(panels, curve, SERIES[learners.index(curve.learner)])
        panels[0].set(xscale="log", ylim=(-0.02, 1.02), ylabel="trials carried out")
        panels[0].yaxis.set_major_formatter(PercentFormatter(1.0, decimals=0))
        handles = dict(zip(*reversed(panels[0].get_legend_handles_labels()), strict=True))
        figure.legend(handles.values(), handles.keys(), loc="outside lower center", ncols=len(learners))
        headed(figure, "What learners make of the instructions", _origin(curves))
    return figure


def _draw(panels: Sequence[Axes], curve: LearningCurve, colour: str) -> None:
    """One learner's lines in all panels."""
    time = curve.cpu.clip(min=SOONEST)
    for axes, share in zip(panels, [curve.experienced, *curve.held_out.T], strict=True):
        axes.plot(time, share, color=colour, lw=1.0, alpha=0.8, label=curve.learner)


def _origin(curves: Sequence[LearningCurve]) -> str:
    seeds = ", ".join(str(seed) for seed in sorted({curve.seed for curve in curves}))
    tests = f"tests of {TRIALS} fresh trials of each instruction"
    return f"{curves[0].condition}, seeds {seeds}; {tests}; one processor core"
