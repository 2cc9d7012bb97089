"""A trial that a robot carries out by itself: motors, free objects, real contacts.

Whoever gives the orders (`Pilot`) says where S2 is to be, ten times in a second and one control step ahead;
the robot makes of it hand targets, joint angles and torques. Everything that a verdict needs is kept for
every physics step.

Axes: N physics steps of 2 ms, K control steps, J joints, 3 objects (blue, green, red).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final, NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from arm2d import Instruction
from arm2d.constants import MAX_STEPS
from arm2d.records import brief
from mujoco_port.acting.contacts import RIGHT_SIDE, ContactSensors
from mujoco_port.acting.control import Body
from mujoco_port.acting.stepping_over import stepping_over
from mujoco_port.acting.trajectory import motion_between
from mujoco_port.reach.kinematics import ArmKinematics
from mujoco_port.reach.workspace import hand_headings, hand_targets, on_table, tip_in_plane

Angles = tuple[float, float]  # alpha and beta in [deg]
# A 2D trial ends after 250 steps. A step there counts by its last moment, so 100 good ones may be all but a
# step of 10 s, and in closed loop orders come a step late: the robot has half a second more to be judged.
MOST_STEPS: Final = MAX_STEPS + 5
MOST_RISE: Final = 0.4  # of the way up, or down, in a control step


class Sight(NamedTuple):
    """Where each object seems to be, [3, 2] in [cm] of the 2D world.

    Attributes:
        by_camera: To the agent's camera, in J1 or at the end of S1.
        from_j1: To an eye in J1, by which the robot avoids coming down on an object.
    """

    by_camera: NDArray[np.float64]
    from_j1: NDArray[np.float64]


# Eyes look along alpha [deg].
Eyes = Callable[[float], Sight]


class Pilot(Protocol):
    """Who says where S2 is to be."""

    def first(self) -> tuple[Angles, Angles]:
        """Where it stands at the start, and where after the first control step."""
        ...

    def after(self, so_far: PhysicalRecord, seen: NDArray[np.float64]) -> Angles | None:
        """Where it is to be after the control step that follows the one that begins now.

        Args:
            so_far: The trial up to now, without a row at its start.
            seen: [3, 2] in [cm] of the 2D world, where the agent's camera sees the objects now.

        Returns:
            None at the end of the orders.
        """
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
        joints: [N, J] in [rad], where the interpolated path has them.
        places: [N, 3, 7], of the objects: centre in [m] and quaternion.
        contact: [N, 3], bits of `mujoco_port.acting.contacts`.
        depth: [N] in [m], how deep the deepest contact of the robot is pressed in.
        inputs: [K, 18], what an agent in closed loop sensed; None where none did.
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
    joints: NDArray[np.float64]
    places: NDArray[np.float64]
    contact: NDArray[np.uint8]
    depth: NDArray[np.float64]
    inputs: NDArray[np.float64] | None = None

    __repr__ = brief

    @property
    def steps(self) -> int:
        """K, control steps made."""
        return len(self.orders) - 1

    @property
    def objects(self) -> NDArray[np.float64]:
        """[N, 3, 3] in [m], centres of the objects."""
        return self.places[..., :3]

    @property
    def upright(self) -> NDArray[np.float64]:
        """[N, 3], the cosine of each object's tilt."""
        return 1.0 - 2.0 * (self.places[..., 4] ** 2 + self.places[..., 5] ** 2)


def carry_out(
    body: Body,
    kinematics: ArmKinematics,
    pilot: Pilot,
    eyes: Eyes,
    instruction: Instruction,
    discs: NDArray[np.float64],
    ended: Callable[[PhysicalRecord], bool],
) -> PhysicalRecord:
    """Let a robot carry out a trial until it has ended, the orders end, or 255 control steps are over.

    Args:
        body: The robot; where it was before does not matter.
        kinematics: Its inverse kinematics.
        pilot: Who gives the orders.
        eyes: How agent and robot see objects.
        instruction: What is asked; only kept.
        discs: [3, 2] in [cm], centres of blue, green and red at the start.
        ended: Asked after every control step.

    Raises:
        OutOfReachError: If the robot cannot reach a place.
        UnstableError: If the simulation blows up.
    """
    plane = body.robot.plane

    def solve(order: Angles, before: NDArray[np.float64] | None, raised: float) -> NDArray[np.float64]:
        alpha, beta = np.array(order[0]), np.array(order[1])
        target, heading = hand_targets(plane, alpha, beta, raised), float(hand_headings(plane, alpha, beta))
        return (
            kinematics.settle(target, heading) if before is None else kinematics.step(before, target, heading)
        )

    orders = list(pilot.first())
    joints = [solve(orders[0], None, 0.0)]
    joints.append(solve(orders[1], joints[0], 0.0))
    joints.insert(0, joints[0])  # it has been standing still
    body.start(joints[0], on_table(plane, discs))
    log = _Log(body, instruction, plane.scale)
    record = log.record(orders[:1])
    raised = 0.0
    for step in range(MOST_STEPS):
        seen = eyes(orders[step][0])
        order = pilot.after(record, seen.by_camera)
        last = order is None
        orders.append(orders[-1] if order is None else order)
        wanted = above_objects(body, on_table(plane, seen.from_j1), record, orders[-1])
        raised += float(np.clip(wanted - raised, -MOST_RISE, MOST_RISE))
        joints.append(joints[-1] if order is None else solve(order, joints[-1], raised))
        before = max(step - 1, 0)
        directions = np.array([orders[before], *orders[step : step + 3]])
        log.take(directions, np.array(joints[-4:]))
        record = log.record(orders[: step + 2])
        if last or ended(record):
            break
    return record


def above_objects(body: Body, objects: NDArray[np.float64], record: PhysicalRecord, order: Angles) -> float:
    """How far the hand has to stay above objects [3, 2] in [m] that it does not push, from 0 to 1.

    A hand that is above the objects already must not come down on one that is below it by the time of the
    order, two control steps from now; a low one pushes what it will meet.
    """
    plane, ahead = body.robot.plane, body.hand_rotation[:, 0]
    pushed = (record.contact[-body.steps_per_turn :] & RIGHT_SIDE).any(axis=0)
    left = objects[~pushed]
    now = float(stepping_over(plane.hand_print, body.hand[:2], np.arctan2(ahead[1], ahead[0]), left))
    if body.hand[2] < plane.hand_print.clear_height:
        return now
    tip, heading = on_table(plane, tip_in_plane(*order)), hand_headings(plane, *order)
    return max(now, float(stepping_over(plane.hand_print, tip, heading, left)))


class _Log:
    """Moves the body and keeps what it measures, physics step by physics step."""

    def __init__(self, body: Body, instruction: Instruction, scale: float) -> None:
        self._body, self._skin = body, ContactSensors(body)
        self._asked = instruction, scale
        self._filled = 0
        n, joints = MOST_STEPS * body.steps_per_turn, len(body.angles)
        self._kept = {
            "alpha": np.empty(n),
            "still": np.empty(n, bool),
            "angles": np.empty((n, joints)),
            "velocities": np.empty((n, joints)),
            "torques": np.empty((n, joints)),
            "hand": np.empty((n, 3)),
            "joints": np.empty((n, joints)),
            "places": np.empty((n, 3, 7)),
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
        kept["joints"][rows] = motion.angles
        for row, set_point in enumerate(body.set_points(motion), start=first):
            body.advance(set_point)
            kept["angles"][row] = body.angles
            kept["velocities"][row] = body.velocities
            kept["torques"][row] = body.torques
            kept["hand"][row] = body.hand
            kept["places"][row] = body.places
            kept["contact"][row], kept["depth"][row] = self._skin.read()
        body.refuse_unstable()
        self._filled += count

    def record(self, orders: list[Angles]) -> PhysicalRecord:
        """What has been kept so far; views, not copies."""
        kept = {name: array[: self._filled] for name, array in self._kept.items()}
        return PhysicalRecord(*self._asked, np.array(orders), **kept)
