"""Eyes that know where the objects are; those of `mujoco_port.acting.camera` have to look."""

from __future__ import annotations

from mujoco_port.acting.control import Body
from mujoco_port.acting.rollout import Eyes, Sight


def geometric_eyes(body: Body) -> Eyes:
    """Eyes that see every object where it is, wherever they are and in whatever direction they look."""

    def look(_: float) -> Sight:
        places = body.places[:, :2] / body.robot.plane.scale
        return Sight(places, places)

    return look
