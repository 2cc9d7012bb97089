"""What is in view in recorded states, from wherever the camera sits (reading `camera_origin`).

For arrays of any shape [...]; the trial itself judges by `arm2d.kernel`.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from arm2d import constants as c
from arm2d.readings import Readings


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
