"""All instructions of an agent in one video, three by three: the robot and its planar world in each cell."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from functools import cache
from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray
from rich.progress import track

from arm2d import NON_EXPERIENCED, Instruction
from arm2d.constants import DT
from arm2d.drawing import FLOOR, INK, OBJECT_COLOURS, look
from arm2d.films import write_mp4, write_png
from arm2d.video import Panel
from models.robots import Robot
from mujoco_port.film.caption import BADGE, FAINT, blank, mark, pixels
from mujoco_port.film.overlay import halved
from mujoco_port.film.stage import Stage
from mujoco_port.film.take import Take
from mujoco_port.film.video import PER_SECOND, robot_pictures

# Pixels: 1920 x 1080 in all. A cell is a strip of words over robot and planar world.
COLUMNS: Final = 3
WIDTH, HEIGHT, HEADER, GAP = 1920, 1080, 66, 6
CELL_WIDTH: Final = (WIDTH - 4 * GAP) // COLUMNS
CELL_HEIGHT: Final = (HEIGHT - HEADER - 3 * GAP) // COLUMNS
STRIP, CLOCK = 38, 150
VIEW_HEIGHT: Final = CELL_HEIGHT - STRIP
ROBOT_WIDTH: Final = 404
PANEL_WIDTH: Final = CELL_WIDTH - ROBOT_WIDTH
BORDER: Final = 3  # around a cell of an instruction that was never met
HOLD_S: Final = 2.0


def write_gallery(takes: Sequence[Take], robot: Robot, title: str, path: Path) -> Path:
    """Write trials side by side as an MP4, and its last picture beside it as a PNG.

    Args:
        takes: Nine trials, row by row.
        robot: Who carries them out.
        title: Whose trials these are.
        path: The video; both files appear when they are complete.

    Returns:
        The path of the PNG.

    Raises:
        OSError: If a file cannot be written.
    """
    total = max(len(take.steps) for take in takes) + round(HOLD_S * PER_SECOND)
    shown = track(frames(takes, robot, title), f"{len(takes)} instructions on {robot.name}", total=total)
    poster, last = path.with_suffix(".png"), []
    write_mp4(remember_last(shown, last), path, PER_SECOND)
    return write_png(last[0], poster)


def remember_last(
    pictures: Iterable[NDArray[np.uint8]], last: list[NDArray[np.uint8]]
) -> Iterator[NDArray[np.uint8]]:
    """The pictures, one after the other; `last` holds the one that came last."""
    for picture in pictures:
        last[:] = [picture]
        yield picture


def frames(takes: Sequence[Take], robot: Robot, title: str) -> Iterator[NDArray[np.uint8]]:
    """All moments, [1080, 1920, 3] each, until the longest trial has ended and `HOLD_S` longer."""
    picture = np.empty((HEIGHT, WIDTH, 3), np.uint8)
    picture[:] = _rgb(FLOOR)
    picture[:HEADER] = header(robot, title)
    with Stage(robot, 2 * ROBOT_WIDTH, 2 * VIEW_HEIGHT) as stage:
        cells = [cell_pictures(take, stage) for take in takes]
        for _ in range(max(len(take.steps) for take in takes)):
            for k, cell in enumerate(cells):
                if (drawn := next(cell, None)) is not None:
                    top = HEADER + (k // COLUMNS) * (CELL_HEIGHT + GAP)
                    left = GAP + (k % COLUMNS) * (CELL_WIDTH + GAP)
                    picture[top : top + CELL_HEIGHT, left : left + CELL_WIDTH] = drawn
            yield picture.copy()
    for _ in range(round(HOLD_S * PER_SECOND)):
        yield picture


def cell_pictures(take: Take, stage: Stage) -> Iterator[NDArray[np.uint8]]:
    """One trial's cell at each of its moments; the last one shows the verdict."""
    panel = Panel(take.record, PANEL_WIDTH, VIEW_HEIGHT, caption=False)
    words = strip(take.record.instruction)
    views = (halved(each) for each in robot_pictures(take, stage))
    end = take.record.steps  # of the planar world, where a robot may need longer
    for step, robot in zip(take.steps, views, strict=True):
        verdicts = tuple(success for _, success in take.verdicts) if step >= take.steps[-1] else ()
        line = np.concatenate([words, clock(f"{step * DT:.1f} s", verdicts)], axis=1)
        cell = np.concatenate([line, np.concatenate([robot, panel.frame(min(step, end))], axis=1)])
        if take.record.instruction in NON_EXPERIENCED:
            _frame(cell)
        yield cell


@look()
def strip(instruction: Instruction) -> NDArray[np.uint8]:
    """The words above a cell, but for the clock."""
    figure = blank(CELL_WIDTH - CLOCK, STRIP)
    words = figure.text(0.025, 0.48, str(instruction), va="center", fontsize=14, fontweight="bold")
    words.set_color(OBJECT_COLOURS[instruction.object])
    if instruction in NON_EXPERIENCED:
        figure.text(0.42, 0.48, "never met", va="center", fontsize=9, color=FLOOR, bbox=BADGE)
    return pixels(figure)


@cache
@look()
def clock(text: str, verdicts: tuple[bool, ...]) -> NDArray[np.uint8]:
    """The time and, once it has stopped, the verdicts: the planar world's, then the robot's."""
    figure = blank(CLOCK, STRIP)
    signs = "".join(f"{mark(success)} " for success in verdicts)
    weight = "bold" if verdicts else "normal"
    figure.text(
        0.90,
        0.48,
        f"{signs} {text}" if signs else text,
        ha="right",
        va="center",
        fontsize=12,
        fontweight=weight,
        color=INK,
    )
    return pixels(figure)


@look()
def header(robot: Robot, title: str) -> NDArray[np.uint8]:
    """The line above all cells."""
    figure = blank(WIDTH, HEADER)
    figure.text(0.012, 0.5, title, va="center", fontsize=19, fontweight="bold", color=INK)
    figure.text(0.988, 0.5, robot.title, ha="right", va="center", fontsize=10, color=FAINT)
    return pixels(figure)


def _frame(cell: NDArray[np.uint8]) -> None:
    """Draw a dark border into a cell."""
    for edge in (cell[:BORDER], cell[-BORDER:], cell[:, :BORDER], cell[:, -BORDER:]):
        edge[:] = _rgb(INK)


def _rgb(colour: str) -> NDArray[np.uint8]:
    return np.frombuffer(bytes.fromhex(colour[1:]), np.uint8)
