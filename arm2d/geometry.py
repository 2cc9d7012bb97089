"""Geometry of the arm: S2's frame and bearings in plain Python for the reference, and the view for arrays.

Lengths in [cm], angles in [deg]; a pose is (x, y) of J2 and S2's unit vector. What is in view in recorded
states depends on where the camera sits (reading `camera_origin`); the trial itself judges by `arm2d.kernel`.
"""

from __future__ import annotations

from math import atan2, cos, degrees, hypot, radians, sin

import numpy as np
from numpy.typing import NDArray

from arm2d import constants as c
from arm2d.readings import Readings

Point = tuple[float, float]
Pose = tuple[float, float, float, float]


def turned(alpha: float, beta: float, turns: tuple[float, float]) -> tuple[float, float]:
    """Both angles after both turns [deg]; the joints stop at their bounds (section III)."""
    return (
        min(c.ALPHA_MAX, max(c.ALPHA_MIN, alpha + turns[0])),
        min(c.BETA_MAX, max(c.BETA_MIN, beta + turns[1])),
    )


def s2_pose(alpha: float, beta: float) -> Pose:
    """J2's position and S2's unit vector."""
    a, b = radians(alpha), radians(alpha + beta)
    return c.S1_LENGTH * cos(a), c.S1_LENGTH * sin(a), cos(b), sin(b)


def to_s2(pose: Pose, point: Point) -> Point:
    """(u, v): along S2 from J2, and to its left."""
    x, y, along_x, along_y = point[0] - pose[0], point[1] - pose[1], pose[2], pose[3]
    return x * along_x + y * along_y, y * along_x - x * along_y


def from_s2(pose: Pose, u: float, v: float) -> Point:
    """The point at (u, v)."""
    return pose[0] + u * pose[2] - v * pose[3], pose[1] + u * pose[3] + v * pose[2]


def bearing_of(point: Point) -> float:
    """Direction from J1 in [-90, 270) degrees."""
    return (degrees(atan2(point[1], point[0])) + 90.0) % 360.0 - 90.0


def offset_from_end(alpha: float, point: Point) -> float:
    """Bearing of a point from the end of S1 (J2), relative to S1, in (-180, 180] degrees."""
    joint = s2_pose(alpha, 0.0)
    away = (bearing_of((point[0] - joint[0], point[1] - joint[1])) - alpha) % 360.0
    return away if away <= 180.0 else away - 360.0


def distance_from_end(alpha: float, point: Point) -> float:
    """Distance of a point from the end of S1 (J2) [cm]."""
    joint = s2_pose(alpha, 0.0)
    return hypot(point[0] - joint[0], point[1] - joint[1])


def offset_of(alpha: float, point: Point) -> float:
    """d, the smaller angle between S1 and the bearing of a point [deg]."""
    away = abs(bearing_of(point) - alpha)
    return min(away, 360.0 - away)


def in_view(
    alpha: NDArray[np.float64], centres: NDArray[np.float64], readings: Readings
) -> NDArray[np.bool_]:
    """Whether a disc's centre lies in the camera's field, its bounds included, [...].

    Args:
        alpha: [...], angle of S1 in [deg].
        centres: [..., 2] in [cm].
        readings: Where the camera sits.
    """
    return np.abs(camera_offsets(alpha, centres, readings)) <= c.VIEW_HALF_WIDTH


def camera_offsets(
    alpha: NDArray[np.float64], centres: NDArray[np.float64], readings: Readings
) -> NDArray[np.float64]:
    """Bearings of points [..., 2] as the camera sees them, relative to S1, in [-180, 180) degrees."""
    rest = centres - camera_position(alpha, readings)
    bearing = np.degrees(np.arctan2(rest[..., 1], rest[..., 0]))
    return (bearing - alpha + 180.0) % 360.0 - 180.0


def camera_position(alpha: NDArray[np.float64] | float, readings: Readings) -> NDArray[np.float64]:
    """Where the camera sits, [..., 2] in [cm]: in J1, or at the end of S1."""
    length = c.S1_LENGTH if readings.camera_origin == "end" else 0.0
    angle = np.radians(alpha)
    return length * np.stack([np.cos(angle), np.sin(angle)], axis=-1)
