"""Stepping over: the hand stays above what lies below it.

S2 is a line, and what lies to the left of it is not touched. The hand that plays its end is 7 cm wide to the
left of that line, and would come down on an object there. So it stays up while it is above one. What it
pushes is at its right side and does not count.
"""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray

from mujoco_port.workspace import smooth

# Where an object's centre is, seen from the hand's reference point, while a lowered hand would be in it, in
# [m]: to the left of the little finger's side (what is pressed against it is 9 mm to the right) as far as
# the palm is wide, and ahead as far as the fingers are long. Between two numbers the hand rises.
LEFT_OF_EDGE: Final = (-0.004, 0.008)
WIDTH: Final = (0.092, 0.066)
LENGTH: Final = (0.068, 0.048)
BEFORE_WRIST: Final = (-0.15, -0.12)


def stepping_over(
    hand: NDArray[np.float64], heading: NDArray[np.float64] | float, objects: NDArray[np.float64]
) -> NDArray[np.float64]:
    """How far the hand has to be raised, [...] from 0 to 1.

    Args:
        hand: [..., 2] in [m], its reference point on the table.
        heading: [...] in [rad], of its fingers.
        objects: [..., O, 2] in [m], centres of any number of objects on the table.
    """
    away = objects - hand[..., np.newaxis, :]
    cosine, sine = np.cos(heading)[..., np.newaxis], np.sin(heading)[..., np.newaxis]
    ahead = cosine * away[..., 0] + sine * away[..., 1]
    left = cosine * away[..., 1] - sine * away[..., 0]
    across = smooth(left, *LEFT_OF_EDGE) * smooth(left, *WIDTH)
    along = smooth(ahead, *BEFORE_WRIST) * smooth(ahead, *LENGTH)
    return (across * along).max(axis=-1, initial=0.0)
