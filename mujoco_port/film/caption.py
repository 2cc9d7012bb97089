"""Words beside the robot: the instruction above the 2D world, what became of it below."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from numpy.typing import NDArray

from arm2d import NON_EXPERIENCED, Instruction
from arm2d.constants import DT
from arm2d.drawing import FLOOR, INK, OBJECT_COLOURS, look
from arm2d.video import DPI

FAINT: Final = "#6B6B6B"
VIEWS: Final = (
    "the robot from the front, its planar world from above:\nwhat is left here is on the robot's left"
)
NEVER_MET: Final = "never met during evolution"
BADGE: Final = {"boxstyle": "round,pad=0.45", "fc": INK, "ec": "none"}


@look()
def heading(instruction: Instruction, title: str, width_px: int, height_px: int) -> NDArray[np.uint8]:
    """The instruction, large, in the colour of its object; [height, width, 3].

    Args:
        instruction: What was asked.
        title: Whose body carries it out.
        width_px: Width and
        height_px: height of the picture.
    """
    figure = blank(width_px, height_px)
    words = figure.text(0.5, 0.60, str(instruction), ha="center", va="center", fontsize=27, fontweight="bold")
    words.set_color(OBJECT_COLOURS[instruction.object])
    if instruction in NON_EXPERIENCED:
        figure.text(0.5, 0.30, NEVER_MET, ha="center", va="center", fontsize=9, color=FLOOR, bbox=BADGE)
    else:
        figure.text(0.5, 0.30, "met during evolution", ha="center", va="center", fontsize=9, color=FAINT)
    figure.text(0.5, 0.08, title, ha="center", va="center", fontsize=8, color=FAINT)
    return pixels(figure)


@look()
def footing(
    verdicts: Sequence[tuple[str, bool]], seconds: float, width_px: int, height_px: int
) -> NDArray[np.uint8]:
    """How to read the two views and, if there are verdicts, what became of the instruction.

    Args:
        verdicts: Who judges, and whether the instruction was carried out; none while the trial runs.
        seconds: How long the trial took.
        width_px: Width and
        height_px: height of the picture.
    """
    figure = blank(width_px, height_px)
    figure.text(0.5, 0.10, VIEWS, ha="center", va="bottom", fontsize=8.5, color=FAINT)
    for line, (judge, success) in enumerate(verdicts):
        height = 0.66 + 0.20 * (len(verdicts) - 1) / 2 - 0.20 * line
        text = f"{mark(success)}  {judge}: {'carried out' if success else 'not carried out'}"
        text += f" in {seconds:.1f} s" if len(verdicts) == 1 else ""
        figure.text(0.5, height, text, ha="center", va="center", fontsize=14, color=INK)
    return pixels(figure)


def mark(success: bool) -> str:
    """A sign that needs no colour."""
    return "\N{CHECK MARK}" if success else "\N{MULTIPLICATION X}"


def duration(steps: float) -> float:
    """[s] of so many control steps."""
    return steps * DT


def blank(width_px: int, height_px: int, colour: str = FLOOR) -> Figure:
    """An empty figure of this size."""
    return Figure(figsize=(width_px / DPI, height_px / DPI), dpi=DPI, facecolor=colour)


def pixels(figure: Figure) -> NDArray[np.uint8]:
    """A figure as a picture, [height, width, 3]."""
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    return np.asarray(canvas.buffer_rgba())[..., :3].copy()
