"""The planar map: from the angles and discs of the 2D world to the table in front of the robot.

    X = scale x,   Y = scale y,   Z = hand height

The world frame of the scene is that of the 2D world, so the map is a scale and nothing else; where the robot
stands in it is the business of its record in `models.robots`.
"""

from __future__ import annotations

import numpy as np

from arm2d.constants import S1_LENGTH, S2_LENGTH
from models.robots import PlaneMap

# A full turn's cut: bearings lie in [-90, 270) degrees, as everywhere in the project, so that the sweep from
# the right bound over the front to the left bound crosses no jump.
BEARING_CUT = -np.pi / 2


def tip_in_plane(alpha_deg: np.ndarray, beta_deg: np.ndarray) -> np.ndarray:
    """Give the end of S2, [..., 2] in [cm], for joint angles [...] in [deg]."""
    alpha = np.radians(np.asarray(alpha_deg, dtype=float))
    heading = alpha + np.radians(beta_deg)
    return np.stack(
        [
            S1_LENGTH * np.cos(alpha) + S2_LENGTH * np.cos(heading),
            S1_LENGTH * np.sin(alpha) + S2_LENGTH * np.sin(heading),
        ],
        axis=-1,
    )


def hand_targets(plane: PlaneMap, alpha_deg: np.ndarray, beta_deg: np.ndarray) -> np.ndarray:
    """Give where the hand's reference point has to be, [..., 3] in [m] in the world."""
    tip = plane.scale * tip_in_plane(alpha_deg, beta_deg)
    return np.concatenate([tip, np.full_like(tip[..., :1], plane.hand_height)], axis=-1)


def hand_headings(plane: PlaneMap, alpha_deg: np.ndarray, beta_deg: np.ndarray) -> np.ndarray:
    """Give the heading [...] in [rad] the hand should have: away from J1, within limits.

    Pushing along an arc about J1 is then always pushing with the hand's edge square to the way: with free
    objects this, more than friction, keeps them from slipping off.
    """
    tip = tip_in_plane(alpha_deg, beta_deg)
    bearing = np.arctan2(tip[..., 1], tip[..., 0])
    bearing = np.where(bearing < BEARING_CUT, bearing + 2 * np.pi, bearing)
    return np.clip(bearing, *plane.heading_range)


def on_table(plane: PlaneMap, points_cm: np.ndarray) -> np.ndarray:
    """Give the places on the table, [..., 2] in [m], of points [..., 2] in [cm] of the 2D world."""
    return plane.scale * np.asarray(points_cm, dtype=float)
