"""Eyes made of a camera: a picture is rendered in which every pixel names the object it shows.

The camera stands in J1, or at the end of S1 (reading `camera_origin`), as high as the objects' middle, and
looks along S1. It sees more than the 30 degrees of the agent's field of view, so that an object at its rim
is seen as a whole, and its middle where it is, and so that the hand need not come down on what lies below
it. For that the robot always looks from J1: a bent S2 lies outside the field of a camera at its beginning.

Import only after `mujoco_port.film.gl.choose_back_end`.
"""

from __future__ import annotations

import atexit
from functools import cache
from typing import Final
from weakref import WeakSet

import mujoco
import numpy as np
from numpy.typing import NDArray

from arm2d import Readings
from arm2d.constants import CHORD_END_DISTANCE, S1_LENGTH
from arm2d.geometry import camera_position
from models.build import OBJECTS, VISUAL_GROUP
from models.physics import EYE
from mujoco_port.acting.control import Body
from mujoco_port.acting.rollout import Sight
from mujoco_port.reach.workspace import on_table

WIDTH_PX: Final = 640
HEIGHT_PX: Final = 64
# [deg], across: 30 are the agent's; a bent S2 ends up to 15 to the left of where S1 points, and the hand has
# to see what lies a palm's width further to the left.
FIELD_DEG: Final = 90.0
# Groups that are not drawn: the robot, for the 2D agent's eye is not covered by its arm; floor and legs.
COVERS: Final = (VISUAL_GROUP, 2)
GEOM: Final = int(mujoco.mjtObj.mjOBJ_GEOM)  # as an enum it would be compared pixel by pixel in Python
BEHIND: Final = (0.0, -CHORD_END_DISTANCE)  # [cm], where an object is taken to be that is not seen


# Of eyes that nobody closes. MuJoCo ends its display when Python ends, and complains of what is left.
_open: Final[WeakSet[CameraEyes]] = WeakSet()


@cache
def _close_at_exit() -> None:
    """Close them then, before MuJoCo does, which has asked for its turn when the first of them was opened."""
    atexit.register(lambda: [eyes.close() for eyes in tuple(_open)])


class CameraEyes:
    """What a camera sees; call it with alpha in [deg]. Use it in a `with` statement, or call `close`.

    Args:
        body: The robot.
        readings: Where the agent's camera sits.
    """

    def __init__(self, body: Body, readings: Readings) -> None:
        self._body, self._readings = body, readings
        self._renderer = mujoco.Renderer(body.model, HEIGHT_PX, WIDTH_PX)
        _open.add(self)
        _close_at_exit()
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

    def __call__(self, alpha: float) -> Sight:
        """Where each object seems to be; how far away it is, is not seen."""
        from_j1 = self._look(alpha, np.zeros(2), CHORD_END_DISTANCE)
        if self._readings.camera_origin == "J1":
            return Sight(from_j1, from_j1)
        place = camera_position(alpha, self._readings)
        return Sight(self._look(alpha, place, CHORD_END_DISTANCE - S1_LENGTH), from_j1)

    def _look(self, alpha: float, place: NDArray[np.float64], distance: float) -> NDArray[np.float64]:
        """Where objects seem to be from a place [2], each put so far away from it, [3, 2], all in [cm]."""
        half = np.radians(alpha - 90.0) / 2
        upright = np.array([np.sqrt(0.5), np.sqrt(0.5), 0.0, 0.0])  # looking along y, z up
        turn = np.array([np.cos(half), 0.0, 0.0, np.sin(half)])
        mujoco.mju_mulQuat(self._body.model.cam_quat[self._camera], turn, upright)
        self._body.model.cam_pos[self._camera, :2] = on_table(self._body.robot.plane, place)
        mujoco.mj_camlight(self._body.model, self._body.data)
        self._renderer.update_scene(self._body.data, self._camera, self._shown)
        kinds = self._renderer.render()
        bearings = [self._bearing(kinds, geom, alpha) for geom in self._geoms]
        return np.array([_placed(place, bearing, distance) for bearing in bearings])

    def _bearing(self, kinds: NDArray, geom: int, alpha: float) -> float | None:
        """The middle of the columns in which an object is seen, as a bearing [deg]; None if it is not."""
        shown = (kinds[..., 0] == geom) & (kinds[..., 1] == GEOM)
        columns = np.flatnonzero(shown.any(axis=0))
        if not len(columns):
            return None
        # The rims of a disc lie at equal angles to both sides of its middle, not at equal pixels.
        left, right = np.degrees(np.arctan(self._across[columns[[0, -1]]]))
        return float(alpha - (left + right) / 2)


def _placed(place: NDArray[np.float64], bearing: float | None, distance: float) -> tuple[float, float]:
    """Where an object seems to be [cm]: at a bearing [deg] and a distance from a place, or behind."""
    if bearing is None:
        return BEHIND
    angle = np.radians(bearing)
    return place[0] + distance * np.cos(angle), place[1] + distance * np.sin(angle)
