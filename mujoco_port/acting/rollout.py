"""A trial that a robot carries out by itself: motors, free objects, real contacts.

Whoever gives the orders (`Pilot`) says where S2 is to be, ten times in a second and one control step ahead;
the robot makes of it hand targets, joint angles and torques. Everything that a verdict needs is kept for
every physics step.

Axes: N physics steps of 2 ms, K control steps, J joints that reach, H that turn the head, M = J + H,
3 objects (blue, green, red).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final, NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from arm2d import Instruction
from arm2d.constants import DT, MAX_STEPS
from arm2d.records import brief
from mujoco_port.acting.contacts import RIGHT_SIDE, ContactSensors
from mujoco_port.acting.control import Body
from mujoco_port.acting.stepping_over import stepping_over
from mujoco_port.acting.trajectory import motion_between
from mujoco_port.reach.gaze import Gaze
from mujoco_port.reach.kinematics import ArmKinematics
from mujoco_port.reach.workspace import hand_headings, hand_targets, on_table, tip_in_plane

Angles = tuple[float, float]  # alpha and beta in [deg]
# A 2D trial ends after 250 steps. A step there counts by its last moment, so 100 good ones may be all but a
# step of 10 s, and in closed loop orders come a step late: the robot has half a second more to be judged.
MOST_STEPS: Final = MAX_STEPS + 5
MOST_RISE: Final = 0.4  # of the way up, or down, in a control step
# Of a joint's largest speed, how much its targets may use: from rest to rest, a cubic is half as fast again
# in the middle, and never faster.
UNHURRIED: Final = 2 / 3


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
        step_s: [s], a physics step.
        orders: [K + 1, 2], alpha and beta in [deg] at the control steps.
        alpha: [N], direction of S1 in [deg], interpolated as the joints are.
        still: [N], whether S1 does not turn in this control step.
        angles: [N, J] in [rad], measured.
        velocities: [N, J] in [rad/s], measured.
        torques: [N, J] in [N m], of the motors.
        hand: [N, 3] in [m], measured.
        joints: [N, J] in [rad], where the interpolated path has them.
        head: [N, H] in [rad], measured: neck and eyes.
        head_velocities: [N, H] in [rad/s], measured.
        head_torques: [N, H] in [N m], of its motors.
        places: [N, 3, 7], of the objects: centre in [m] and quaternion.
        contact: [N, 3], bits of `mujoco_port.acting.contacts`.
        depth: [N] in [m], how deep the deepest contact of the robot is pressed in.
        inputs: [K, 18], what an agent in closed loop sensed; None where none did.
    """

    instruction: Instruction
    scale: float
    step_s: float
    orders: NDArray[np.float64]
    alpha: NDArray[np.float64]
    still: NDArray[np.bool_]
    angles: NDArray[np.float64]
    velocities: NDArray[np.float64]
    torques: NDArray[np.float64]
    hand: NDArray[np.float64]
    joints: NDArray[np.float64]
    head: NDArray[np.float64]
    head_velocities: NDArray[np.float64]
    head_torques: NDArray[np.float64]
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
    trial = Carrying(body, kinematics, pilot, eyes, instruction, discs)
    for _ in range(MOST_STEPS):
        if not trial.step() or ended(trial.record):
            break
    return trial.record


class Carrying:
    """A trial that is being carried out, one control step at a time.

    Args:
        body: The robot; where it was before does not matter.
        kinematics: Its inverse kinematics.
        pilot: Who gives the orders.
        eyes: How agent and robot see objects.
        instruction: What is asked; only kept.
        discs: [3, 2] in [cm], centres of blue, green and red at the start.

    Raises:
        OutOfReachError: If the robot cannot reach a place.
    """

    def __init__(
        self,
        body: Body,
        kinematics: ArmKinematics,
        pilot: Pilot,
        eyes: Eyes,
        instruction: Instruction,
        discs: NDArray[np.float64],
    ) -> None:
        self._body, self._kinematics, self._pilot, self._eyes = body, kinematics, pilot, eyes
        self._plane = plane = body.robot.plane
        self._gaze = _gaze_of(body)
        self._orders = list(pilot.first())
        joints = [self._solve(self._orders[0], None, 0.0)]
        joints.append(self._solve(self._orders[1], joints[0], 0.0))
        joints.insert(0, joints[0])  # it has been standing still
        self._joints = joints
        reach = len(body.robot.joints)
        body.start(joints[0][:reach], on_table(plane, discs), joints[0][reach:])
        self._log = _Log(body, instruction)
        self._raised, self._done, self._first = 0.0, 0, 0

    @property
    def record(self) -> PhysicalRecord:
        """What has been done since the start, or since other words were asked; views, not copies."""
        return self._log.record(self._orders[self._first : self._done + 1], self._log.before)

    def ask(self, instruction: Instruction) -> None:
        """Begin another record from here, of other words; the pilot hears of them from its owner."""
        self._log, self._first = self._log.followed_by(instruction), self._done

    def step(self) -> bool:
        """Carry out one control step; whether there are more orders.

        Raises:
            OutOfReachError: If the robot cannot reach a place.
            UnstableError: If the simulation blows up.
        """
        orders, joints, step, plane = self._orders, self._joints, self._done, self._plane
        so_far = self._log.record(orders[self._first : step + 1])
        seen = self._eyes(orders[step][0])
        order = self._pilot.after(so_far, seen.by_camera)
        orders.append(orders[-1] if order is None else order)
        wanted = above_objects(self._body, on_table(plane, seen.from_j1), so_far, orders[-1])
        self._raised += float(np.clip(wanted - self._raised, -MOST_RISE, MOST_RISE))
        joints.append(joints[-1] if order is None else self._solve(order, joints[-1], self._raised))
        before = max(step - 1, 0)
        directions = np.array([orders[before], *orders[step : step + 3]])
        self._log.take(directions, np.array(joints[-4:]))
        self._done += 1
        return order is not None

    def _solve(self, order: Angles, before: NDArray[np.float64] | None, raised: float) -> NDArray[np.float64]:
        """Angles [M] in [rad] of arm and head for an order, near those before it."""
        alpha, beta = np.array(order[0]), np.array(order[1])
        target = hand_targets(self._plane, alpha, beta, raised)
        heading = float(hand_headings(self._plane, alpha, beta))
        if before is None:
            reaching = self._kinematics.settle(target, heading)
        else:
            reaching = self._kinematics.step(before[: len(self._body.robot.joints)], target, heading)
        if self._gaze is None:
            return reaching
        looking = self._gaze.follow(reaching, order[0], None if before is None else DT)
        return np.concatenate([reaching, looking])


def _gaze_of(body: Body) -> Gaze | None:
    """What a body's head follows S1 with, if it can."""
    presence = body.robot.presence
    return None if presence is None else Gaze(body.model, body.robot, presence, UNHURRIED)


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

    def __init__(self, body: Body, instruction: Instruction) -> None:
        self._body, self._skin, self._instruction = body, ContactSensors(body), instruction
        self._filled, self.before = 0, 0  # rows, and those of them that were there before the words
        n, joints = (MOST_STEPS + 1) * body.steps_per_turn, len(body.posture)
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
            joints: [4, M] in [rad], of arm and head.
        """
        body, kept, first, count = self._body, self._kept, self._filled, self._body.steps_per_turn
        rows = slice(first, first + count)
        motion = motion_between(joints, count)
        kept["alpha"][rows] = motion_between(directions, count).angles[:, 0]
        kept["still"][rows] = directions[1, 0] == directions[2, 0]
        kept["joints"][rows] = motion.angles
        for row, set_point in enumerate(body.set_points(motion), start=first):
            body.advance(set_point)
            kept["angles"][row] = body.posture
            kept["velocities"][row] = body.velocities
            kept["torques"][row] = body.torques
            kept["hand"][row] = body.hand
            kept["places"][row] = body.places
            kept["contact"][row], kept["depth"][row] = self._skin.read()
        body.refuse_unstable()
        self._filled += count

    def followed_by(self, instruction: Instruction) -> _Log:
        """A log that goes on from here with other words; it remembers the last control step."""
        log = _Log(self._body, instruction)
        log.before = log._filled = min(self._filled, self._body.steps_per_turn)
        for name, array in self._kept.items():
            log._kept[name][: log.before] = array[self._filled - log.before : self._filled]
        return log

    def record(self, orders: list[Angles], since: int = 0) -> PhysicalRecord:
        """What has been kept since a row; views, not copies."""
        kept = {name: array[since : self._filled] for name, array in self._kept.items()}
        robot, step_s = self._body.robot, self._body.model.opt.timestep
        reach = len(robot.joints)
        kept["joints"] = kept["joints"][:, :reach]
        for name, of_head in (
            ("angles", "head"),
            ("velocities", "head_velocities"),
            ("torques", "head_torques"),
        ):
            kept[name], kept[of_head] = kept[name][:, :reach], kept[name][:, reach:]
        return PhysicalRecord(self._instruction, robot.plane.scale, step_s, np.array(orders), **kept)
