"""Where the robot looks: what its head does while the arm reaches.

The agent's camera looks along S1, so the robot does: its neck turns the face there and keeps it level, no
faster than a neck can, and the eyes, which are quicker, make up for the rest.
"""

from __future__ import annotations

from typing import Final

import mujoco
import numpy as np
from numpy.typing import NDArray

from arm2d.constants import CHORD_END_DISTANCE
from models.build import ROBOT_PREFIX
from models.presence import Presence
from models.robots import Robot

NECK_LAG_S: Final = 0.22  # a neck does not jump to its aim
BELOW: Final = 0.16  # [rad], what is looked at lies so far below where the face points
STEP: Final = 1e-4  # [rad], of the difference quotients
DAMPING: Final = 2e-3
SETTLE: Final = 60  # steps from the rest pose to the first moment's


class Head:
    """A neck and two eyes that look at a place.

    Args:
        model: Of `models.filmed` or `models.physics`.
        data: Where it is posed; trunk and arm are the caller's.
        presence: Of the robot.
    """

    def __init__(self, model: mujoco.MjModel, data: mujoco.MjData, presence: Presence) -> None:
        self._model, self._data, self._presence = model, data, presence
        self._body = model.body(ROBOT_PREFIX + presence.head).id
        neck = [model.joint(ROBOT_PREFIX + name) for name in presence.neck]
        self.neck = np.array([joint.qposadr[0] for joint in neck])
        self._limits = np.array([joint.range for joint in neck]).T
        self._ahead, self._left = np.array(presence.ahead), np.array(presence.left)
        self._up = np.cross(self._ahead, self._left)
        self._eyes = [model.body(ROBOT_PREFIX + eye.name).id for eye in presence.eyes]

    def aim(self, place: NDArray[np.float64]) -> NDArray[np.float64]:
        """Neck angles [3] that turn the face nearer to a place [3] in [m]: one damped Gauss-Newton step."""
        here = self._data.qpos[self.neck].copy()
        off = self._off(place)
        slopes = np.empty((3, 3))
        for joint, address in enumerate(self.neck):
            self._data.qpos[address] += STEP
            slopes[:, joint] = (self._off(place) - off) / STEP
            self._data.qpos[address] = here[joint]
        step = np.linalg.solve(slopes.T @ slopes + DAMPING * np.eye(3), slopes.T @ off)
        return np.clip(here - step, *self._limits)

    def eye_angles(self, place: NDArray[np.float64]) -> NDArray[np.float64]:
        """Turns of both eyes to the left and down, [2, 2] in [rad], to look at a place from there."""
        rotation = self._data.xmat[self._body].reshape(3, 3)
        angles = np.empty((2, 2))
        for row, eye in zip(angles, self._eyes, strict=True):
            way = rotation.T @ (place - self._data.xpos[eye])
            way /= np.linalg.norm(way)
            row[:] = np.arctan2(way @ self._left, way @ self._ahead), -np.arcsin(way @ self._up)
        return np.clip(angles, -self._presence.eye_range, self._presence.eye_range)

    def _off(self, place: NDArray[np.float64]) -> NDArray[np.float64]:
        """How far the face is turned away and tilted, [3]."""
        mujoco.mj_kinematics(self._model, self._data)
        rotation = self._data.xmat[self._body].reshape(3, 3)
        left, up = rotation @ self._left, rotation @ self._up
        way = place - self._data.xpos[self._body]
        way /= np.linalg.norm(way)
        return np.array([way @ left, way @ up + BELOW, left[2]])


class Gaze:
    """A neck and two eyes that follow S1's direction, moment by moment.

    Args:
        model: Of `models.filmed` or `models.physics`.
        robot: Its record, and
        presence: the part of it that says how it looks.
        haste: Part of the largest speeds that is used from one moment to the next.

    Attributes:
        addresses: [H], where the joints of neck and eyes stand among the model's positions.
    """

    def __init__(self, model: mujoco.MjModel, robot: Robot, presence: Presence, haste: float = 1.0) -> None:
        self._model, self._robot = model, robot
        self._data = mujoco.MjData(model)
        self._head = Head(model, self._data, presence)
        self._acting = [model.joint(ROBOT_PREFIX + name).qposadr[0] for name in robot.joints]
        self._eyes = np.zeros((2, 2))
        self._neck_speed, self._eye_speed = haste * presence.neck_speed, haste * presence.eye_speed
        self.addresses = [model.joint(ROBOT_PREFIX + name).qposadr[0] for name in presence.head_joints]

    def follow(self, angles: NDArray[np.float64], alpha: float, moment_s: float | None) -> list[float]:
        """Angles [H] in [rad] of neck and eyes.

        Args:
            angles: [J] in [rad], of what reaches.
            alpha: [deg], direction of S1.
            moment_s: [s] since it was asked last; None if it has had all the time it needs.
        """
        data, head = self._data, self._head
        still = moment_s is None
        past = np.inf if moment_s is None else moment_s
        data.qpos[self._acting] = angles
        place = looked_at(self._robot, np.array([alpha]))[0]
        for _ in range(SETTLE if still else 1):
            fastest = self._neck_speed * past
            wish = head.aim(place) - data.qpos[head.neck]
            share = 1.0 - np.exp(-past / NECK_LAG_S)
            data.qpos[head.neck] += np.clip(share * wish, -fastest, fastest)
        mujoco.mj_kinematics(self._model, data)
        fastest = self._eye_speed * past
        self._eyes = self._eyes + np.clip(head.eye_angles(place) - self._eyes, -fastest, fastest)
        return [*data.qpos[head.neck], *self._eyes.ravel()]


def looked_at(robot: Robot, alpha: NDArray[np.float64]) -> NDArray[np.float64]:
    """Where the agent's camera looks, [F, 3] in [m]: along S1, as far away as objects are."""
    angle, far = np.radians(alpha), robot.plane.scale * CHORD_END_DISTANCE
    height = np.full_like(angle, 0.02)
    return np.stack([far * np.cos(angle), far * np.sin(angle), height], axis=-1)
