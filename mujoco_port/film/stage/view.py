"""A camera on a stage: what it sees that moves, laid over what never does.

Floor, wall and the table's legs never change and fill half of a picture: they are drawn once and laid under
the rest.
"""

from __future__ import annotations

from typing import Final

import mujoco
import numpy as np
from numpy.typing import NDArray

from models.build import OBJECTS, ROBOT_PREFIX
from mujoco_port.film.light import Ground, ground, shine_state
from mujoco_port.film.overlay import SPOKES, darken_corners, dimmed, distances, halved, lay_over
from mujoco_port.film.stage.backstage import Backstage

BACKDROP_GROUP: Final = 2  # in `scene.xml`: of what never moves and never hides the robot
TABLE_SLACK: Final = 0.004  # [m], along the line of sight


class View:
    """A camera on a stage, and what it sees that never changes.

    Args:
        stage: What it looks at.
        camera: Of MuJoCo.
        width_px: Width and
        height_px: height of what is drawn.
        fixed: Whether it stays: then what never changes is drawn once.
    """

    def __init__(
        self, stage: Backstage, camera: mujoco.MjvCamera, width_px: int, height_px: int, fixed: bool = True
    ) -> None:
        self._stage, self._camera = stage, camera
        self._frame = mujoco.MjrRect(0, 0, width_px, height_px)
        quality = stage.quality
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
        stage.option.geomgroup[BACKDROP_GROUP] = at_once
        self._render(skybox=at_once)
        combined = np.empty_like(self._drawn)
        if at_once:
            combined[:] = self._drawn[::-1]
        else:
            lay_over(self._drawn, self._depth, self._backdrop, combined)
        if self._ground is None:
            self._ground = self._see_ground()
        distances(self._depth, *self._planes, self._distance)
        if stage.quality.occlusion:
            darken_corners(combined, self._distance, self._focal_px, self._spokes)
        if stage.arm is not None:
            readings = stage.readings
            rings = stage.rings()
            shine_state(combined, self._distance, self._ground, *stage.arm, rings, readings, TABLE_SLACK)
        return combined if stage.quality.oversampling == 1 else halved(combined)

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
        stage.option.geomgroup[BACKDROP_GROUP] = 1
        self._render(skybox=True)
        model.geom_group[:] = groups
        return dimmed(self._drawn[::-1])

    def _see_ground(self) -> Ground:
        """Which places of the planar world the pixels show, and what always shines there."""
        eye = self._stage.scene.camera[0], self._stage.scene.camera[1]
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
        return ground(places.astype(np.float32), (far * near).astype(np.float32), self._stage.readings)

    def _render(self, skybox: bool) -> None:
        stage = self._stage
        stage.context.make_current()
        mujoco.mjv_updateScene(
            stage.model,
            stage.data,
            stage.option,
            None,
            self._camera,
            mujoco.mjtCatBit.mjCAT_ALL.value,
            stage.scene,
        )
        stage.add_beam()
        stage.scene.flags[mujoco.mjtRndFlag.mjRND_SKYBOX] = skybox
        stage.scene.flags[mujoco.mjtRndFlag.mjRND_SHADOW] = self._shadows
        mujoco.mjr_render(self._frame, stage.scene, stage.drawer)
        mujoco.mjr_readPixels(self._drawn, self._depth, self._frame, stage.drawer)
