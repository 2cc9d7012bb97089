"""Eyes made of a camera: a picture is rendered in which every pixel names the object it shows.

The camera stands in J1, as high as the objects' middle, and looks along S1. It sees more than the 30 degrees
of the agent's field of view, so that an object at its rim is seen as a whole, and its middle where it is, and
so that the hand need not come down on what lies below it.

Import only after `mujoco_port.film.gl.choose_back_end`.
"""

from __future__ import annotations

from typing import Final

import mujoco
import numpy as np
from numpy.typing import NDArray

from arm2d.constants import CHORD_END_DISTANCE
from models.build import VISUAL_GROUP
from models.physics import EYE, OBJECTS
from mujoco_port.acting.control import Body

WIDTH_PX: Final = 640
HEIGHT_PX: Final = 64
# [deg], across: 30 are the agent's; a bent S2 ends up to 15 to the left of where S1 points, and the hand has
# to see what lies a palm's width further to the left.
FIELD_DEG: Final = 90.0
# Groups that are not drawn: the robot, for the 2D agent's eye is not covered by its arm; floor and legs.
COVERS: Final = (VISUAL_GROUP, 2)
GEOM: Final = int(mujoco.mjtObj.mjOBJ_GEOM)  # as an enum it would be compared pixel by pixel in Python
BEHIND: Final = (0.0, -CHORD_END_DISTANCE)  # [cm], where an object is taken to be that is not seen


class CameraEyes:
    """What a camera sees; call it with alpha in [deg]. Use it in a `with` statement, or call `close`.

    Args:
        body: The robot.
    """

    def __init__(self, body: Body) -> None:
        self._body = body
        self._renderer = mujoco.Renderer(body.model, HEIGHT_PX, WIDTH_PX)
        self._renderer.enable_segmentation_rendering()
        self._shown = mujoco.MjvOption()
        self._shown.geomgroup[list(COVERS)] = 0
        self._camera = body.model.camera(EYE).id
        self._half_width = np.tan(np.radians(FIELD_DEG / 2))
        body.model.cam_fovy[self._camera] = 2 * np.degrees(np.arctan(self._half_width * HEIGHT_PX / WIDTH_PX))
        self._geoms = [body.model.geom(name).id for name in OBJECTS]
        self._across = (
            2 * (np.arange(WIDTH_PX) + 0.5) / WIDTH_PX - 1
        ) * self._half_width  # tangents of bearings

    def __enter__(self) -> CameraEyes:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Give the renderer's memory back."""
        self._renderer.close()

    def __call__(self, alpha: float) -> NDArray[np.float64]:
        """Where each object seems to be, [3, 2] in [cm] of the 2D world; how far away it is, is not seen."""
        half = np.radians(alpha - 90.0) / 2
        upright = np.array([np.sqrt(0.5), np.sqrt(0.5), 0.0, 0.0])  # looking along y, z up
        turn = np.array([np.cos(half), 0.0, 0.0, np.sin(half)])
        mujoco.mju_mulQuat(self._body.model.cam_quat[self._camera], turn, upright)
        mujoco.mj_camlight(self._body.model, self._body.data)
        self._renderer.update_scene(self._body.data, self._camera, self._shown)
        kinds = self._renderer.render()
        return np.array([self._place(kinds, geom, alpha) for geom in self._geoms])

    def _place(self, kinds: NDArray, geom: int, alpha: float) -> tuple[float, float]:
        """The middle of the columns in which an object is seen, put as far away as a chord's end."""
        shown = (kinds[..., 0] == geom) & (kinds[..., 1] == GEOM)
        columns = np.flatnonzero(shown.any(axis=0))
        if not len(columns):
            return BEHIND
        # The rims of a disc lie at equal angles to both sides of its middle, not at equal pixels.
        left, right = np.degrees(np.arctan(self._across[columns[[0, -1]]]))
        bearing = np.radians(alpha - (left + right) / 2)
        return CHORD_END_DISTANCE * np.cos(bearing), CHORD_END_DISTANCE * np.sin(bearing)
