"""The robot at its table in MuJoCo, posed moment by moment and drawn off-screen."""

from __future__ import annotations

from typing import Final

import mujoco
import numpy as np
from numpy.typing import NDArray

from arm2d import Readings
from models.build import OBJECTS, ROBOT_PREFIX
from models.robots import Robot
from mujoco_port.film.gaze import Bearing, bearing
from mujoco_port.film.quality import QUALITIES, Quality
from mujoco_port.film.stage.backstage import Backstage
from mujoco_port.film.stage.cameras import camera_above, camera_named
from mujoco_port.film.stage.view import View
from mujoco_port.film.take import Take

PLACE: Final = 7  # numbers that say where a free object is
UPRIGHT: Final = (1.0, 0.0, 0.0, 0.0)
GLOW: Final = 0.22  # emission of an object that is touched


class Stage:
    """A robot, its table and three objects; poses are set, nothing moves by itself.

    Use it in a `with` statement, or call `close`.

    Args:
        robot: Its record.
        width_px: Width and
        height_px: height of a picture.
        quality: What is drawn, and how finely.
        readings: Of the planar world that is drawn as light on the table, and whose discs the objects play.
    """

    def __init__(
        self,
        robot: Robot,
        width_px: int,
        height_px: int,
        quality: Quality = QUALITIES["normal"],
        readings: Readings | None = None,
    ) -> None:
        self._back = back = Backstage(robot, width_px, height_px, quality, readings or Readings())
        self.robot = back.robot
        self.model, self.data = back.model, back.data
        self._joints = [self.model.joint(ROBOT_PREFIX + name).qposadr[0] for name in robot.joints]
        self._heights = [self.model.body(name).pos[2] for name in OBJECTS]
        self._materials = [self.model.material(name).id for name in OBJECTS]
        self._near: View | None = None
        self._near_key: tuple[float, ...] = ()
        times = quality.oversampling
        self._front = View(back, camera_named(self.model, "front"), times * width_px, times * height_px)

    def __enter__(self) -> Stage:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Give the renderer's memory back."""
        self._back.close()

    def bearing(self, take: Take) -> Bearing:
        """What neck, eyes and fingers do in a take; see `mujoco_port.film.gaze.bearing`."""
        return bearing(
            self.model,
            self.robot,
            take.angles,
            take.planar[:, 0],
            take.pointing,
            take.moment_s,
            take.head,
        )

    def pose(
        self,
        angles: NDArray[np.float64],
        objects: NDArray[np.float64],
        bearing: Bearing | None = None,
        moment: int = 0,
    ) -> None:
        """Set joint angles and objects.

        Args:
            angles: [J] in [rad].
            objects: [3, 2] in [m], places on the table where they stand upright; or [3, 7], position in [m]
                and quaternion.
            bearing: Of neck, eyes and fingers, and
            moment: which of its moments.
        """
        self.data.qpos[self._joints] = angles
        if bearing is not None:
            self.data.qpos[bearing.addresses] = bearing.angles[moment]
        for address, height, place in zip(self._back.objects, self._heights, objects, strict=True):
            whole = place if len(place) == PLACE else (*place, height, *UPRIGHT)
            self.data.qpos[address : address + PLACE] = whole
        mujoco.mj_kinematics(self.model, self.data)
        mujoco.mj_camlight(self.model, self.data)

    def shine(self, alpha: float, beta: float) -> None:
        """Let the planar arm shine on the table, with alpha and beta in [deg]."""
        self._back.arm = alpha, beta

    def highlight(self, touched: NDArray[np.bool_]) -> None:
        """Let the objects that are touched glow, [3], with a ring of light on the table; the others not."""
        self._back.touched = np.asarray(touched, bool)
        self.model.mat_emission[self._materials] = np.where(self._back.touched, GLOW, 0.0)

    def picture(self) -> NDArray[np.uint8]:
        """What is seen from the front, [height, width, 3]."""
        return self._front.picture()

    def close_up(self, centre: NDArray[np.float64], width_m: float, size_px: int) -> NDArray[np.uint8]:
        """A square of the table from above, robot at the top, [size, size, 3].

        Args:
            centre: [2] in [m], what is looked at.
            width_m: What is seen across.
            size_px: Of the picture; no larger than the stage's own.
        """
        key = *centre, width_m, size_px
        if self._near is None or key != self._near_key:
            pixels = self._back.quality.oversampling * size_px
            self._near = View(
                self._back, camera_above(self.model, centre, width_m), pixels, pixels, fixed=False
            )
            self._near_key = key
        return self._near.picture(at_once=True)

    def picture_at_once(self) -> NDArray[np.uint8]:
        """The same, everything drawn anew: slower, and with the robot's shadow on the floor."""
        return self._front.picture(at_once=True)
