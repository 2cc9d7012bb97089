"""What touches what, asked at every physics step.

At 10 Hz an unbroken contact may look broken, and a short one may not be seen at all.
"""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray

from models.build import OBJECTS
from models.physics import SHAPE_PREFIX
from mujoco_port.acting.control import Body

# How an object is touched, as bits: S2's right side is the hand's little-finger side, its left the thumb's.
RIGHT_SIDE: Final = 1
LEFT_SIDE: Final = 2
ARM: Final = 4  # by what is not the hand
OBJECT: Final = 8  # by another object
HAND: Final = RIGHT_SIDE | LEFT_SIDE


class ContactSensors:
    """The skin of a robot: which sides of its hand touch which objects.

    Args:
        body: The robot.
    """

    def __init__(self, body: Body) -> None:
        model = body.model
        self._body = body
        self._object = np.full(model.ngeom, -1)
        for index, name in enumerate(OBJECTS):
            self._object[model.geom(name).id] = index
        hand = model.site_bodyid[body.hand_site]
        names = [model.geom(geom).name for geom in range(model.ngeom)]
        shape = np.array([name.startswith(SHAPE_PREFIX) for name in names])
        self._tells = shape | (self._object >= 0)  # of the robot's shapes, none meets another
        self._of_hand = shape & (model.geom_bodyid == hand)
        self._middle = -np.array(body.robot.hand_offset)  # [m], of the hand, seen from its reference point

    def read(self) -> tuple[NDArray[np.uint8], float]:
        """How each object is touched right now.

        Returns:
            Bits [3] for the blue, green and red object, and the depth [m] to which the deepest contact of the
            robot is pressed in.
        """
        touched, depth = np.zeros(3, np.uint8), 0.0
        contacts = self._body.data.contact
        pairs = contacts.geom  # [C, 2]
        # The table touches objects all the time; what else does?
        for index in self._tells[pairs].all(axis=1).nonzero()[0]:
            first, second = self._object[pairs[index]]
            if first >= 0 and second >= 0:
                touched[[first, second]] |= OBJECT
                continue
            geom = pairs[index, 0] if first < 0 else pairs[index, 1]
            touched[max(first, second)] |= self._side(geom, contacts.pos[index])
            depth = max(depth, -contacts.dist[index])
        return touched, depth

    def _side(self, geom: int, place: NDArray[np.float64]) -> int:
        """The side of the hand on which a place [3] in [m] in the world lies, seen along the fingers."""
        if not self._of_hand[geom]:
            return ARM
        rotation = self._body.hand_rotation
        ahead = rotation[:, 0]
        x, y, _ = place - self._body.hand - rotation @ self._middle
        return RIGHT_SIDE if ahead[1] * x - ahead[0] * y > 0.0 else LEFT_SIDE
