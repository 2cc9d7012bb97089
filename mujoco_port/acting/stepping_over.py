"""Stepping over: the hand stays above what lies below it.

S2 is a line, and what lies to the left of it is not touched. The hand that plays its end is 7 cm wide to the
left of that line, and would come down on an object there. So it stays up while it is above one. What it
pushes is at its right side and does not count.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from models.robots import HandPrint
from mujoco_port.reach.workspace import smooth


def stepping_over(
    prints: HandPrint,
    hand: NDArray[np.float64],
    heading: NDArray[np.float64] | float,
    objects: NDArray[np.float64],
) -> NDArray[np.float64]:
    """How far the hand has to be raised, [...] from 0 to 1.

    Args:
        prints: Of the robot's hand.
        hand: [..., 2] in [m], its reference point on the table.
        heading: [...] in [rad], of its fingers.
        objects: [..., O, 2] in [m], centres of any number of objects on the table.
    """
    away = objects - hand[..., np.newaxis, :]
    cosine, sine = np.cos(heading)[..., np.newaxis], np.sin(heading)[..., np.newaxis]
    ahead = cosine * away[..., 0] + sine * away[..., 1]
    left = cosine * away[..., 1] - sine * away[..., 0]
    across = smooth(left, *prints.left_of_edge) * smooth(left, *prints.width)
    along = smooth(ahead, *prints.before_wrist) * smooth(ahead, *prints.length)
    return (across * along).max(axis=-1, initial=0.0)
