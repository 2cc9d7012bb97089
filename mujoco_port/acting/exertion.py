"""How much of what a robot can do a trial asks of it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from arm2d.records import brief
from models.limits import MotorLimits
from mujoco_port.acting.control import Body
from mujoco_port.acting.rollout import PhysicalRecord
from mujoco_port.reach.kinematics import ArmKinematics


@dataclass(frozen=True)
class Exertion:
    """The largest part of each joint's limits that was used, each [J]; 1 is the limit.

    Attributes:
        position: Of the way from the middle of the range to its bounds.
        velocity: Of the largest speed.
        torque: Of the largest torque.
    """

    position: NDArray[np.float64]
    velocity: NDArray[np.float64]
    torque: NDArray[np.float64]

    __repr__ = brief

    def with_(self, other: Exertion) -> Exertion:
        """The larger of two trials' parts, joint by joint."""
        return Exertion(
            np.maximum(self.position, other.position),
            np.maximum(self.velocity, other.velocity),
            np.maximum(self.torque, other.torque),
        )


def tracking_errors(record: PhysicalRecord, kinematics: ArmKinematics) -> NDArray[np.float64]:
    """How far the hand is from where the interpolated joints would have it, [N] in [m]."""
    wanted = np.array([kinematics.forward(angles).position for angles in record.joints])
    return np.linalg.norm(record.hand - wanted, axis=-1)


def exertion(record: PhysicalRecord, kinematics: ArmKinematics, limits: MotorLimits) -> Exertion:
    """What a trial asked of its robot."""
    middle, half = (kinematics.upper + kinematics.lower) / 2, (kinematics.upper - kinematics.lower) / 2
    return Exertion(
        (np.abs(record.angles - middle) / half).max(axis=0),
        (np.abs(record.velocities) / limits.velocity).max(axis=0),
        (np.abs(record.torques) / limits.torque).max(axis=0),
    )


def head_exertion(record: PhysicalRecord, body: Body) -> Exertion:
    """What a trial asked of its robot's neck and eyes, each [H]; of a head that is still, nothing."""
    presence = body.robot.presence
    limits = MotorLimits((), ()) if presence is None else presence.limits
    middle, half = body.head_range.mean(axis=1), np.ptp(body.head_range, axis=1) / 2
    return Exertion(
        (np.abs(record.head - middle) / half).max(axis=0),
        (np.abs(record.head_velocities) / limits.velocity).max(axis=0),
        (np.abs(record.head_torques) / limits.torque).max(axis=0),
    )
