"""A recorded 2D trial, lived by the humanoid: joint angles and objects over time, kinematically."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from arm2d import TrialRecord
from arm2d.constants import DT
from arm2d.records import brief
from models.robots import Robot, get_robot
from mujoco_port.acting.stepping_over import stepping_over
from mujoco_port.reach.kinematics import ArmKinematics
from mujoco_port.reach.workspace import for_world, hand_headings, hand_targets, on_table, tip_in_plane

# Postures between two control steps: the arm of the 2D world is interpolated, and solved for anew.
FRAMES_PER_STEP: Final = 2.5  # 25 in a second


@dataclass(frozen=True)
class Rollout:
    """F moments of a trial on the robot; axes J joints, 3 objects.

    Attributes:
        steps: [F], moment in control steps from the start; whole numbers are states of the record.
        angles: [F, J] in [rad].
        targets: [F, 3] in [m], where the hand's reference point has to be.
        objects: [F, 3, 2] in [m], centres on the table: blue, green, red.
    """

    steps: NDArray[np.float64]
    angles: NDArray[np.float64]
    targets: NDArray[np.float64]
    objects: NDArray[np.float64]

    __repr__ = brief

    @property
    def times(self) -> NDArray[np.float64]:
        """[F] in [s]."""
        return self.steps * DT


def roll_out(record: TrialRecord, robot: Robot | str, frames_per_step: float = FRAMES_PER_STEP) -> Rollout:
    """Let a robot follow a recorded trial.

    Args:
        record: K steps.
        robot: Its record, or its name; its table is laid for the trial's world.
        frames_per_step: Moments for each control step; 1 gives the record's own K + 1 states. The last
            moment is the end of the trial in any case.

    Raises:
        OutOfReachError: If the robot cannot reach a place.
    """
    robot = for_world(get_robot(robot) if isinstance(robot, str) else robot, record.readings)
    steps = moments(record.steps, frames_per_step)
    alpha, beta = _at(record.alpha, steps), _at(record.beta, steps)
    headings = hand_headings(robot.plane, alpha, beta)
    objects = on_table(robot.plane, _at(record.discs, steps))
    tip = on_table(robot.plane, tip_in_plane(alpha, beta))
    targets = hand_targets(
        robot.plane, alpha, beta, stepping_over(robot.plane.hand_print, tip, headings, objects)
    )
    return Rollout(steps, ArmKinematics(robot).follow(targets, headings), targets, objects)


def moments(n_steps: int, frames_per_step: float) -> NDArray[np.float64]:
    """The moments [F] in control steps from the start to the end of a trial of `n_steps`."""
    n_frames = int(np.ceil(n_steps * frames_per_step)) + 1
    return np.minimum(np.arange(n_frames) / frames_per_step, n_steps)


def _at(states: NDArray[np.float64], steps: NDArray[np.float64]) -> NDArray[np.float64]:
    """States [K + 1, ...] at fractional steps [F], interpolated."""
    before = np.floor(steps).astype(int)
    after = np.minimum(before + 1, len(states) - 1)
    part = (steps - before).reshape(-1, *(1,) * (states.ndim - 1))
    return (1.0 - part) * states[before] + part * states[after]
