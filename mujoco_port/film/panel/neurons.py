"""The inter-neurons over time, and four motor neurons."""

from __future__ import annotations

from typing import Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.patches import Rectangle
from numpy.typing import ArrayLike, NDArray

from arm2d.drawing import INK
from mujoco_port.film.panel.sheet import HEIGHT, LEFT, QUIET, RIGHT, UNLIT, rule, write

NEURONS_TOP, MOTORS_TOP = 312, 476  # [px]
NEURONS: Final = ("#1A1A1A", "#7A5AA8", "#B07C1E", "#2F7F86", "#9B2F4B", "#6E7A2A", "#4A5FA5", "#8A877F")
MOTORS: Final = ("S1 go", "S1 way", "S2 go", "S2 way")
TRACE_S: Final = 25.0


def draw_neurons(axes: Axes, count: int) -> tuple[list[Line2D], Line2D]:
    """How each inter-neuron's rate went; beyond eight, colours come again with dashes."""
    top = NEURONS_TOP
    rule(axes, top, f"{count} inter-neuron{'s' * (count != 1)}")
    traces = []
    axes.add_patch(Rectangle((LEFT, top + 20), RIGHT - LEFT, 124, fc="white", ec=UNLIT, lw=0.8))
    for neuron in range(count):
        colour, style = NEURONS[neuron % len(NEURONS)], "-" if neuron < len(NEURONS) else "--"
        (line,) = axes.plot([], [], color=colour, ls=style, lw=1.7, solid_capstyle="round")
        traces.append(line)
    cursor = axes.axvline(LEFT, color=QUIET, lw=0.7)
    cursor.set_ydata([1 - (top + 144) / HEIGHT, 1 - (top + 20) / HEIGHT])
    return traces, cursor


def draw_motors(axes: Axes) -> list[Rectangle]:
    """Four bars: the motor neurons; beyond the middle they switch."""
    top = MOTORS_TOP
    rule(axes, top, "4 motors")
    bars = []
    for k, name in enumerate(MOTORS):
        x = LEFT + 112 * k
        axes.add_patch(Rectangle((x, top + 22), 82, 14, fc=UNLIT, lw=0))
        bar = Rectangle((x, top + 22), 0, 14, fc=INK, lw=0)
        axes.add_patch(bar)
        bars.append(bar)
        axes.plot([x + 41] * 2, [top + 19, top + 39], color=QUIET, lw=0.8)
        write(axes, x, top + 52, name, size=7.5, color=QUIET)
    return bars


def across(seconds: ArrayLike) -> NDArray[np.float64]:
    """Where a time stands in the strip [px]."""
    return LEFT + 4 + (RIGHT - LEFT - 8) * np.asarray(seconds) / TRACE_S


def trace_height(rates: NDArray[np.float64]) -> NDArray[np.float64]:
    """Where a rate stands in the strip [px]."""
    return NEURONS_TOP + 138 - 112 * rates
