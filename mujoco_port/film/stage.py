"""The robot at its table in MuJoCo, posed moment by moment and drawn off-screen.

A software renderer takes its time by the pixel, and three times over where there are shadows. Floor, sky and
the table's legs never change and fill half of a picture: they are drawn once and laid under the rest.
"""

from __future__ import annotations

from typing import Final

import mujoco
import numpy as np
from numpy.typing import NDArray

from models.build import ROBOT_PREFIX, build_spec
from models.robots import Robot
from mujoco_port.film.gl import new_context
from mujoco_port.film.overlay import lay_over

OBJECTS: Final = ("blue", "green", "red")
BACKDROP_GROUP: Final = 2  # in `scene.xml`: of what never moves and never hides the robot
PLACE: Final = 7  # numbers that say where a free object is
UPRIGHT: Final = (1.0, 0.0, 0.0, 0.0)
GLOW: Final = 0.45  # emission of an object that is touched
RING: Final = (1.55, 0.0006)  # radius, of the object's; half height [m] of the ring of light under it
RING_COLOUR: Final = np.array([1.0, 0.93, 0.35, 0.9], np.float32)


class Stage:
    """A robot, its table and three objects; poses are set, nothing moves by itself.

    Use it in a `with` statement, or call `close`.

    Args:
        robot: Its record.
        width_px: Width and
        height_px: height of a picture.
        camera: One of the scene's cameras; it stands still.
    """

    def __init__(self, robot: Robot, width_px: int, height_px: int, camera: str = "front") -> None:
        spec = build_spec(robot)
        # The whole buffer is cleared for every frame: it should be no larger than the picture.
        spec.visual.global_.offwidth, spec.visual.global_.offheight = width_px, height_px
        self.model = spec.compile()
        self.data = mujoco.MjData(self.model)
        self._joints = [self.model.joint(ROBOT_PREFIX + name).qposadr[0] for name in robot.joints]
        self._objects = [self.model.joint(name).qposadr[0] for name in OBJECTS]
        self._heights = [self.model.body(name).pos[2] for name in OBJECTS]
        self._materials = [self.model.material(name).id for name in OBJECTS]
        self._touched = np.zeros(len(OBJECTS), bool)
        self._camera = camera
        self._option = mujoco.MjvOption()
        self._scene = mujoco.MjvScene(self.model, maxgeom=self.model.ngeom + 100)
        self._view = mujoco.MjvCamera()
        self._view.type = mujoco.mjtCamera.mjCAMERA_FIXED
        self._view.fixedcamid = self.model.camera(camera).id
        self._context = new_context(width_px, height_px)
        self._context.make_current()
        self._drawer = mujoco.MjrContext(self.model, mujoco.mjtFontScale.mjFONTSCALE_100)
        self._drawer.readDepthMap = mujoco.mjtDepthMap.mjDEPTH_ZEROFAR.value
        mujoco.mjr_setBuffer(mujoco.mjtFramebuffer.mjFB_OFFSCREEN, self._drawer)
        self._frame = mujoco.MjrRect(0, 0, width_px, height_px)
        self._picture = np.empty((height_px, width_px, 3), np.uint8)
        self._depth = np.empty((height_px, width_px), np.float32)
        self._backdrop = self._draw_backdrop()

    def __enter__(self) -> Stage:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Give the renderer's memory back."""
        self._drawer.free()
        self._context.free()

    def pose(self, angles: NDArray[np.float64], objects: NDArray[np.float64]) -> None:
        """Set joint angles and objects.

        Args:
            angles: [J] in [rad].
            objects: [3, 2] in [m], places on the table where they stand upright; or [3, 7], position in [m]
                and quaternion.
        """
        self.data.qpos[self._joints] = angles
        for address, height, place in zip(self._objects, self._heights, objects, strict=True):
            whole = place if len(place) == PLACE else (*place, height, *UPRIGHT)
            self.data.qpos[address : address + PLACE] = whole
        mujoco.mj_kinematics(self.model, self.data)
        mujoco.mj_camlight(self.model, self.data)

    def highlight(self, touched: NDArray[np.bool_]) -> None:
        """Let the objects that are touched glow, [3], with a ring of light on the table; the others not."""
        self._touched = np.asarray(touched, bool)
        self.model.mat_emission[self._materials] = np.where(self._touched, GLOW, 0.0)

    def picture(self) -> NDArray[np.uint8]:
        """What the camera sees, [height, width, 3]."""
        self._option.geomgroup[BACKDROP_GROUP] = 0
        self._render(skybox=False)
        combined = np.empty_like(self._picture)
        lay_over(self._picture, self._depth, self._backdrop, combined)
        return combined

    def picture_at_once(self) -> NDArray[np.uint8]:
        """The same, everything drawn anew: slower, and with the robot's shadow on the floor."""
        self._option.geomgroup[BACKDROP_GROUP] = 1
        self._render(skybox=True)
        return self._picture[::-1].copy()

    def _draw_backdrop(self) -> NDArray[np.uint8]:
        """What stands still, [height, width, 3], without robot and objects."""
        groups = self.model.geom_group.copy()
        names = [self.model.body(body).name for body in self.model.geom_bodyid]
        moving = [name in OBJECTS or name.startswith(ROBOT_PREFIX) for name in names]
        self.model.geom_group[np.array(moving)] = mujoco.mjNGROUP - 1  # not drawn by default
        mujoco.mj_kinematics(self.model, self.data)
        mujoco.mj_camlight(self.model, self.data)
        backdrop = self.picture_at_once()
        self.model.geom_group[:] = groups
        return backdrop

    def _render(self, skybox: bool) -> None:
        self._context.make_current()
        mujoco.mjv_updateScene(
            self.model,
            self.data,
            self._option,
            None,
            self._view,
            mujoco.mjtCatBit.mjCAT_ALL.value,
            self._scene,
        )
        self._add_rings()
        self._scene.flags[mujoco.mjtRndFlag.mjRND_SKYBOX] = skybox
        mujoco.mjr_render(self._frame, self._scene, self._drawer)
        mujoco.mjr_readPixels(self._picture, self._depth, self._frame, self._drawer)

    def _add_rings(self) -> None:
        """Lay a flat disc of light under each object that is touched."""
        radius, height = RING[0] * self.model.geom(OBJECTS[0]).size[0], RING[1]
        for address in np.array(self._objects)[self._touched]:
            ring = self._scene.geoms[self._scene.ngeom]
            place = np.array([*self.data.qpos[address : address + 2], height])
            mujoco.mjv_initGeom(
                ring,
                mujoco.mjtGeom.mjGEOM_CYLINDER,
                np.array([radius, height, 0.0]),
                place,
                np.eye(3).ravel(),
                RING_COLOUR,
            )
            ring.emission = 0.8
            self._scene.ngeom += 1
