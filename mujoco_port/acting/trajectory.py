"""Between two control steps: cubic interpolation of the 10 Hz joint targets, for the 2 ms of the physics.

    q(t) = the cubic with q(t_k) = q_k,   q'(t_k) = m_k,
    m_k  = harmonic mean of the slopes on both sides of t_k, 0 where they differ in sign (Fritsch and Carlson)

The path never overshoots: a joint that is told to stop does so without coming back, and a hand that has
pushed an object does not let go of it again. It is local, too: a step depends on the targets one before and
one after it, so that a path can be continued while it is followed.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import PchipInterpolator

from arm2d.constants import DT
from arm2d.records import brief


@dataclass(frozen=True)
class Motion:
    """Joints over N physics steps.

    Attributes:
        angles: [N, J] in [rad].
        velocities: [N, J] in [rad/s].
        accelerations: [N, J] in [rad/s^2].
    """

    angles: NDArray[np.float64]
    velocities: NDArray[np.float64]
    accelerations: NDArray[np.float64]

    __repr__ = brief


def motion_between(knots: NDArray[np.float64], n_physics_steps: int) -> Motion:
    """The motion of one control step.

    Args:
        knots: [4, J] in [rad], targets at t_k-1, t_k, t_k+1, t_k+2; the motion leads from the second to the
            third.
        n_physics_steps: N, how many physics steps a control step has.

    Returns:
        The N moments after t_k, the last of which is t_k+1.
    """
    path = PchipInterpolator(DT * np.arange(-1, 3), knots)
    # The moments themselves, but for the last: from t_k+1 on the next cubic holds, of another acceleration.
    times = DT * np.arange(1, n_physics_steps + 1) / n_physics_steps
    before = np.minimum(times, DT * (1 - 1e-9))
    return Motion(path(times), path(times, 1), path(before, 2))
