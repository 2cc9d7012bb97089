"""The planar map: from the angles and discs of the 2D world to the table in front of the robot.

    X = scale x,   Y = scale y,   Z = hand height + lift * rise(beta)

The world frame of the scene is that of the 2D world, so the map is a scale and nothing else; where the robot
stands in it is the business of its record in `models.robots`.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from arm2d.constants import CHORD_END_DISTANCE, S1_LENGTH, S2_LENGTH
from arm2d.readings import Readings
from models.robots import PlaneMap, Robot

# A full turn's cut: bearings lie in [-90, 270) degrees, as everywhere in the project, so that the sweep from
# the right bound over the front to the left bound crosses no jump.
BEARING_CUT = -np.pi / 2


def tip_in_plane(alpha_deg: ArrayLike, beta_deg: ArrayLike) -> np.ndarray:
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


def hand_targets(
    plane: PlaneMap, alpha_deg: ArrayLike, beta_deg: ArrayLike, above: ArrayLike = 0.0
) -> np.ndarray:
    """Give where the hand's reference point has to be, [..., 3] in [m] in the world.

    Args:
        plane: The map.
        alpha_deg: [...].
        beta_deg: [...].
        above: [...], how far the hand has to stay above an object, from 0 to 1 (`acting.stepping_over`).
    """
    tip = plane.scale * tip_in_plane(alpha_deg, beta_deg)
    height = np.broadcast_to(hand_height(plane, beta_deg, above), tip.shape[:-1])
    return np.concatenate([tip, height[..., None]], axis=-1)


def hand_height(plane: PlaneMap, beta_deg: ArrayLike, above: ArrayLike = 0.0) -> np.ndarray:
    """Give the height [...] in [m] of the hand's reference point above the table top.

    A bent S2 is a line that passes inside the objects; the robot's hand has width and would run into them.
    So it passes above them, and comes down while S2 stretches: t runs from 0 to 1 over the lift's range,

        height = hand height + lift * t^2 (3 - 2 t)

    which rises without a step in height or speed.
    """
    bent = smooth(np.asarray(beta_deg, dtype=float), *plane.lift_range)
    return plane.hand_height + plane.lift * np.maximum(bent, above)


def smooth(values: np.ndarray, first: float, last: float) -> np.ndarray:
    """Rise from 0 at `first` to 1 at `last`, without a step in value or slope."""
    part = np.clip((values - first) / (last - first), 0.0, 1.0)
    return part**2 * (3.0 - 2.0 * part)


def hand_headings(plane: PlaneMap, alpha_deg: ArrayLike, beta_deg: ArrayLike) -> np.ndarray:
    """Give the heading [...] in [rad] the hand should have: away from J1, within limits.

    Pushing along an arc about J1 is then always pushing with the hand's edge square to the way: with free
    objects this, more than friction, keeps them from slipping off.
    """
    tip = tip_in_plane(alpha_deg, beta_deg)
    bearing = np.arctan2(tip[..., 1], tip[..., 0])
    bearing = np.where(bearing < BEARING_CUT, bearing + 2 * np.pi, bearing)
    return np.clip(bearing - plane.heading_lead, *plane.heading_range)


def on_table(plane: PlaneMap, points_cm: np.ndarray) -> np.ndarray:
    """Give the places on the table, [..., 2] in [m], of points [..., 2] in [cm] of the 2D world."""
    return plane.scale * np.asarray(points_cm, dtype=float)


def for_world(robot: Robot, readings: Readings) -> Robot:
    """Give the same robot at a table whose objects play the discs of this world.

    The hand meets an object when S2 meets its disc if the object's radius is that of the disc and what the
    hand's edge is to the left of S2. Over wider objects it stays raised from further away on; and where discs
    begin nearer to J1, S2 meets them while it is bent further, and the hand is lifted later.
    """
    plane = robot.plane
    rim = middle_of_chord(readings) - readings.object_radius
    # Not so early that a straight S2 found the hand raised.
    later = max(bend_at(rim) - bend_at(plane.rim), -plane.lift_range[0])
    radius = plane.hand_edge + plane.scale * readings.object_radius
    wider = radius - plane.object_radius
    over = plane.hand_print
    hand_print = replace(
        over,
        left_of_edge=(over.left_of_edge[0] - wider, over.left_of_edge[1] - wider),
        width=(over.width[0] + wider, over.width[1] + wider),
        length=(over.length[0] + wider, over.length[1] + wider),
        before_wrist=(over.before_wrist[0] - wider, over.before_wrist[1] - wider),
    )
    lift_range = plane.lift_range[0] + later, plane.lift_range[1] + later
    laid = replace(plane, lift_range=lift_range, rim=rim, object_radius=radius, hand_print=hand_print)
    return replace(robot, plane=laid)


def middle_of_chord(readings: Readings) -> float:
    """How far from J1 the middles of the discs' chords are, in [cm]."""
    return float(CHORD_END_DISTANCE * np.cos(np.radians(readings.sector_half_width)))


def bend_at(reach: float) -> float:
    """Beta in [deg] with which the end of S2 is so far from J1, in [cm]."""
    cosine = (reach**2 - S1_LENGTH**2 - S2_LENGTH**2) / (2 * S1_LENGTH * S2_LENGTH)
    return float(np.degrees(np.arccos(np.clip(cosine, 0.0, 1.0))))


def beta_of(plane: PlaneMap, hand: np.ndarray) -> float:
    """Give beta in [deg] from where the hand is, [3] in [m]: the further from J1, the straighter is S2."""
    return bend_at(float(np.hypot(hand[0], hand[1])) / plane.scale)
