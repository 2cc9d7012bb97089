"""Frames of a trial on the robot, the 2D world beside it, to one MP4."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray
from rich.progress import track

from arm2d import TrialRecord
from arm2d.constants import DT
from arm2d.films import write_mp4
from arm2d.video import Panel
from models.robots import Robot
from mujoco_port.film.caption import footing, heading
from mujoco_port.film.kinematic import FRAMES_PER_STEP
from mujoco_port.film.overlay import halved
from mujoco_port.film.stage import Stage
from mujoco_port.film.take import Take, kinematic_take

HEIGHT_PX: Final = 720
ROBOT_WIDTH_PX: Final = 800
PANEL_WIDTH_PX: Final = 480
PANEL_HEIGHT_PX: Final = 400
CAPTION_HEIGHT_PX: Final = (HEIGHT_PX - PANEL_HEIGHT_PX) // 2
VISIBLE: Final = 2e-4  # [rad] and [m]; a smaller change is a fifth of a pixel and is not drawn anew
HOLD_S: Final = 1.0  # the last frame stays for so long
PER_SECOND: Final = round(FRAMES_PER_STEP / DT)


def write_video(record: TrialRecord, robot: Robot, path: Path) -> None:
    """Write a trial on the robot as an MP4 in real time; the file appears when it is complete.

    Raises:
        OutOfReachError: If the robot cannot follow.
        OSError: If the file cannot be written.
    """
    write_take(kinematic_take(record, robot, FRAMES_PER_STEP), robot, path)


def write_take(take: Take, robot: Robot, path: Path) -> None:
    """Write what happened on the robot as an MP4, `PER_SECOND` moments of the take in a second.

    Raises:
        OSError: If the file cannot be written.
    """
    total = len(take.steps) + round(HOLD_S * PER_SECOND)
    shown = track(held(frames(take, robot)), f"{take.record.instruction} on {robot.name}", total=total)
    write_mp4(shown, path, PER_SECOND)


def held(pictures: Iterable[NDArray[np.uint8]]) -> Iterator[NDArray[np.uint8]]:
    """The pictures, the last of which stays for `HOLD_S`."""
    picture = np.empty(0, np.uint8)
    for picture in pictures:
        yield picture
    for _ in range(round(HOLD_S * PER_SECOND)):
        yield picture


class Side:
    """What stands beside the robot: the instruction, the 2D world, and at the end the verdicts."""

    def __init__(self, take: Take, robot: Robot) -> None:
        instruction, seconds = take.record.instruction, take.record.steps * DT
        size = PANEL_WIDTH_PX, CAPTION_HEIGHT_PX
        self._end, self._planar_end = take.steps[-1], take.record.steps
        self._above = heading(instruction, robot.title, *size)
        self._running = footing((), seconds, *size)
        self._ended = footing(take.verdicts, seconds, *size)
        self._panel = Panel(take.record, PANEL_WIDTH_PX, PANEL_HEIGHT_PX, caption=False)

    def frame(self, step: float) -> NDArray[np.uint8]:
        """The picture after `step` steps, [720, 480, 3]."""
        below = self._ended if step >= self._end else self._running
        return np.concatenate([self._above, self._panel.frame(min(step, self._planar_end)), below])


def frames(take: Take, robot: Robot) -> Iterator[NDArray[np.uint8]]:
    """All moments of a take, [720, 1280, 3] each: the robot on the left, the 2D world on the right."""
    side = Side(take, robot)
    with Stage(robot, ROBOT_WIDTH_PX, HEIGHT_PX) as stage:
        for step, picture in zip(take.steps, robot_pictures(take, stage), strict=True):
            yield np.concatenate([picture, side.frame(step)], axis=1)


def robot_pictures(take: Take, stage: Stage) -> Iterator[NDArray[np.uint8]]:
    """The robot's view at each moment; a moment that looks like the one before is not drawn anew."""
    picture, drawn = np.empty(0, np.uint8), np.empty(0)
    for angles, objects, touched in zip(take.angles, take.objects, take.touched, strict=True):
        shown = np.concatenate([angles, objects.ravel(), touched])
        if drawn.size == 0 or np.abs(shown - drawn).max() > VISIBLE:
            stage.pose(angles, objects)
            stage.highlight(touched)
            picture, drawn = stage.picture(), shown
        yield picture


def frame_at(record: TrialRecord, robot: Robot, step: int) -> NDArray[np.uint8]:
    """One such frame, after `step` whole steps; drawn larger than it is, so that edges are smooth.

    Raises:
        ValueError: If the record has no such step.
    """
    if not 0 <= step <= record.steps:
        raise ValueError(f"step {step} does not exist; this trial has steps 0 to {record.steps}")
    take = kinematic_take(record, robot, frames_per_step=1)
    panel = Side(take, robot).frame(step)
    with Stage(robot, 2 * ROBOT_WIDTH_PX, 2 * HEIGHT_PX) as stage:
        stage.pose(take.angles[step], take.objects[step])
        stage.highlight(take.touched[step])
        return np.concatenate([halved(stage.picture()), panel], axis=1)
