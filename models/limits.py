"""What a robot's motors can do."""

from __future__ import annotations

from dataclasses import dataclass
from math import pi


@dataclass(frozen=True)
class MotorLimits:
    """Largest speed and torque of every acting joint, in either direction.

    Attributes:
        velocity: [J] in [rad/s].
        torque: [J] in [N m].
    """

    velocity: tuple[float, ...]
    torque: tuple[float, ...]


# The URDF of iCubGenova04 leaves both open: it says 50,000 for every joint. Velocity: `jntVelMax` of the
# Gazebo files (iCub/conf/gazebo_icub_*.ini) of the same package, 100 degrees per second. Torque: `effort` in
# the other published URDF of the robot, icub_description of example-robot-data.
ICUB_LIMITS = MotorLimits(
    velocity=(100 * pi / 180,) * 10,
    torque=(36.0, 80.0, 80.0, 84.0, 84.0, 34.0, 20.0, 0.45, 0.65, 0.65),
)
