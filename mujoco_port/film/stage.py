"""The robot at its table in MuJoCo, posed moment by moment and drawn off-screen.

A software renderer takes its time by the pixel, and three times over where there are shadows. Floor, wall and
the table's legs never change and fill half of a picture: they are drawn once and laid under the rest.
"""

from __future__ import annotations

from typing import Final

import mujoco
import numpy as np
from numpy.typing import NDArray

from arm2d import Readings
from arm2d.drawing import arm_points
from models.build import HAND_SITE, ROBOT_PREFIX
from models.filmed import film_spec
from models.robots import Robot
from mujoco_port.film.gaze import Bearing, bearing
from mujoco_port.film.gl import new_context
from mujoco_port.film.light import Ground, ground, shine_state
from mujoco_port.film.overlay import SPOKES, darken_corners, dimmed, distances, halved, lay_over
from mujoco_port.film.quality import QUALITIES, Quality
from mujoco_port.reach.workspace import on_table

OBJECTS: Final = ("blue", "green", "red")
BACKDROP_GROUP: Final = 2  # in `scene.xml`: of what never moves and never hides the robot
PLACE: Final = 7  # numbers that say where a free object is
UPRIGHT: Final = (1.0, 0.0, 0.0, 0.0)
GLOW: Final = 0.22  # emission of an object that is touched
RING: Final = 1.12  # radius of the light around it, of the object's
ABOVE_TABLE: Final = 0.015  # [m], where the camera from above looks
BEAM_M: Final = 0.0013  # half the width of the beam from the hand to S2's end
BEAM_COLOUR: Final = np.array([1.0, 0.95, 0.78, 1.0], np.float32)
BEAM_SHAPE: Final = int(mujoco.mjtGeom.mjGEOM_CAPSULE)
TABLE_SLACK: Final = 0.004  # [m], along the line of sight
LAMP_SPREAD: Final = 0.07  # how far lamps that share a light are apart, seen from the table


class Stage:
    """A robot, its table and three objects; poses are set, nothing moves by itself.

    Use it in a `with` statement, or call `close`.

    Args:
        robot: Its record.
        width_px: Width and
        height_px: height of a picture.
        quality: What is drawn, and how finely.
        readings: Of the planar world that is drawn as light on the table.
    """

    def __init__(
        self,
        robot: Robot,
        width_px: int,
        height_px: int,
        quality: Quality = QUALITIES["normal"],
        readings: Readings | None = None,
    ) -> None:
        spec = film_spec(robot, quality.finer)
        times = quality.oversampling
        # The whole buffer is cleared for every frame: it should be no larger than the picture.
        spec.visual.global_.offwidth, spec.visual.global_.offheight = times * width_px, times * height_px
        spec.visual.quality.shadowsize = quality.shadow_px
        spec.visual.quality.numslices = quality.round_sides
        spec.visual.quality.numstacks = quality.round_stacks
        share_light(spec, quality.lamps)
        self.robot, self._quality, self._readings = robot, quality, readings or Readings()
        self.model = spec.compile()
        self.data = mujoco.MjData(self.model)
        self._joints = [self.model.joint(ROBOT_PREFIX + name).qposadr[0] for name in robot.joints]
        self._objects = [self.model.joint(name).qposadr[0] for name in OBJECTS]
        self._heights = [self.model.body(name).pos[2] for name in OBJECTS]
        self._materials = [self.model.material(name).id for name in OBJECTS]
        self._touched = np.zeros(len(OBJECTS), bool)
        self._context = new_context(times * width_px, times * height_px)
        self._context.make_current()
        self._drawer = mujoco.MjrContext(self.model, mujoco.mjtFontScale.mjFONTSCALE_100)
        self._drawer.readDepthMap = mujoco.mjtDepthMap.mjDEPTH_ZEROFAR.value
        mujoco.mjr_setBuffer(mujoco.mjtFramebuffer.mjFB_OFFSCREEN, self._drawer)
        self._option = mujoco.MjvOption()
        self._scene = mujoco.MjvScene(self.model, maxgeom=self.model.ngeom + 100)
        self._hand = self.model.site(HAND_SITE).id
        self._near: View | None = None
        self._near_key: tuple[float, ...] = ()
        self._arm: tuple[float, float] | None = None
        self._front = View(self, camera_named(self.model, "front"), times * width_px, times * height_px)

    def __enter__(self) -> Stage:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Give the renderer's memory back."""
        self._drawer.free()
        self._context.free()

    def bearing(
        self,
        angles: NDArray[np.float64],
        alpha: NDArray[np.float64],
        pointing: NDArray[np.bool_],
        moment_s: float,
    ) -> Bearing:
        """What neck, eyes and fingers do while the arm acts; see `mujoco_port.film.gaze.bearing`."""
        return bearing(self.model, self.robot, angles, alpha, pointing, moment_s)

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
        for address, height, place in zip(self._objects, self._heights, objects, strict=True):
            whole = place if len(place) == PLACE else (*place, height, *UPRIGHT)
            self.data.qpos[address : address + PLACE] = whole
        mujoco.mj_kinematics(self.model, self.data)
        mujoco.mj_camlight(self.model, self.data)

    def shine(self, alpha: float, beta: float) -> None:
        """Let the planar arm shine on the table, with alpha and beta in [deg]."""
        self._arm = alpha, beta

    def highlight(self, touched: NDArray[np.bool_]) -> None:
        """Let the objects that are touched glow, [3], with a ring of light on the table; the others not."""
        self._touched = np.asarray(touched, bool)
        self.model.mat_emission[self._materials] = np.where(self._touched, GLOW, 0.0)

    def rings(self) -> NDArray[np.float64]:
        """Where light lies around what is touched, [N, 3] in [cm]: centre and radius."""
        radius = RING * self.model.geom(OBJECTS[0]).size[0]
        touched = np.array(self._objects)[self._touched]
        places = [[*self.data.qpos[address : address + 2], radius] for address in touched]
        return np.reshape(places, (-1, 3)) / self.robot.plane.scale

    def add_beam(self) -> None:
        """Join the hand's point and the end of S2, which lies straight below it, by a beam of light."""
        if self._arm is None:
            return
        tip = on_table(self.robot.plane, arm_points(*self._arm)[1])
        hand = self.data.site_xpos[self._hand]
        beam = self._scene.geoms[self._scene.ngeom]
        size, nowhere = np.array([BEAM_M, 0.0, 0.0]), np.zeros(3)
        mujoco.mjv_initGeom(beam, BEAM_SHAPE, size, nowhere, np.eye(3).ravel(), BEAM_COLOUR)
        mujoco.mjv_connector(beam, BEAM_SHAPE, BEAM_M, np.array([*tip, 0.0]), hand)
        beam.emission = 1.0
        beam.category = mujoco.mjtCatBit.mjCAT_DECOR
        self._scene.ngeom += 1

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
            pixels = self._quality.oversampling * size_px
            self._near = View(self, camera_above(self.model, centre, width_m), pixels, pixels, fixed=False)
            self._near_key = key
        return self._near.picture(at_once=True)

    def picture_at_once(self) -> NDArray[np.uint8]:
        """The same, everything drawn anew: slower, and with the robot's shadow on the floor."""
        return self._front.picture(at_once=True)


class View:
    """A camera on a stage, and what it sees that never changes.

    Args:
        stage: The stage.
        camera: Of MuJoCo.
        width_px: Width and
        height_px: height of what is drawn.
        fixed: Whether it stays: then what never changes is drawn once.
    """

    def __init__(
        self, stage: Stage, camera: mujoco.MjvCamera, width_px: int, height_px: int, fixed: bool = True
    ) -> None:
        self._stage, self._camera = stage, camera
        self._frame = mujoco.MjrRect(0, 0, width_px, height_px)
        quality = stage._quality
        self._shadows = quality.shadow_px > 0 and (fixed or quality.near_shadows)
        self._drawn = np.empty((height_px, width_px, 3), np.uint8)
        self._depth = np.empty((height_px, width_px), np.float32)
        self._distance = np.empty((height_px, width_px), np.float32)
        half = np.pi * np.arange(SPOKES) / SPOKES
        self._spokes = np.stack([np.sin(half), np.cos(half)], axis=-1)
        self._backdrop = self._draw_backdrop() if fixed else self._drawn
        self._ground: Ground | None = self._see_ground() if fixed else None

    def picture(self, at_once: bool = False) -> NDArray[np.uint8]:
        """What the camera sees, as large as it is shown, [H, W, 3]."""
        stage = self._stage
        stage._option.geomgroup[BACKDROP_GROUP] = at_once
        self._render(skybox=at_once)
        combined = np.empty_like(self._drawn)
        if at_once:
            combined[:] = self._drawn[::-1]
        else:
            lay_over(self._drawn, self._depth, self._backdrop, combined)
        if self._ground is None:
            self._ground = self._see_ground()
        distances(self._depth, *self._planes, self._distance)
        if stage._quality.occlusion:
            darken_corners(combined, self._distance, self._focal_px, self._spokes)
        if stage._arm is not None:
            readings = stage._readings
            rings = stage.rings()
            shine_state(combined, self._distance, self._ground, *stage._arm, rings, readings, TABLE_SLACK)
        return combined if stage._quality.oversampling == 1 else halved(combined)

    def _draw_backdrop(self) -> NDArray[np.uint8]:
        """What stands still, [H, W, 3], without robot and objects."""
        stage = self._stage
        model = stage.model
        groups = model.geom_group.copy()
        names = [model.body(body).name for body in model.geom_bodyid]
        moving = [name in OBJECTS or name.startswith(ROBOT_PREFIX) for name in names]
        model.geom_group[np.array(moving)] = mujoco.mjNGROUP - 1  # not drawn by default
        mujoco.mj_kinematics(model, stage.data)
        mujoco.mj_camlight(model, stage.data)
        stage._option.geomgroup[BACKDROP_GROUP] = 1
        self._render(skybox=True)
        model.geom_group[:] = groups
        return dimmed(self._drawn[::-1])

    def _see_ground(self) -> Ground:
        """Which places of the planar world the pixels show, and what always shines there."""
        eye = self._stage._scene.camera[0], self._stage._scene.camera[1]
        height, width = self._depth.shape
        place = np.mean([each.pos for each in eye], axis=0)
        ahead, up = np.array(eye[0].forward), np.array(eye[0].up)
        near, top, bottom = eye[0].frustum_near, eye[0].frustum_top, eye[0].frustum_bottom
        self._planes = float(near), float(eye[0].frustum_far)
        self._focal_px = float(height * near / (top - bottom))
        upward = top - (np.arange(height) + 0.5) / height * (top - bottom)
        across = ((np.arange(width) + 0.5) / width - 0.5) * (top - bottom) * width / height
        right = np.cross(ahead, up)
        rays = near * ahead + upward[:, None, None] * up + across[None, :, None] * right
        far = -place[2] / np.minimum(rays[..., 2], -1e-9)
        places = (place + far[..., None] * rays)[..., :2] / self._stage.robot.plane.scale
        return ground(places.astype(np.float32), (far * near).astype(np.float32), self._stage._readings)

    def _render(self, skybox: bool) -> None:
        stage = self._stage
        stage._context.make_current()
        mujoco.mjv_updateScene(
            stage.model,
            stage.data,
            stage._option,
            None,
            self._camera,
            mujoco.mjtCatBit.mjCAT_ALL.value,
            stage._scene,
        )
        stage.add_beam()
        stage._scene.flags[mujoco.mjtRndFlag.mjRND_SKYBOX] = skybox
        stage._scene.flags[mujoco.mjtRndFlag.mjRND_SHADOW] = self._shadows
        mujoco.mjr_render(self._frame, stage._scene, stage._drawer)
        mujoco.mjr_readPixels(self._drawn, self._depth, self._frame, stage._drawer)


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


def share_light(spec: mujoco.MjSpec, lamps: int) -> None:
    """Let several lamps, a little apart, share the light of the one that casts shadows: softer ones."""
    lamp = spec.light("lamp")
    lamp.diffuse = np.array(lamp.diffuse) / lamps
    lamp.specular = np.array(lamp.specular) / lamps
    ahead = np.array(lamp.dir) / np.linalg.norm(lamp.dir)
    right = np.cross(ahead, (0.0, 0.0, 1.0))
    for k in range(1, lamps):
        turn = 2.0 * np.pi * k / (lamps - 1)
        way = ahead + LAMP_SPREAD * (np.cos(turn) * right + np.sin(turn) * np.cross(right, ahead))
        spec.worldbody.add_light(
            name=f"lamp_{k}",
            type=lamp.type,
            pos=list(lamp.pos),
            dir=list(way),
            diffuse=list(lamp.diffuse),
            specular=list(lamp.specular),
            castshadow=True,
        )
