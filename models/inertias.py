"""Whether the links of a robot have inertias that a body can have."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import mujoco
import numpy as np
from numpy.typing import NDArray

from models.robots import Robot
from models.spec import read_spec

SLACK: Final = 1e-6  # of the triangle inequality, relative to the largest moment: rounding in the file


@dataclass(frozen=True)
class UnsoundInertia:
    """A link whose inertia no body can have.

    Attributes:
        link: Its name.
        reason: What is wrong with it.
    """

    link: str
    reason: str

    def __str__(self) -> str:
        return f"{self.link} ({self.reason})"


def unsound_inertias(robot: Robot) -> tuple[UnsoundInertia, ...]:
    """Give the links of a robot's URDF that have a mass and no inertia of a body; massless frames are none.

    The moments about the principal axes of a body are positive, and none exceeds the sum of the others.

    Raises:
        RobotNotInstalledError: If the robot's package is missing.
    """
    found = []
    for body in read_spec(robot).bodies:
        reason = fault(body.mass, moments(body)) if body.explicitinertial else ""
        if reason:
            found.append(UnsoundInertia(body.name, reason))
    return tuple(found)


def moments(body: mujoco.MjsBody) -> NDArray[np.float64]:
    """Principal moments of a link [3] in [kg m^2], rising; 0 where the URDF gives none."""
    xx, yy, zz, xy, xz, yz = body.fullinertia
    if np.isnan(xx):
        return np.sort(body.inertia)
    return np.linalg.eigvalsh([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])


def fault(mass: float, principal: NDArray[np.float64]) -> str:
    """What is wrong with a mass [kg] and its principal moments [3] in [kg m^2]; empty if nothing is."""
    if mass <= mujoco.mjMINVAL:
        return ""
    least, middle, largest = principal
    if largest <= mujoco.mjMINVAL:
        return f"{mass:.3g} kg without inertia"
    if least <= 0.0:
        return f"a moment of {least:.2g} kg m^2"
    if largest > (least + middle) * (1.0 + SLACK):
        return f"a moment of {largest:.3g} kg m^2, more than the {least + middle:.3g} of the others together"
    return ""
