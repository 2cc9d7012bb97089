"""Inverse kinematics: from hand targets to joint angles, with Pinocchio.

The hand's position is met exactly, its heading and roll as nearly as the posture allows for:

    minimise    1/2 |q - rest|^2_W + w_h/2 heading(q)^2 + w_l/2 |tilt(q)|^2
    subject to  position(q) = target,   lower <= q <= upper

Per target one proximal Gauss-Newton step on the whole problem (`inertia` holds on to the last posture,
without it the redundant joints oscillate), then Newton steps on the position alone until the error is
below `TOLERANCE`.
Both are the quadratic programme of `quadratic.py`. Between two targets of a path no joint turns by more
than `MAX_TURN`, where that lets the hand arrive.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import isfinite

import numpy as np
import pinocchio as pin

from arm2d.records import brief
from models.robots import Robot, get_robot
from mujoco_port.reach.hand import hand_model
from mujoco_port.reach.quadratic import bounded, relaxed

WORLD_AXES = pin.ReferenceFrame.LOCAL_WORLD_ALIGNED
TOLERANCE = 1e-10  # [m], distance to the target at which the Newton steps end
MAX_NEWTON_STEPS = 30
MAX_TURN = 0.12  # [rad], of one joint from one target to the next; the project promises 0.15
MAX_SETTLING_STEPS = 400
SETTLED = 1e-7  # [rad], change per step at which a posture counts as settled
# The search for the nearest place to a target that Newton steps did not reach.
N_STARTS = 12  # postures it starts from: the last one, rest, and random ones
MAX_DAMPED_STEPS = 200
FIRST_DAMPING, LEAST_DAMPING, MOST_DAMPING = 1e-3, 1e-12, 1e6  # of J'J [m^2/rad^2]


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

    __repr__ = brief


class ArmKinematics:
    """Forward and inverse kinematics of the joints that act; angles in the order of the robot's `joints`.

    Args:
        robot: Its record, or its name.

    Raises:
        ValueError: If the record names joints or a frame that its description does not have.

    Attributes:
        robot: The robot's record.
        rest: [J] in [rad], the posture that is approached.
        lower: [J] in [rad], lower joint limits.
        upper: [J] in [rad], upper joint limits.
    """

    def __init__(self, robot: Robot | str = "icub") -> None:
        robot = get_robot(robot) if isinstance(robot, str) else robot
        self.robot = robot
        self._model, self._hand = hand_model(robot)
        self._data = self._model.createData()
        self._placement = self._data.oMf[self._hand]
        posture = robot.posture
        self.rest = np.array(posture.rest)
        self.lower = self._model.lowerPositionLimit.copy()
        self.upper = self._model.upperPositionLimit.copy()
        # Copies that can be written to, as a step's bounds can: else Numba would compile the solver twice.
        self._bounds = self.lower.copy(), self.upper.copy()
        self._weights = np.array(posture.weights)
        self._metric = np.diag(self._weights)
        self._down = np.array([0.0, np.sin(posture.roll), np.cos(posture.roll)])
        self._no_pull = np.zeros_like(self._weights)
        self._wishes = np.array([posture.heading_weight, posture.level_weight, posture.inertia])
        for array in (self.rest, self.lower, self.upper):
            array.flags.writeable = False

    def __repr__(self) -> str:
        return f"<ArmKinematics of {self.robot.name}: {len(self.rest)} joints>"

    def forward(self, angles: np.ndarray) -> HandPose:
        """Give the hand's pose for joint angles [J] in [rad]."""
        pin.framesForwardKinematics(self._model, self._data, np.asarray(angles, dtype=float))
        placement = self._data.oMf[self._hand]
        return HandPose(placement.translation.copy(), placement.rotation.copy())

    def roll_error(self, pose: HandPose) -> float:
        """Give the angle [rad] between the palm's wanted direction and that of a pose."""
        return float(np.arccos(np.clip(-(pose.rotation @ self._down)[2], -1.0, 1.0)))

    def heading_error(self, pose: HandPose, heading: float) -> float:
        """Give by how much [rad] the fingers of a pose point away from a heading [rad]."""
        off = np.arctan2(pose.rotation[1, 0], pose.rotation[0, 0]) - heading
        return float(abs((off + np.pi) % (2 * np.pi) - np.pi))

    def settle(self, target: np.ndarray, heading: float) -> np.ndarray:
        """Give the posture [J] in [rad] for one target, whatever came before: the start of a trial.

        Args:
            target: [3] in [m] in the world.
            heading: [rad], wanted direction of the fingers in the plane.

        Raises:
            ValueError: If target or heading is not a number.
            OutOfReachError: If no posture within the limits reaches the target.
        """
        _refuse_no_number(target, heading, self.rest)
        angles = np.clip(self.rest, self.lower, self.upper)
        for _ in range(MAX_SETTLING_STEPS):
            before = angles
            angles = self._relax(angles, target, heading, *self._bounds)
            if np.abs(angles - before).max() < SETTLED:
                break
        arrived = self._home_in(angles, target, *self._bounds)
        return self._nearest(angles, target) if arrived is None else arrived

    def step(self, angles: np.ndarray, target: np.ndarray, heading: float) -> np.ndarray:
        """Give the posture [J] in [rad] for the next target of a path.

        Args:
            angles: [J] in [rad], the posture at the target before.
            target: [3] in [m] in the world.
            heading: [rad], wanted direction of the fingers in the plane.

        Raises:
            ValueError: If the posture, target or heading is not a number.
            OutOfReachError: If no posture within the limits reaches the target.
        """
        _refuse_no_number(target, heading, angles)
        lower = np.maximum(self.lower, angles - MAX_TURN)
        upper = np.minimum(self.upper, angles + MAX_TURN)
        arrived = self._home_in(self._relax(angles, target, heading, lower, upper), target, lower, upper)
        if arrived is None:  # further away than a turn leads
            arrived = self._home_in(angles, target, *self._bounds)
        return self._nearest(angles, target) if arrived is None else arrived

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

    def _relax(
        self, angles: np.ndarray, target: np.ndarray, heading: float, lower: np.ndarray, upper: np.ndarray
    ) -> np.ndarray:
        """Take one proximal Gauss-Newton step on position, posture, heading and level together."""
        jacobian = self._jacobian(angles)
        hand = self._placement
        return relaxed(
            angles,
            jacobian,
            hand.rotation,
            target - hand.translation,
            heading,
            self._down,
            self.rest,
            self._weights,
            self._wishes,
            lower,
            upper,
        )

    def _home_in(
        self, angles: np.ndarray, target: np.ndarray, lower: np.ndarray, upper: np.ndarray
    ) -> np.ndarray | None:
        """Take Newton steps on the position alone until the hand is there; None if it does not arrive."""
        for _ in range(MAX_NEWTON_STEPS):
            jacobian = self._jacobian(angles)
            error = target - self._placement.translation
            if error @ error < TOLERANCE**2:
                return angles
            angles = bounded(self._metric, self._no_pull, jacobian, error, angles, lower, upper)
        return None

    def _nearest(self, angles: np.ndarray, target: np.ndarray) -> np.ndarray:
        """Search from several postures for one that reaches the target after all.

        The starts are the same whenever this is called, so results repeat.

        Raises:
            OutOfReachError: If none does; it tells the distance from the nearest place.
        """
        random = np.random.default_rng(0).uniform(self.lower, self.upper, (N_STARTS - 2, len(self.rest)))
        shortest = np.inf
        for start in (angles, np.clip(self.rest, self.lower, self.upper), *random):
            nearest, distance = self._descend(start, target)
            arrived = self._home_in(nearest, target, *self._bounds)
            if arrived is not None:
                return arrived
            shortest = min(shortest, distance)
        raise OutOfReachError(target, shortest, self.robot.name)

    def _descend(self, angles: np.ndarray, target: np.ndarray) -> tuple[np.ndarray, float]:
        """Shorten the distance to a target by Levenberg-Marquardt steps within the joint limits."""
        identity, no_rows = np.eye(len(angles)), np.empty(0)
        damping = FIRST_DAMPING
        jacobian = self._jacobian(angles)[:3]
        error = target - self._placement.translation
        for _ in range(MAX_DAMPED_STEPS):
            hessian = jacobian.T @ jacobian + damping * identity
            trial = bounded(hessian, -error @ jacobian, jacobian, no_rows, angles, *self._bounds)
            trial_jacobian = self._jacobian(trial)[:3]
            trial_error = target - self._placement.translation
            if trial_error @ trial_error < error @ error:
                angles, jacobian, error = trial, trial_jacobian, trial_error
                damping = max(damping / 3.0, LEAST_DAMPING)
            elif damping < MOST_DAMPING:
                damping *= 4.0
            else:
                break
        return angles, float(np.linalg.norm(error))

    def _jacobian(self, angles: np.ndarray) -> np.ndarray:
        """Give the hand's Jacobian [6, J] in world axes; the hand's placement is updated on the way."""
        return pin.computeFrameJacobian(self._model, self._data, angles, self._hand, WORLD_AXES)


def _refuse_no_number(target: np.ndarray, heading: float, angles: np.ndarray) -> None:
    """Refuse what the solver would carry on with, to a posture that is none.

    One sum tells all at once: it is finite only if everything in it is. This is asked at every step.
    """
    if isfinite(target.dot(target) + heading + angles.dot(angles)):
        return
    for name, given, unit in (
        ("target", target, "m"),
        ("heading", heading, "rad"),
        ("posture", angles, "rad"),
    ):
        if not np.isfinite(given).all():
            raise ValueError(f"{name} {np.asarray(given).tolist()} {unit} holds what is not a finite number")
