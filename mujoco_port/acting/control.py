"""The robot's body in MuJoCo: motors that follow joint angles, physics at 2 ms.

A position actuator alone lags behind. Its set point is therefore shifted by what the motion needs anyway:

    ctrl = q + (kv q' + tau) / kp,   tau = inverse dynamics of (q, q', q'')

by recursive Newton-Euler (Pinocchio), so that the spring has to make up for contacts only. q holds neck and
eyes as well as trunk and arm: what a turning head does to the trunk is part of tau.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Final

import mujoco
import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from arm2d.constants import DT
from models.build import HAND_SITE, OBJECTS, ROBOT_PREFIX
from models.physics import build_physics_model
from models.robots import Robot
from mujoco_port.acting.trajectory import Motion
from mujoco_port.reach.hand import turning_model

# MuJoCo's warnings of numbers that are none, or too large.
UNSTABLE: Final = tuple(
    int(kind)
    for kind in (
        mujoco.mjtWarning.mjWARN_BADQPOS,
        mujoco.mjtWarning.mjWARN_BADQVEL,
        mujoco.mjtWarning.mjWARN_BADQACC,
    )
)


class UnstableError(ValueError):
    """A simulation that blew up: nothing in it means anything."""


@contextmanager
def _no_log() -> Iterator[None]:
    """While open, MuJoCo prints no warning, nor adds it to a MUJOCO_LOG.TXT in the current folder.

    It counts them all the same, for `Body.refuse_unstable`.
    """
    before = mujoco.get_mju_user_warning()
    mujoco.set_mju_user_warning(lambda _: None)
    try:
        yield
    finally:
        mujoco.set_mju_user_warning(before)


class Body:
    """A robot that acts, its table and three free objects.

    J joints reach, H more turn neck and eyes, M = J + H in all, in this order.

    Args:
        robot: Its record.

    Attributes:
        model: Of MuJoCo.
        data: Its state; written by `start` and `follow` only.
        steps_per_turn: Physics steps in a control step.
        hand_site: Which site of the model is the point that plays S2's end.
        head_range: [H, 2] in [rad], limits of neck and eyes.

    Raises:
        NoPhysicsError: If the robot's record says too little.
    """

    def __init__(self, robot: Robot, model: mujoco.MjModel | None = None) -> None:
        self.robot = robot
        self.model = build_physics_model(robot) if model is None else model
        self.data = mujoco.MjData(self.model)
        self.steps_per_turn = round(DT / self.model.opt.timestep)
        joints = [self.model.joint(ROBOT_PREFIX + name) for name in (*robot.joints, *robot.head_joints)]
        self._n, self._turning = len(robot.joints), [joint.qposadr[0] for joint in joints]
        self._angles, self._head = self._turning[: self._n], self._turning[self._n :]
        self._speeds = [joint.dofadr[0] for joint in joints]
        self._held = [robot.fixed.get(name, 0.0) for name in robot.head_joints]
        self.head_range = np.array([joint.range for joint in joints[self._n :]]).reshape(-1, 2)
        self._objects = [self.model.joint(name).qposadr[0] for name in OBJECTS]
        self._heights = [self.model.body(name).pos[2] for name in OBJECTS]
        self._places = np.add.outer(self._objects, np.arange(7))
        self.hand_site = self.model.site(HAND_SITE).id
        self._stiffness = self.model.actuator_gainprm[:, 0].copy()
        self._damping = -self.model.actuator_biasprm[:, 2]
        self._passive = self.model.dof_damping[self._speeds].copy()
        self._dynamics, self._order = turning_model(robot)
        self._dynamics_data = self._dynamics.createData()

    @property
    def posture(self) -> NDArray[np.float64]:
        """Of all joints, [M] in [rad]."""
        return self.data.qpos[self._turning]

    @property
    def angles(self) -> NDArray[np.float64]:
        """Of the joints that reach, [J] in [rad]."""
        return self.data.qpos[self._angles]

    @property
    def velocities(self) -> NDArray[np.float64]:
        """Of all joints, [M] in [rad/s]."""
        return self.data.qvel[self._speeds]

    @property
    def torques(self) -> NDArray[np.float64]:
        """Of all motors, [M] in [N m]."""
        return self.data.actuator_force

    @property
    def head(self) -> NDArray[np.float64]:
        """Of neck and eyes, [H] in [rad]."""
        return self.data.qpos[self._head]

    @property
    def hand(self) -> NDArray[np.float64]:
        """The point that plays S2's end, [3] in [m] in the world."""
        return self.data.site_xpos[self.hand_site]

    @property
    def hand_rotation(self) -> NDArray[np.float64]:
        """[3, 3]: x along the fingers, y to the little finger, z out of the palm."""
        return self.data.site_xmat[self.hand_site].reshape(3, 3)

    @property
    def places(self) -> NDArray[np.float64]:
        """Of the objects, [3, 7]: centre in [m] and quaternion; blue, green, red."""
        return self.data.qpos[self._places]

    def start(
        self,
        angles: NDArray[np.float64],
        objects: NDArray[np.float64],
        head: NDArray[np.float64] | None = None,
    ) -> None:
        """Stand still among objects.

        Args:
            angles: [J] in [rad].
            objects: [3, 2] in [m], their centres on the table.
            head: [H] in [rad]; without, the head is held as it is where it cannot turn.
        """
        mujoco.mj_resetData(self.model, self.data)
        angles = np.concatenate([angles, self._held if head is None else head])
        self.data.qpos[self._turning] = angles
        for address, height, place in zip(self._objects, self._heights, objects, strict=True):
            self.data.qpos[address : address + 7] = (*place, height, 1.0, 0.0, 0.0, 0.0)
        self.data.ctrl[:] = self.set_points(
            Motion(*(np.stack([each]) for each in (angles, 0 * angles, 0 * angles)))
        )[0]
        with _no_log():
            mujoco.mj_forward(self.model, self.data)

    def set_points(self, motion: Motion) -> NDArray[np.float64]:
        """The actuators' controls [N, M] in [rad] for a motion of N moments of M joints."""
        q, v, a = map(self._ordered, (motion.angles, motion.velocities, motion.accelerations))
        torques = np.array(
            [pin.rnea(self._dynamics, self._dynamics_data, *moment) for moment in zip(q, v, a, strict=True)]
        )[:, self._order]
        torques += (self._passive + self._damping) * motion.velocities
        return motion.angles + torques / self._stiffness

    def _ordered(self, values: NDArray[np.float64]) -> NDArray[np.float64]:
        """Values [N, M] of our joints in the order of the dynamics."""
        ordered = np.empty_like(values)
        ordered[:, self._order] = values
        return ordered

    def advance(self, set_point: NDArray[np.float64]) -> None:
        """Take one physics step towards a set point [M] in [rad]."""
        self.data.ctrl[:] = set_point
        with _no_log():
            mujoco.mj_step(self.model, self.data)

    def refuse_unstable(self) -> None:
        """Check that the simulation has not blown up, of which MuJoCo only warns before it begins anew.

        Raises:
            UnstableError: If it has, since `start`.
        """
        if any(self.data.warning[kind].number for kind in UNSTABLE):
            raise UnstableError(
                f"the physics of robot '{self.robot.name}' became unstable; check the motors and shapes "
                "of its record"
            )
