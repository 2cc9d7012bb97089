"""What the views of a stage share: model, context, and the light that the planar arm throws.

A software renderer takes its time by the pixel, and three times over where there are shadows.
"""

from __future__ import annotations

from typing import Final

import mujoco
import numpy as np
from numpy.typing import NDArray

from arm2d import Readings
from arm2d.drawing import arm_points
from models.build import HAND_SITE, OBJECTS
from models.filmed import film_spec
from models.robots import Robot
from mujoco_port.film.gl import new_context
from mujoco_port.film.light import RING
from mujoco_port.film.quality import Quality
from mujoco_port.film.stage.lamps import share_light
from mujoco_port.reach.workspace import for_world, on_table

BEAM_M: Final = 0.0013  # half the width of the beam from the hand to S2's end
BEAM_COLOUR: Final = np.array([1.0, 0.95, 0.78, 1.0], np.float32)
BEAM_SHAPE: Final = int(mujoco.mjtGeom.mjGEOM_CAPSULE)


class Backstage:
    """A robot's model and whatever draws it.

    Args:
        robot: Its record.
        width_px: Width and
        height_px: height of the largest picture.
        quality: What is drawn, and how finely.
        readings: Of the planar world that is drawn as light on the table, and whose discs the objects play.

    Attributes:
        model: Of MuJoCo.
        data: Its state.
        objects: Where the objects' places stand in it.
        arm: Alpha and beta in [deg] of the planar arm that shines; None while none does.
        touched: [3], which objects are touched.
    """

    def __init__(
        self, robot: Robot, width_px: int, height_px: int, quality: Quality, readings: Readings
    ) -> None:
        robot = for_world(robot, readings)
        spec = film_spec(robot, quality.finer)
        times = quality.oversampling
        # The whole buffer is cleared for every frame: it should be no larger than the picture.
        spec.visual.global_.offwidth, spec.visual.global_.offheight = times * width_px, times * height_px
        spec.visual.quality.shadowsize = quality.shadow_px
        spec.visual.quality.numslices = quality.round_sides
        spec.visual.quality.numstacks = quality.round_stacks
        share_light(spec, quality.lamps)
        self.robot, self.quality, self.readings = robot, quality, readings
        self.model = spec.compile()
        self.data = mujoco.MjData(self.model)
        self.objects = [self.model.joint(name).qposadr[0] for name in OBJECTS]
        self.touched = np.zeros(len(OBJECTS), bool)
        self.arm: tuple[float, float] | None = None
        self.context = new_context(times * width_px, times * height_px)
        self.context.make_current()
        self.drawer = mujoco.MjrContext(self.model, mujoco.mjtFontScale.mjFONTSCALE_100)
        self.drawer.readDepthMap = mujoco.mjtDepthMap.mjDEPTH_ZEROFAR.value
        mujoco.mjr_setBuffer(mujoco.mjtFramebuffer.mjFB_OFFSCREEN, self.drawer)
        self.option = mujoco.MjvOption()
        self.scene = mujoco.MjvScene(self.model, maxgeom=self.model.ngeom + 100)
        self._hand = self.model.site(HAND_SITE).id

    def close(self) -> None:
        """Give the renderer's memory back."""
        self.drawer.free()
        self.context.free()

    def rings(self) -> NDArray[np.float64]:
        """Where light lies around what is touched, [N, 3] in [cm]: centre and radius."""
        radius = RING * self.model.geom(OBJECTS[0]).size[0]
        touched = np.array(self.objects)[self.touched]
        places = [[*self.data.qpos[address : address + 2], radius] for address in touched]
        return np.reshape(places, (-1, 3)) / self.robot.plane.scale

    def add_beam(self) -> None:
        """Join the hand's point and the end of S2, which lies straight below it, by a beam of light."""
        if self.arm is None:
            return
        tip = on_table(self.robot.plane, arm_points(*self.arm)[1])
        hand = self.data.site_xpos[self._hand]
        beam = self.scene.geoms[self.scene.ngeom]
        size, nowhere = np.array([BEAM_M, 0.0, 0.0]), np.zeros(3)
        mujoco.mjv_initGeom(beam, BEAM_SHAPE, size, nowhere, np.eye(3).ravel(), BEAM_COLOUR)
        mujoco.mjv_connector(beam, BEAM_SHAPE, BEAM_M, np.array([*tip, 0.0]), hand)
        beam.emission = 1.0
        beam.category = mujoco.mjtCatBit.mjCAT_DECOR
        self.scene.ngeom += 1
