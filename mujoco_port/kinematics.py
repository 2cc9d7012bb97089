"""Inverse kinematics: from hand targets to joint angles, with Pinocchio.

The hand's position is met exactly, its heading and level as nearly as the posture allows for:

    minimise    1/2 |q - rest|^2_W + w_h/2 heading(q)^2 + w_l/2 |tilt(q)|^2
    subject to  position(q) = target,   lower <= q <= upper

Per target one proximal Gauss-Newton step on the whole problem (`inertia` holds on to the last posture,
without it the redundant joints oscillate), then Newton steps on the position alone until the error is
below `TOLERANCE`.
Both are the quadratic programme of `mujoco_port.quadratic`.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pinocchio as pin

from models.robots import Robot
from models.urdf import find_urdf
from mujoco_port.quadratic import bounded, relaxed

WORLD_AXES = pin.ReferenceFrame.LOCAL_WORLD_ALIGNED
TOLERANCE = 1e-10  # [m], distance to the target at which the Newton steps end
MAX_NEWTON_STEPS = 30
MAX_SETTLING_STEPS = 400
SETTLED = 1e-7  # [rad], change per step at which a posture counts as settled


class OutOfReachError(ValueError):
    """A hand target that no posture within the joint limits reaches.

    Attributes:
        distance: [m], from the target to the nearest place that was reached.
    """

    def __init__(self, target: np.ndarray, distance: float, robot: str) -> None:
        self.distance = distance
        place = ", ".join(f"{x:.3f}" for x in target)
        super().__init__(f"target ({place}) m lies {distance:.3f} m beyond the reach of the arm of '{robot}'")


@dataclass(frozen=True)
class HandPose:
    """Where the hand is: position [3] in [m] and rotation [3, 3], both in the world."""

    position: np.ndarray
    rotation: np.ndarray


class ArmKinematics:
    """Forward and inverse kinematics of the joints that act; angles in the order of the robot's `joints`.

    Attributes:
        robot: The robot's record.
        rest: [J] in [rad], the posture that is approached.
        lower: [J] in [rad], lower joint limits.
        upper: [J] in [rad], upper joint limits.
    """

    def __init__(self, robot: Robot) -> None:
        self.robot = robot
        self._model, self._hand = hand_model(robot)
        self._data = self._model.createData()
        self._placement = self._data.oMf[self._hand]
        posture = robot.posture
        self.rest = np.array(posture.rest)
        self.lower = self._model.lowerPositionLimit.copy()
        self.upper = self._model.upperPositionLimit.copy()
        self._weights = np.array(posture.weights)
        self._metric = np.diag(self._weights)
        self._no_pull = np.zeros_like(self._weights)
        self._wishes = np.array([posture.heading_weight, posture.level_weight, posture.inertia])
        for array in (self.rest, self.lower, self.upper):
            array.flags.writeable = False

    def forward(self, angles: np.ndarray) -> HandPose:
        """Give the hand's pose for joint angles [J] in [rad]."""
        pin.framesForwardKinematics(self._model, self._data, np.asarray(angles, dtype=float))
        placement = self._data.oMf[self._hand]
        return HandPose(placement.translation.copy(), placement.rotation.copy())

    def settle(self, target: np.ndarray, heading: float) -> np.ndarray:
        """Give the posture [J] in [rad] for one target, whatever came before: the start of a trial.

        Args:
            target: [3] in [m] in the world.
            heading: [rad], wanted direction of the fingers in the plane.

        Raises:
            OutOfReachError: If no posture within the limits reaches the target.
        """
        angles = np.clip(self.rest, self.lower, self.upper)
        for _ in range(MAX_SETTLING_STEPS):
            before = angles
            angles = self._relax(angles, target, heading)
            if np.abs(angles - before).max() < SETTLED:
                break
        return self._home_in(angles, target)

    def step(self, angles: np.ndarray, target: np.ndarray, heading: float) -> np.ndarray:
        """Give the posture [J] in [rad] for the next target of a path.

        Args:
            angles: [J] in [rad], the posture at the target before.
            target: [3] in [m] in the world.
            heading: [rad], wanted direction of the fingers in the plane.

        Raises:
            OutOfReachError: If no posture within the limits reaches the target.
        """
        return self._home_in(self._relax(angles, target, heading), target)

    def follow(self, targets: np.ndarray, headings: np.ndarray) -> np.ndarray:
        """Give the postures [K, J] in [rad] along a path of targets [K, 3] in [m] and headings [K] in [rad].

        Raises:
            OutOfReachError: If a target is out of reach.
        """
        path = np.empty((len(targets), len(self.rest)))
        path[0] = self.settle(targets[0], headings[0])
        for k in range(1, len(targets)):
            path[k] = self.step(path[k - 1], targets[k], headings[k])
        return path

    def _relax(self, angles: np.ndarray, target: np.ndarray, heading: float) -> np.ndarray:
        """Take one proximal Gauss-Newton step on position, posture, heading and level together."""
        jacobian = self._jacobian(angles)
        hand = self._placement
        return relaxed(
            angles,
            jacobian,
            hand.rotation,
            target - hand.translation,
            heading,
            self.rest,
            self._weights,
            self._wishes,
            self.lower,
            self.upper,
        )

    def _home_in(self, angles: np.ndarray, target: np.ndarray) -> np.ndarray:
        """Take Newton steps on the position alone until the hand is there."""
        for _ in range(MAX_NEWTON_STEPS):
            jacobian = self._jacobian(angles)
            error = target - self._placement.translation
            if error @ error < TOLERANCE**2:
                return angles
            angles = bounded(self._metric, self._no_pull, jacobian, error, angles, self.lower, self.upper)
        raise OutOfReachError(target, float(np.linalg.norm(error)), self.robot.name)

    def _jacobian(self, angles: np.ndarray) -> np.ndarray:
        """Give the hand's Jacobian [6, J] in world axes; the hand's placement is updated on the way."""
        return pin.computeFrameJacobian(self._model, self._data, angles, self._hand, WORLD_AXES)


def hand_model(robot: Robot) -> tuple[pin.Model, int]:
    """Give Pinocchio's model of the acting joints, standing in the world, and its hand frame's index."""
    whole = pin.buildModelFromUrdf(str(find_urdf(robot)))
    locked = [index for index, name in enumerate(whole.names) if index > 0 and name not in robot.joints]
    angles = pin.neutral(whole)
    for name, angle in robot.fixed.items():
        angles[whole.joints[whole.getJointId(name)].idx_q] = angle
    model = pin.buildReducedModel(whole, locked, angles)
    base = pin.SE3(pin.rpy.rpyToMatrix(0.0, 0.0, robot.base_yaw), np.array(robot.base_position))
    for joint in range(1, model.njoints):
        if model.parents[joint] == 0:
            model.jointPlacements[joint] = base * model.jointPlacements[joint]
    link = model.frames[model.getFrameId(robot.hand_frame)]
    offset = pin.SE3(np.eye(3), np.array(robot.hand_offset))
    hand = pin.Frame("hand", link.parentJoint, link.placement * offset, pin.FrameType.OP_FRAME)
    return model, model.addFrame(hand)
