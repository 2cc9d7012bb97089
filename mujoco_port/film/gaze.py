"""What a body does in films besides reaching: where it looks, and whether it points.

An acting robot's head is filmed as it moved. Where angles are set, neck and eyes follow S1 within the same
limits and speeds.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import mujoco
import numpy as np
from numpy.typing import NDArray

from arm2d.records import brief
from models.build import ROBOT_PREFIX
from models.filmed import finger_joint
from models.presence import Presence
from models.robots import Robot
from mujoco_port.reach.gaze import Gaze

CURL_S: Final = 0.4  # fingers take so long to bend


@dataclass(frozen=True)
class Bearing:
    """F moments of everything that moves and does not act.

    Attributes:
        addresses: [N], where its joints stand among the model's positions.
        angles: [F, N] in [rad].
    """

    addresses: NDArray[np.int64]
    angles: NDArray[np.float64]

    __repr__ = brief


def bearing(
    model: mujoco.MjModel,
    robot: Robot,
    angles: NDArray[np.float64],
    alpha: NDArray[np.float64],
    pointing: NDArray[np.bool_],
    moment_s: float,
    head: NDArray[np.float64] | None = None,
) -> Bearing:
    """Neck, eyes and fingers at F moments.

    Args:
        model: Of `models.filmed`.
        robot: Its record.
        angles: [F, J] in [rad], of what acts.
        alpha: [F] in [deg], direction of S1.
        pointing: [F], whether the hand is to point.
        moment_s: [s] from one moment to the next.
        head: [F, H] in [rad], how neck and eyes have moved; without, they follow S1 here.
    """
    presence = robot.presence
    if presence is None:
        return Bearing(np.empty(0, int), np.empty((len(angles), 0)))
    gaze = Gaze(model, robot, presence)
    if head is None:
        head = np.array(
            [
                gaze.follow(posture, direction, moment_s if moment else None)
                for moment, (posture, direction) in enumerate(zip(angles, alpha, strict=True))
            ]
        )
    hands, curls = _hands(presence, _eased(pointing, moment_s))
    addresses = [*gaze.addresses, *(model.joint(name).qposadr[0] for name in hands)]
    return Bearing(np.array(addresses), np.concatenate([head, curls], axis=1))


def _hands(presence: Presence, curl: NDArray[np.float64]) -> tuple[list[str], NDArray[np.float64]]:
    """Names [N] and angles [F, N] of the fingers' joints: the right hand points, the left one rests."""
    right, left = presence.hands
    names, columns = [], []
    for finger in presence.fingers:
        for phalanx, (pointing, resting) in enumerate(zip(finger.pointing, finger.resting, strict=True)):
            names += [ROBOT_PREFIX + finger_joint(link, finger, phalanx) for link in (right, left)]
            columns += [curl * pointing, np.full_like(curl, resting)]
    return names, np.stack(columns, axis=1)


def _eased(pointing: NDArray[np.bool_], moment_s: float) -> NDArray[np.float64]:
    """How far the hand points, [F], from 0 to 1: as at the start, and from then on no faster than it can."""
    curl = np.empty(len(pointing))
    now = float(pointing[0])
    for moment, wanted in enumerate(pointing):
        now += float(np.clip(wanted - now, -moment_s / CURL_S, moment_s / CURL_S))
        curl[moment] = now * now * (3.0 - 2.0 * now)
    return curl
