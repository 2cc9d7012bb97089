"""A trial that a robot carries out by itself: motors, free objects, real contacts.

Whoever gives the orders (`Pilot`) says where S2 is to be, ten times in a second and one control step ahead;
the robot makes of it hand targets, joint angles and torques. Everything that a verdict needs is kept for
every physics step.

Axes: N physics steps of 2 ms, K control steps, J joints, 3 objects (blue, green, red).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from arm2d import Instruction
from arm2d.constants import MAX_STEPS
from mujoco_port.contacts import ContactSensors
from mujoco_port.control import Body
from mujoco_port.kinematics import ArmKinematics
from mujoco_port.trajectory import motion_between
from mujoco_port.workspace import hand_headings, hand_targets, on_table

Angles = tuple[float, float]  # alpha and beta in [deg]


class Pilot(Protocol):
    """Who says where S2 is to be."""

    def first(self) -> tuple[Angles, Angles]:
        """Where it stands at the start, and where after the first control step."""
        ...

    def after(self) -> Angles | None:
        """Where it is to be one control step after the one that begins now; None at the end of the orders."""
        ...


@dataclass(frozen=True)
class PhysicalRecord:
    """What a robot did and what became of the objects.

    Attributes:
        instruction: What was asked.
        scale: [m/cm], of the planar map.
        orders: [K + 1, 2], alpha and beta in [deg] at the control steps.
        alpha: [N], direction of S1 in [deg], interpolated as the joints are.
        still: [N], whether S1 does not turn in this control step.
        angles: [N, J] in [rad], measured.
        velocities: [N, J] in [rad/s], measured.
        torques: [N, J] in [N m], of the motors.
        hand: [N, 3] in [m], measured.
        wanted: [N, 3] in [m], where the interpolated joints would have the hand.
        objects: [N, 3, 3] in [m], centres.
        turns: [N, 3, 4], quaternions of the objects.
        upright: [N, 3], cosine of each object's tilt.
        contact: [N, 3], bits of `mujoco_port.contacts`.
        depth: [N] in [m], how deep the deepest contact of the robot is pressed in.
    """

    instruction: Instruction
    scale: float
    orders: NDArray[np.float64]
    alpha: NDArray[np.float64]
    still: NDArray[np.bool_]
    angles: NDArray[np.float64]
    velocities: NDArray[np.float64]
    torques: NDArray[np.float64]
    hand: NDArray[np.float64]
    wanted: NDArray[np.float64]
    objects: NDArray[np.float64]
    turns: NDArray[np.float64]
    upright: NDArray[np.float64]
    contact: NDArray[np.uint8]
    depth: NDArray[np.float64]

    @property
    def steps(self) -> int:
        """K, control steps made."""
        return len(self.orders) - 1

    @property
    def tracking_error(self) -> NDArray[np.float64]:
        """[N] in [m], from where the hand is to where it should be."""
        return np.linalg.norm(self.hand - self.wanted, axis=-1)


def carry_out(
    body: Body,
    kinematics: ArmKinematics,
    pilot: Pilot,
    instruction: Instruction,
    discs: NDArray[np.float64],
    ended: Callable[[PhysicalRecord], bool],
) -> PhysicalRecord:
    """Let a robot carry out a trial until it has ended, the orders end, or 250 control steps are over.

    Args:
        body: The robot; where it was before does not matter.
        kinematics: Its inverse kinematics.
        pilot: Who gives the orders.
        instruction: What is asked; only kept.
        discs: [3, 2] in [cm], centres of blue, green and red at the start.
        ended: Asked after every control step.

    Raises:
        OutOfReachError: If the robot cannot reach a place.
    """
    plane = body.robot.plane

    def solve(order: Angles, before: NDArray[np.float64] | None) -> NDArray[np.float64]:
        alpha, beta = np.array(order[0]), np.array(order[1])
        target, heading = hand_targets(plane, alpha, beta), float(hand_headings(plane, alpha, beta))
        return (
            kinematics.settle(target, heading) if before is None else kinematics.step(before, target, heading)
        )

    orders = list(pilot.first())
    joints = [solve(orders[0], None)]
    joints.append(solve(orders[1], joints[0]))
    joints.insert(0, joints[0])  # it has been standing still
    body.start(joints[0], on_table(plane, discs))
    log = _Log(body, kinematics, instruction, plane.scale)
    for step in range(MAX_STEPS):
        order = pilot.after()
        last = order is None
        orders.append(orders[-1] if order is None else order)
        joints.append(joints[-1] if order is None else solve(order, joints[-1]))
        before = max(step - 1, 0)
        directions = np.array([orders[before], *orders[step : step + 3]])
        log.take(directions, np.array(joints[-4:]))
        record = log.record(orders[: step + 2])
        if last or ended(record):
            break
    return record


class _Log:
    """Moves the body and keeps what it measures, physics step by physics step."""

    def __init__(self, body: Body, kinematics: ArmKinematics, instruction: Instruction, scale: float) -> None:
        self._body, self._kinematics, self._skin = body, kinematics, ContactSensors(body)
        self._asked = instruction, scale
        self._filled = 0
        n, joints = MAX_STEPS * body.steps_per_turn, len(body.angles)
        self._kept = {
            "alpha": np.empty(n),
            "still": np.empty(n, bool),
            "angles": np.empty((n, joints)),
            "velocities": np.empty((n, joints)),
            "torques": np.empty((n, joints)),
            "hand": np.empty((n, 3)),
            "wanted": np.empty((n, 3)),
            "objects": np.empty((n, 3, 3)),
            "turns": np.empty((n, 3, 4)),
            "upright": np.empty((n, 3)),
            "contact": np.empty((n, 3), np.uint8),
            "depth": np.empty(n),
        }

    def take(self, directions: NDArray[np.float64], joints: NDArray[np.float64]) -> None:
        """Carry out one control step, from the second to the third of four knots.

        Args:
            directions: [4, 2] in [deg], alpha and beta.
            joints: [4, J] in [rad].
        """
        body, kept, first, count = self._body, self._kept, self._filled, self._body.steps_per_turn
        rows = slice(first, first + count)
        motion = motion_between(joints, count)
        kept["alpha"][rows] = motion_between(directions, count).angles[:, 0]
        kept["still"][rows] = directions[1, 0] == directions[2, 0]
        kept["wanted"][rows] = [self._kinematics.forward(angles).position for angles in motion.angles]
        for row, set_point in enumerate(body.set_points(motion), start=first):
            body.advance(set_point)
            kept["angles"][row] = body.angles
            kept["velocities"][row] = body.velocities
            kept["torques"][row] = body.torques
            kept["hand"][row] = body.hand
            kept["objects"][row] = body.objects
            kept["turns"][row] = body.object_turns
            kept["upright"][row] = body.uprightness
            kept["contact"][row], kept["depth"][row] = self._skin.read()
        self._filled += count

    def record(self, orders: list[Angles]) -> PhysicalRecord:
        """What has been kept so far; views, not copies."""
        kept = {name: array[: self._filled] for name, array in self._kept.items()}
        return PhysicalRecord(*self._asked, np.array(orders), **kept)
