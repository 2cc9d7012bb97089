"""What is filmed: a trial on the robot, moment by moment, with what the captions say of it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from arm2d import TrialRecord
from arm2d.drawing import state_at
from arm2d.records import brief
from models.robots import Robot
from mujoco_port.film.kinematic import roll_out


@dataclass(frozen=True)
class Take:
    """F moments of a trial; axes J joints, 3 objects (blue, green, red).

    Attributes:
        record: The trial in the planar world, shown beside the robot.
        steps: [F], moments in control steps of that trial, rising; the last one is the robot's end.
        angles: [F, J] in [rad].
        objects: [F, 3, 2] in [m], places on the table where they stand upright; or [F, 3, 7], position in
            [m] and quaternion.
        touched: [F, 3], which objects glow.
        verdicts: Who judges and whether the instruction was carried out, one after the other.
    """

    record: TrialRecord
    steps: NDArray[np.float64]
    angles: NDArray[np.float64]
    objects: NDArray[np.float64]
    touched: NDArray[np.bool_]
    verdicts: tuple[tuple[str, bool], ...]

    __repr__ = brief


def kinematic_take(record: TrialRecord, robot: Robot, frames_per_step: float) -> Take:
    """A trial as the robot follows it, objects as in the planar world.

    Raises:
        OutOfReachError: If the robot cannot follow.
    """
    rollout = roll_out(record, robot, frames_per_step)
    touched = np.array([state_at(record, step)[3] for step in rollout.steps])
    verdicts = (("planar world", record.success),)
    return Take(record, rollout.steps, rollout.angles, rollout.objects, touched, verdicts)
