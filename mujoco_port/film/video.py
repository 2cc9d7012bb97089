"""Frames of a trial on the robot, the agent's mind beside it, to one MP4."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import ArrayLike, NDArray
from rich.progress import track

from arm2d import TrialRecord
from arm2d.constants import DT
from arm2d.films import write_mp4
from models.robots import Robot
from mujoco_port.film.closeup import INSET_PX, close_ups, laid_in
from mujoco_port.film.kinematic import FRAMES_PER_STEP
from mujoco_port.film.panel import WIDTH as PANEL_WIDTH_PX
from mujoco_port.film.panel import MindPanel
from mujoco_port.film.quality import QUALITIES, Quality
from mujoco_port.film.stage import Stage
from mujoco_port.film.take import Take, kinematic_take, task_heard

HEIGHT_PX: Final = 720
ROBOT_WIDTH_PX: Final = 800
WIDTH_PX: Final = ROBOT_WIDTH_PX + PANEL_WIDTH_PX
VISIBLE: Final = 2e-4  # [rad] and [m]; a smaller change is a fifth of a pixel and is not drawn anew
HOLD_S: Final = 1.0  # the last frame stays for so long
PER_SECOND: Final = round(FRAMES_PER_STEP / DT)
NORMAL: Final = QUALITIES["normal"]


def write_take(take: Take, robot: Robot, path: Path, quality: Quality = NORMAL) -> None:
    """Write what happened on the robot as an MP4, `PER_SECOND` moments of the take in a second.

    Raises:
        OSError: If the file cannot be written.
    """
    total = len(take.steps) + round(HOLD_S * PER_SECOND)
    shown = held(frames(take, robot, quality))
    write_mp4(track(shown, f"{take.record.instruction} on {robot.name}", total=total), path, PER_SECOND)


def held(pictures: Iterable[NDArray[np.uint8]]) -> Iterator[NDArray[np.uint8]]:
    """The pictures, the last of which stays for `HOLD_S`."""
    picture = np.empty(0, np.uint8)
    for picture in pictures:
        yield picture
    for _ in range(round(HOLD_S * PER_SECOND)):
        yield picture


def panel_of(take: Take, robot: Robot) -> MindPanel:
    """What stands beside the robot."""
    task = task_heard(take.record)
    return MindPanel(take.mind, take.record.instruction, robot.title, take.verdicts, take.steps[-1], task)


def frames(take: Take, robot: Robot, quality: Quality = NORMAL) -> Iterator[NDArray[np.uint8]]:
    """All moments of a take, [720, 1280, 3] each: the robot on the left, the agent's mind on the right."""
    panel = panel_of(take, robot)
    with Stage(robot, ROBOT_WIDTH_PX, HEIGHT_PX, quality, take.record.readings) as stage:
        for step, picture in zip(take.steps, robot_pictures(take, stage), strict=True):
            yield np.concatenate([picture, panel.frame(step)], axis=1)


def robot_pictures(take: Take, stage: Stage, inset_px: int = INSET_PX) -> Iterator[NDArray[np.uint8]]:
    """The robot's view at each moment, contacts also from near; what looks like before is not drawn anew."""
    bearing = stage.bearing(take)
    episodes = close_ups(take)
    picture, drawn = np.empty(0, np.uint8), np.empty(0)
    for moment, (angles, objects) in enumerate(zip(take.angles, take.objects, strict=True)):
        episode = next((each for each in episodes if each.first <= moment <= each.last), None)
        fade = 0.0 if episode is None else episode.strength(moment)
        touched, planar = take.touched[moment], take.planar[moment]
        moved = [angles, objects.ravel(), touched, planar, bearing.angles[moment], [fade]]
        shown = np.concatenate(moved)
        if drawn.size == 0 or np.abs(shown - drawn).max() > VISIBLE:
            stage.pose(angles, objects, bearing, moment)
            stage.highlight(touched)
            stage.shine(*planar)
            picture, drawn = stage.picture(), shown
            if episode is not None:
                laid_in(picture, stage.close_up(episode.centre, episode.width, inset_px), fade)
        yield picture


def frame_at(
    record: TrialRecord,
    robot: Robot,
    step: int,
    quality: Quality = QUALITIES["high"],
    genotype: ArrayLike | None = None,
) -> NDArray[np.uint8]:
    """One such frame, after `step` whole steps.

    Raises:
        ValueError: If the record has no such step.
    """
    if not 0 <= step <= record.steps:
        raise ValueError(f"step {step} does not exist; this trial has steps 0 to {record.steps}")
    take = kinematic_take(record, robot, 1, genotype)
    panel = panel_of(take, robot).frame(step)
    with Stage(robot, ROBOT_WIDTH_PX, HEIGHT_PX, quality, record.readings) as stage:
        return np.concatenate([moment_of(take, stage, step), panel], axis=1)


def moment_of(take: Take, stage: Stage, moment: int, inset_px: int = INSET_PX) -> NDArray[np.uint8]:
    """The robot's view at one moment of a take, as a film would show it."""
    bearing = stage.bearing(take)
    stage.pose(take.angles[moment], take.objects[moment], bearing, moment)
    stage.highlight(take.touched[moment])
    stage.shine(*take.planar[moment])
    picture = stage.picture()
    for episode in close_ups(take):
        if episode.first <= moment <= episode.last:
            inset = stage.close_up(episode.centre, episode.width, inset_px)
            laid_in(picture, inset, episode.strength(moment))
    return picture
