"""Where every part that is seen is at a moment: the robot as films show it, with neck, eyes and fingers."""

from __future__ import annotations

from typing import Final

import mujoco
import numpy as np
from numpy.typing import NDArray

from models.build import OBJECTS, ROBOT_PREFIX
from models.filmed import film_spec, finger_joint
from models.robots import Robot
from mujoco_port.film.gaze import CURL_S
from mujoco_port.live.session import FRAMES_PER_SECOND, Moment

MOMENT_S: Final = 1.0 / FRAMES_PER_SECOND


class Posture:
    """The model that is looked at; what acts is another one.

    Args:
        robot: Its record.
        finer: How many times the triangles that do for a small picture are kept.

    Attributes:
        model: Of MuJoCo.
        bodies: [B], those that are sent: all that move.
    """

    def __init__(self, robot: Robot, finer: float = 1.0) -> None:
        self.model = film_spec(robot, finer).compile()
        self._data = mujoco.MjData(self.model)
        self._acting = [self.model.joint(ROBOT_PREFIX + name).qposadr[0] for name in robot.joints]
        objects = [self.model.joint(name).qposadr[0] for name in OBJECTS]
        self._objects = np.add.outer(objects, np.arange(7))
        self._head = [self._address(name) for name in robot.head_joints]
        presence = robot.presence
        self._fingers, self._bent, self._curl = [], np.empty(0), 0.0
        if presence is not None:
            right, left = presence.hands
            joints = [(finger, k) for finger in presence.fingers for k in range(len(finger.lengths))]
            self._fingers = [self._address(finger_joint(right, *each)) for each in joints]
            self._bent = np.array([finger.pointing[k] for finger, k in joints])
            for finger, k in joints:
                self._data.qpos[self._address(finger_joint(left, finger, k))] = finger.resting[k]
        self.bodies = np.flatnonzero(self.model.body_weldid != 0)

    def poses(self, moment: Moment, pointing: bool) -> NDArray[np.float32]:
        """Place in [m] and quaternion (w, x, y, z) of every body that moves, [B, 7]."""
        data, elapsed = self._data, None if moment.jumped else MOMENT_S
        data.qpos[self._acting] = moment.angles
        data.qpos[self._objects] = moment.places
        data.qpos[self._head] = moment.head
        most = 1.0 if elapsed is None else elapsed / CURL_S
        self._curl += float(np.clip(pointing - self._curl, -most, most))
        data.qpos[self._fingers] = self._bent * self._curl**2 * (3.0 - 2.0 * self._curl)
        mujoco.mj_kinematics(self.model, data)
        return np.concatenate([data.xpos[self.bodies], data.xquat[self.bodies]], axis=1, dtype=np.float32)

    def _address(self, joint: str) -> int:
        return int(self.model.joint(ROBOT_PREFIX + joint).qposadr[0])
