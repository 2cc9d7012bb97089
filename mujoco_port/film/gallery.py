"""All instructions of an agent in one video, three by three: the robot and the planar world on its table."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Final

import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle
from numpy.typing import NDArray
from rich.progress import track

from arm2d import NON_EXPERIENCED, Instruction, Readings
from arm2d.constants import DT
from arm2d.drawing import FLOOR, INK, OBJECT_COLOURS, look
from arm2d.films import write_mp4, write_png
from models.robots import Robot
from mujoco_port.film.panel import BADGE, FAINT, UNLIT, blank, mark, pixels
from mujoco_port.film.quality import QUALITIES, Quality
from mujoco_port.film.stage import Stage
from mujoco_port.film.take import Take
from mujoco_port.film.video import PER_SECOND, moment_of, robot_pictures

# Pixels: 1920 x 1080 in all. A cell is a strip of words over the robot.
COLUMNS: Final = 3
WIDTH, HEIGHT, HEADER, GAP = 1920, 1080, 66, 6
CELL_WIDTH: Final = (WIDTH - 4 * GAP) // COLUMNS
CELL_HEIGHT: Final = (HEIGHT - HEADER - 3 * GAP) // COLUMNS
STRIP, CLOCK = 38, 150
VIEW_HEIGHT: Final = CELL_HEIGHT - STRIP
INSET: Final = 150
BORDER: Final = 3  # around a cell of an instruction that was never met
RATE_BAR: Final = (0.64, 0.20)  # left edge and width, in widths of the strip
HOLD_S: Final = 2.0
NORMAL: Final = QUALITIES["normal"]


def write_gallery(
    takes: Sequence[Take],
    robot: Robot,
    title: str,
    path: Path,
    quality: Quality = NORMAL,
    rates: NDArray[np.float64] | None = None,
) -> Path:
    """Write trials side by side as an MP4, and their ends beside it as a PNG of high quality.

    Args:
        takes: Nine trials, row by row.
        robot: Who carries them out.
        title: Whose trials these are.
        path: The video; both files appear when they are complete.
        quality: Of the video.
        rates: [9], how often each instruction is carried out on the plane, from 0 to 1; told in its cell.

    Returns:
        The path of the PNG.

    Raises:
        OSError: If a file cannot be written.
    """
    total = max(len(take.steps) for take in takes) + round(HOLD_S * PER_SECOND)
    shown = track(
        frames(takes, robot, title, quality, rates), f"{len(takes)} instructions on {robot.name}", total=total
    )
    write_mp4(shown, path, PER_SECOND)
    return write_png(last_moments(takes, robot, title, rates), path.with_suffix(".png"))


def frames(
    takes: Sequence[Take],
    robot: Robot,
    title: str,
    quality: Quality = NORMAL,
    rates: NDArray[np.float64] | None = None,
) -> Iterator[NDArray[np.uint8]]:
    """All moments, [1080, 1920, 3] each, until the longest trial has ended and `HOLD_S` longer."""
    picture = _empty(robot, title)
    # So small a picture needs smooth edges.
    with Stage(robot, CELL_WIDTH, VIEW_HEIGHT, replace(quality, oversampling=2), _world(takes)) as stage:
        cells = [cell_pictures(take, stage, rate) for take, rate in _rated(takes, rates)]
        for _ in range(max(len(take.steps) for take in takes)):
            for k, cell in enumerate(cells):
                if (drawn := next(cell, None)) is not None:
                    picture[_place(k)] = drawn
            yield picture.copy()
    for _ in range(round(HOLD_S * PER_SECOND)):
        yield picture


def last_moments(
    takes: Sequence[Take], robot: Robot, title: str, rates: NDArray[np.float64] | None = None
) -> NDArray[np.uint8]:
    """How all trials ended, [1080, 1920, 3], in high quality."""
    picture = _empty(robot, title)
    with Stage(robot, CELL_WIDTH, VIEW_HEIGHT, QUALITIES["high"], _world(takes)) as stage:
        for k, (take, rate) in enumerate(_rated(takes, rates)):
            last = len(take.steps) - 1
            picture[_place(k)] = cell(take, last, moment_of(take, stage, last, INSET), rate)
    return picture


def cell_pictures(take: Take, stage: Stage, rate: float | None = None) -> Iterator[NDArray[np.uint8]]:
    """One trial's cell at each of its moments; the last one shows the verdict."""
    for moment, view in enumerate(robot_pictures(take, stage, INSET)):
        yield cell(take, moment, view, rate)


def cell(take: Take, moment: int, view: NDArray[np.uint8], rate: float | None = None) -> NDArray[np.uint8]:
    """A moment's view; above it words, success rate and clock, and in the end the verdicts."""
    step = take.steps[moment]
    verdicts = tuple(success for _, success in take.verdicts) if step >= take.steps[-1] else ()
    told = strip(take.record.instruction, rate)
    line = np.concatenate([told, clock(f"{step * DT:.1f} s", verdicts)], axis=1)
    picture = np.concatenate([line, view])
    if take.record.instruction in NON_EXPERIENCED:
        _frame(picture)
    return picture


def _world(takes: Sequence[Take]) -> Readings:
    """Of which all trials of a gallery are."""
    return takes[0].record.readings


def _rated(takes: Sequence[Take], rates: NDArray[np.float64] | None) -> list[tuple[Take, float | None]]:
    """Each trial with the success rate of its instruction, where that is known."""
    known = [None] * len(takes) if rates is None else [float(rate) for rate in rates]
    return list(zip(takes, known, strict=True))


def _empty(robot: Robot, title: str) -> NDArray[np.uint8]:
    """The page, without its cells."""
    picture = np.empty((HEIGHT, WIDTH, 3), np.uint8)
    picture[:] = _rgb(FLOOR)
    picture[:HEADER] = header(robot, title)
    return picture


def _place(k: int) -> tuple[slice, slice]:
    """Where the cell of trial k lies on the page."""
    top = HEADER + (k // COLUMNS) * (CELL_HEIGHT + GAP)
    left = GAP + (k % COLUMNS) * (CELL_WIDTH + GAP)
    return slice(top, top + CELL_HEIGHT), slice(left, left + CELL_WIDTH)


@cache
@look()
def strip(instruction: Instruction, rate: float | None = None) -> NDArray[np.uint8]:
    """The words above a cell and how often they are obeyed, but for the clock."""
    figure = blank(CELL_WIDTH - CLOCK, STRIP)
    words = figure.text(0.025, 0.48, str(instruction), va="center", fontsize=14, fontweight="bold")
    words.set_color(OBJECT_COLOURS[instruction.object])
    if instruction in NON_EXPERIENCED:
        figure.text(0.42, 0.48, "never met", va="center", fontsize=9, color=FLOOR, bbox=BADGE)
    if rate is not None:
        _tell_rate(figure, rate)
    return pixels(figure)


def _tell_rate(figure: Figure, rate: float) -> None:
    """A bar that is full where all trials succeed, and the rate beside it."""
    left, width = RATE_BAR
    for share, colour in ((1.0, UNLIT), (rate, INK)):
        figure.add_artist(Rectangle((left, 0.36), width * share, 0.24, color=colour, lw=0))
    figure.text(left + width + 0.02, 0.48, f"{100 * rate:.0f} %", va="center", fontsize=11, color=INK)


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
