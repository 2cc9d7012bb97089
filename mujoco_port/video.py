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
from arm2d.video import Panel, write_mp4
from models.robots import Robot
from mujoco_port.caption import heading, verdict
from mujoco_port.rollout import FRAMES_PER_STEP, moments, roll_out
from mujoco_port.stage import Stage

HEIGHT_PX: Final = 720
ROBOT_WIDTH_PX: Final = 800
PANEL_WIDTH_PX: Final = 480
PANEL_HEIGHT_PX: Final = 400
CAPTION_HEIGHT_PX: Final = (HEIGHT_PX - PANEL_HEIGHT_PX) // 2
VISIBLE: Final = 2e-4  # [rad] and [m]; a smaller change is a fifth of a pixel and is not drawn anew
HOLD_S: Final = 1.0  # the last frame stays for so long


def write_video(record: TrialRecord, robot: Robot, path: Path) -> None:
    """Write a trial on the robot as an MP4 in real time; the file appears when it is complete.

    Raises:
        OutOfReachError: If the robot cannot follow.
        OSError: If the file cannot be written.
    """
    total = len(moments(record.steps, FRAMES_PER_STEP)) + round(HOLD_S / DT * FRAMES_PER_STEP)
    shown = track(held(frames(record, robot)), f"{record.instruction} on {robot.name}", total=total)
    write_mp4(shown, path, round(FRAMES_PER_STEP / DT))


def held(pictures: Iterable[NDArray[np.uint8]]) -> Iterator[NDArray[np.uint8]]:
    """The pictures, the last of which stays for `HOLD_S`."""
    picture = np.empty(0, np.uint8)
    for picture in pictures:
        yield picture
    for _ in range(round(HOLD_S / DT * FRAMES_PER_STEP)):
        yield picture


class Side:
    """What stands beside the robot: the instruction, the 2D world, and at the end the verdict."""

    def __init__(self, record: TrialRecord, robot: Robot) -> None:
        self._record = record
        self._above = heading(record, robot, PANEL_WIDTH_PX, CAPTION_HEIGHT_PX)
        self._running = verdict(record, False, PANEL_WIDTH_PX, CAPTION_HEIGHT_PX)
        self._ended = verdict(record, True, PANEL_WIDTH_PX, CAPTION_HEIGHT_PX)
        self._panel = Panel(record, PANEL_WIDTH_PX, PANEL_HEIGHT_PX, caption=False)

    def frame(self, step: float) -> NDArray[np.uint8]:
        """The picture after `step` steps, [720, 480, 3]."""
        below = self._ended if step >= self._record.steps else self._running
        return np.concatenate([self._above, self._panel.frame(step), below])


def frames(record: TrialRecord, robot: Robot) -> Iterator[NDArray[np.uint8]]:
    """All moments of a trial, [720, 1280, 3] each: the robot on the left, the 2D world on the right."""
    rollout, side = roll_out(record, robot), Side(record, robot)
    with Stage(robot, ROBOT_WIDTH_PX, HEIGHT_PX) as stage:
        picture, drawn = np.empty(0, np.uint8), np.empty(0)
        for step, angles, objects in zip(rollout.steps, rollout.angles, rollout.objects, strict=True):
            pose = np.concatenate([angles, objects.ravel()])
            if drawn.size == 0 or np.abs(pose - drawn).max() > VISIBLE:
                stage.pose(angles, objects)
                picture, drawn = stage.picture(), pose
            yield np.concatenate([picture, side.frame(step)], axis=1)


def frame_at(record: TrialRecord, robot: Robot, step: int) -> NDArray[np.uint8]:
    """One such frame, after `step` whole steps.

    Raises:
        ValueError: If the record has no such step.
    """
    panel = Side(record, robot).frame(step)
    rollout = roll_out(record, robot, frames_per_step=1)
    with Stage(robot, ROBOT_WIDTH_PX, HEIGHT_PX) as stage:
        stage.pose(rollout.angles[step], rollout.objects[step])
        return np.concatenate([stage.picture(), panel], axis=1)
