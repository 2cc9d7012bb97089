"""How far hand and arm are from the objects, by MuJoCo's geometry: what touches what on the robot."""

from __future__ import annotations

from typing import Final

import mujoco
import numpy as np
from numpy.typing import NDArray

from models.build import OBJECTS, ROBOT_PREFIX, build_model
from models.robots import Robot

FARTHEST: Final = 0.1  # [m]; more than this is told as this


class Gaps:
    """The gaps between a robot's hand and arm and the objects on its table (`for_world`), in any posture.

    The arm is what the acting joints move between the trunk and the hand: the links on the way from the hand
    to the first link that carries more than one chain.
    """

    def __init__(self, robot: Robot) -> None:
        self.robot = robot
        self._model = model = build_model(robot)
        self._data = mujoco.MjData(model)
        self._joints = [model.joint(ROBOT_PREFIX + name).qposadr[0] for name in robot.joints]
        self._places = [model.joint(name).qposadr[0] for name in OBJECTS]
        hand = model.body(ROBOT_PREFIX + robot.hand_frame).id
        chain = [hand]
        while np.sum(model.body_parentid == model.body_parentid[chain[-1]]) == 1:
            chain.append(int(model.body_parentid[chain[-1]]))
        rigid = model.body_weldid[hand]  # the hand's frame may be a body of its own
        self._hand = self._geoms([body for body in chain if model.body_weldid[body] == rigid])
        self._arm = self._geoms([body for body in chain if model.body_weldid[body] != rigid])
        self._objects = [model.geom(name).id for name in OBJECTS]

    def measure(self, angles: NDArray, objects: NDArray) -> tuple[NDArray, NDArray]:
        """Give the gaps [3] in [m] of the hand, and of the rest of the arm, to each object.

        Args:
            angles: [J] in [rad].
            objects: [3, 2] in [m], their centres on the table.

        Returns:
            Negative gaps are depths of overlaps.
        """
        self._data.qpos[self._joints] = angles
        for address, place in zip(self._places, objects, strict=True):
            self._data.qpos[address : address + 2] = place
        mujoco.mj_kinematics(self._model, self._data)
        return self._least(self._hand), self._least(self._arm)

    def _geoms(self, bodies: list[int]) -> list[int]:
        model = self._model
        return [geom for body in bodies for geom in range(model.ngeom) if model.geom_bodyid[geom] == body]

    def _least(self, geoms: list[int]) -> NDArray:
        return np.array([min(self._gap(geom, thing) for geom in geoms) for thing in self._objects])

    def _gap(self, one: int, other: int) -> float:
        return mujoco.mj_geomDistance(self._model, self._data, one, other, FARTHEST, None)
