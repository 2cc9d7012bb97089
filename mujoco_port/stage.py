"""The robot at its table in MuJoCo, posed moment by moment and drawn off-screen.

Import only after `mujoco_port.gl.choose_back_end`.
"""

from __future__ import annotations

import mujoco
import numpy as np
from numpy.typing import NDArray

from models.build import ROBOT_PREFIX, build_model
from models.robots import Robot

OBJECTS = ("blue", "green", "red")


class Stage:
    """A robot, its table and three objects; poses are set, nothing moves by itself.

    Use it in a `with` statement, or call `close`.

    Args:
        robot: Its record.
        width_px: Width and
        height_px: height of a picture.
    """

    def __init__(self, robot: Robot, width_px: int, height_px: int) -> None:
        self.model = build_model(robot)
        self.data = mujoco.MjData(self.model)
        self._joints = [self.model.joint(ROBOT_PREFIX + name).qposadr[0] for name in robot.joints]
        self._objects = [self.model.joint(name).qposadr[0] for name in OBJECTS]
        self._heights = [self.model.body(name).pos[2] for name in OBJECTS]
        self._renderer = mujoco.Renderer(self.model, height_px, width_px)

    def __enter__(self) -> Stage:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Give the renderer's memory back."""
        self._renderer.close()

    def pose(self, angles: NDArray[np.float64], objects: NDArray[np.float64]) -> None:
        """Set joint angles [J] in [rad] and the objects' centres on the table [3, 2] in [m]."""
        self.data.qpos[self._joints] = angles
        for address, height, place in zip(self._objects, self._heights, objects, strict=True):
            self.data.qpos[address : address + 7] = (*place, height, 1.0, 0.0, 0.0, 0.0)
        mujoco.mj_kinematics(self.model, self.data)
        mujoco.mj_camlight(self.model, self.data)

    def picture(self, camera: str = "front") -> NDArray[np.uint8]:
        """What a camera of the scene sees, [height, width, 3]."""
        self._renderer.update_scene(self.data, camera)
        return self._renderer.render()
