"""Words beside the robot: the instruction above the 2D world, what became of it below."""

from __future__ import annotations

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from numpy.typing import NDArray

from arm2d import NON_EXPERIENCED, TrialRecord
from arm2d.constants import DT
from arm2d.drawing import FLOOR, INK, OBJECT_COLOURS
from arm2d.video import DPI
from models.robots import Robot

FAINT = "#6B6B6B"
VIEWS = "the robot from the front, its planar world from above:\nwhat is left here is on the robot's left"


def heading(record: TrialRecord, robot: Robot, width_px: int, height_px: int) -> NDArray[np.uint8]:
    """The instruction, large, in the colour of its object; [height, width, 3]."""
    figure = _blank(width_px, height_px)
    instruction = record.instruction
    words = figure.text(0.5, 0.45, str(instruction), ha="center", va="center", fontsize=25, fontweight="bold")
    words.set_color(OBJECT_COLOURS[instruction.object])
    note = "never met during evolution" if instruction in NON_EXPERIENCED else "met during evolution"
    figure.text(0.5, 0.17, f"{note}  ·  {robot.title}", ha="center", fontsize=8.5, color=FAINT)
    return _pixels(figure)


def verdict(record: TrialRecord, ended: bool, width_px: int, height_px: int) -> NDArray[np.uint8]:
    """Whether the instruction was carried out, once the trial has ended; [height, width, 3]."""
    figure = _blank(width_px, height_px)
    figure.text(0.5, 0.12, VIEWS, ha="center", va="bottom", fontsize=8.5, color=FAINT)
    if ended:
        text = "carried out" if record.success else "not carried out"
        figure.text(
            0.5,
            0.62,
            f"{text} in {record.steps * DT:.1f} s",
            ha="center",
            va="center",
            fontsize=14,
            color=INK,
        )
    return _pixels(figure)


def _blank(width_px: int, height_px: int) -> Figure:
    return Figure(figsize=(width_px / DPI, height_px / DPI), dpi=DPI, facecolor=FLOOR)


def _pixels(figure: Figure) -> NDArray[np.uint8]:
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    return np.asarray(canvas.buffer_rgba())[..., :3].copy()
