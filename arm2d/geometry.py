"""Geometry of the arm in plain Python, for the reference: a pose of S2 and its frame, bearings.

Lengths in [cm], angles in [deg]; a pose is (x, y) of J2 and S2's unit vector.
"""

from math import atan2, cos, degrees, hypot, radians, sin

from arm2d import constants as c

Point = tuple[float, float]
Pose = tuple[float, float, float, float]


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
