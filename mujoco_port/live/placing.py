"""Where a reader may put objects: on the table, in the robot's reach, apart from one another."""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray

from arm2d.geometry import bearing_of
from models.robots import PlaneMap

# From J1: nearer than S2's end can come nothing is met, further away nothing is reached.
NEAREST, FARTHEST = 108.0, 165.0  # [cm]
RIGHTMOST: Final = -28.0  # [deg]; beyond, the table ends
LEFT_EDGE_M: Final = 0.063  # behind J1, where the table ends on the left
GAP: Final = 1.08  # of an object's width, from centre to centre


class Placing:
    """Places for objects.

    Args:
        plane: The map from the 2D world to the table, laid for it.
    """

    def __init__(self, plane: PlaneMap) -> None:
        self._apart = GAP * 2.0 * plane.object_radius / plane.scale  # [cm]
        room = (LEFT_EDGE_M - plane.object_radius) / (FARTHEST * plane.scale)
        self._leftmost = 180.0 + float(np.degrees(np.arcsin(np.clip(room, 0.0, 1.0))))

    def placed(self, discs: NDArray[np.float64], moved: int, x: float, y: float) -> NDArray[np.float64]:
        """The objects [3, 2] in [cm] after one was put as near to a place as there is room.

        Raises:
            ValueError: If another object is in the way.
        """
        place = self.within(x, y)
        others = np.delete(discs, moved, axis=0)
        if (np.linalg.norm(others - place, axis=1) < self._apart).any():
            raise ValueError("another object stands there")
        return np.vstack([discs[:moved], place, discs[moved + 1 :]])

    def standing(self, lying: NDArray[np.float64]) -> NDArray[np.float64] | None:
        """Places [3, 2] in [cm] where objects that lie somewhere can stand; None without room."""
        places = np.array([self.within(x, y) for x, y in lying])
        gaps = np.linalg.norm(places - np.roll(places, 1, axis=0), axis=1)
        return places if (gaps >= self._apart).all() else None

    def within(self, x: float, y: float) -> NDArray[np.float64]:
        """The nearest place in reach, [2] in [cm]."""
        bearing = np.radians(np.clip(bearing_of((x, y)), RIGHTMOST, self._leftmost))
        radius = np.clip(np.hypot(x, y), NEAREST, FARTHEST)
        return radius * np.array([np.cos(bearing), np.sin(bearing)])
