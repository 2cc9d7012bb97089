"""Where a stage is seen from."""

from __future__ import annotations

from typing import Final

import mujoco
import numpy as np
from numpy.typing import NDArray

ABOVE_TABLE: Final = 0.015  # [m], where the camera from above looks


def camera_named(model: mujoco.MjModel, name: str) -> mujoco.MjvCamera:
    """One of the scene's cameras."""
    camera = mujoco.MjvCamera()
    camera.type = mujoco.mjtCamera.mjCAMERA_FIXED
    camera.fixedcamid = model.camera(name).id
    return camera


def camera_above(model: mujoco.MjModel, centre: NDArray[np.float64], width_m: float) -> mujoco.MjvCamera:
    """A camera that looks down on a place [2] in [m] of the table, as the robot's front camera is turned."""
    camera = mujoco.MjvCamera()
    camera.type = mujoco.mjtCamera.mjCAMERA_FREE
    camera.lookat[:] = *centre, ABOVE_TABLE
    camera.distance = width_m / (2.0 * np.tan(np.radians(model.vis.global_.fovy) / 2))
    camera.azimuth, camera.elevation = -90.0, -72.0
    return camera
