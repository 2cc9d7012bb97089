"""Eighteen inputs in their groups."""

from __future__ import annotations

from typing import Final

from matplotlib.axes import Axes
from matplotlib.patches import Circle, Rectangle

from arm2d import ObjectWord
from arm2d.drawing import INK, OBJECT_COLOURS
from mujoco_port.film.panel.sheet import FAINT, LEFT, QUIET, UNLIT, rule, write

TOP: Final = 168  # [px]


def draw_senses(axes: Axes) -> tuple[list[tuple[Circle, int, str]], Rectangle]:
    """Eighteen inputs in their groups: lamps, and a bar for how far S2 is bent."""
    top = TOP
    rule(axes, top, "18 inputs")
    lamps = []

    def lamp(x: float, y: float, index: int, colour: str) -> None:
        circle = Circle((x, y), 7.5, lw=0)
        axes.add_patch(circle)
        lamps.append((circle, index, colour))

    write(axes, LEFT, top + 30, "sees", size=9, color=FAINT)
    # Sector 1 is the rightmost; the robot faces the viewer, so it stands on the left.
    for column, name in enumerate(("its right", "ahead", "its left")):
        x = LEFT + 84 + 72 * column
        write(axes, x, top + 30, name, size=7.5, color=QUIET, ha="center")
        for colour, word in enumerate(ObjectWord):
            lamp(x + 19 * (colour - 1), top + 48, 2 + 3 * column + colour, OBJECT_COLOURS[word])
    write(axes, LEFT, top + 82, "feels", size=9, color=FAINT)
    for index, name in enumerate(("right side", "left side")):
        lamp(LEFT + 76 + 94 * index, top + 82, index, INK)
        write(axes, LEFT + 89 + 94 * index, top + 82, name, size=7.5, color=QUIET)
    write(axes, LEFT + 262, top + 82, "S2 bent", size=7.5, color=QUIET)
    place = LEFT + 312, top + 77
    axes.add_patch(Rectangle(place, 112, 10, fc=UNLIT, lw=0))
    bend = Rectangle(place, 0, 10, fc=INK, lw=0)
    axes.add_patch(bend)
    write(axes, LEFT, top + 116, "hears", size=9, color=FAINT)
    for group, (name, first) in enumerate((("action word", 15), ("object word", 12))):
        x = LEFT + 76 + 172 * group
        for k in range(3):
            lamp(x + 19 * k, top + 116, first + k, INK)
        write(axes, x + 54, top + 116, name, size=7.5, color=QUIET)
    return lamps, bend
