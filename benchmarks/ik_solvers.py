"""Whose inverse kinematics are compared: ours, mink's and pin-pink's, each as one call per target.

All get the same targets, rest posture and joint limits, start where they settle at the first target, and are
warm-started with their own last posture. mink and pin-pink solve for a velocity; with a step of 1 s and a
gain of 1 that is a Gauss-Newton step, taken until the hand is within `tolerance` of its target, `MAX_STEPS`
times at most.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from importlib.util import find_spec
from typing import Final, Protocol

import mujoco
import numpy as np
from numpy.typing import NDArray

from models.build import HAND_SITE, ROBOT_PREFIX, build_spec
from models.robots import Robot
from mujoco_port.reach.hand import hand_model
from mujoco_port.reach.kinematics import ArmKinematics

SOLVER: Final = "daqp"  # the quickest that both take
MAX_STEPS: Final = 20
N_SETTLING: Final = 60
OBJECTS: Final = ("blue", "green", "red")


class Solver(Protocol):
    """One way to follow a path of targets."""

    name: str

    def step(
        self, angles: NDArray[np.float64], target: NDArray[np.float64], heading: float
    ) -> NDArray[np.float64]:
        """The posture [J] in [rad] for the next target [3] in [m] and heading [rad]."""
        ...


@dataclass(frozen=True)
class Settings:
    """What can be tuned in mink and pin-pink; the position costs 1 [1/m].

    Attributes:
        posture: Cost of the distance to the rest posture [1/rad].
        damping: Cost of the squared step (Tikhonov) [1/rad^2]. Without it the posture that the arm is free to
            choose swings from one side to the other, and a tenth of the steps do not arrive.
        tolerance: [m], distance to the target at which the steps end.
    """

    posture: float
    damping: float
    tolerance: float

    def __str__(self) -> str:
        return f"posture {self.posture:g}, damping {self.damping:g}, stop at {self.tolerance:g} m"


class Ours:
    """`mujoco_port.reach.kinematics`; without wishes for the hand's rotation it is position only."""

    def __init__(self, robot: Robot, *, with_heading: bool) -> None:
        if not with_heading:
            robot = replace(robot, posture=replace(robot.posture, heading_weight=0.0, level_weight=0.0))
        self.name = "ours, with heading" if with_heading else "ours, position only"
        self._kinematics = ArmKinematics(robot)

    def step(self, angles, target, heading):
        """As `Solver`."""
        return self._kinematics.step(angles, target, heading)


class Mink:
    """mink on a MuJoCo model of the robot alone: no table, no objects, no shapes."""

    def __init__(self, robot: Robot, settings: Settings) -> None:
        import mink

        self.name, self._mink, self._settings = "mink", mink, settings
        model = bare_model(robot)
        self._order = [model.joint(ROBOT_PREFIX + name).qposadr[0] for name in robot.joints]
        self._configuration = mink.Configuration(model)
        self._hand = mink.FrameTask(HAND_SITE, "site", position_cost=1.0, orientation_cost=0.0)
        posture = mink.PostureTask(model, cost=settings.posture)
        rest = np.zeros(model.nq)
        rest[self._order] = robot.posture.rest
        posture.set_target(rest)
        self._tasks = [self._hand, posture]
        self._limits = [mink.ConfigurationLimit(model, gain=1.0)]

    def step(self, angles, target, heading):
        """As `Solver`."""
        whole = np.empty(self._configuration.model.nq)
        whole[self._order] = angles
        self._configuration.update(whole)
        self._hand.set_target(self._mink.SE3.from_translation(target))
        for _ in range(MAX_STEPS):
            error = self._hand.compute_error(self._configuration)[:3]
            if error @ error < self._settings.tolerance**2:
                break
            velocity = self._mink.solve_ik(
                self._configuration, self._tasks, 1.0, SOLVER, self._settings.damping, limits=self._limits
            )
            self._configuration.integrate_inplace(velocity, 1.0)
        return self._configuration.q[self._order]


class Pink:
    """pin-pink on Pinocchio's model of the acting joints, ours."""

    def __init__(self, robot: Robot, settings: Settings) -> None:
        import pink
        import pinocchio as pin
        from pink.limits import ConfigurationLimit

        self.name, self._pink, self._pin, self._settings = "pin-pink", pink, pin, settings
        self._model, _ = hand_model(robot)
        self._data = self._model.createData()
        self._hand = pink.tasks.FrameTask("hand", position_cost=1.0, orientation_cost=0.0)
        posture = pink.tasks.PostureTask(cost=settings.posture)
        posture.set_target(np.array(robot.posture.rest))
        self._tasks = [self._hand, posture]
        self._limits = [ConfigurationLimit(self._model, config_limit_gain=1.0)]
        self._lower, self._upper = self._model.lowerPositionLimit, self._model.upperPositionLimit

    def step(self, angles, target, heading):
        """As `Solver`."""
        configuration = self._pink.Configuration(self._model, self._data, angles, copy_data=False)
        self._hand.set_target(self._pin.SE3(np.eye(3), target))
        for _ in range(MAX_STEPS):
            error = self._hand.compute_error(configuration)[:3]
            if error @ error < self._settings.tolerance**2:
                break
            velocity = self._pink.solve_ik(
                configuration,
                self._tasks,
                1.0,
                SOLVER,
                damping=self._settings.damping,
                limits=self._limits,
                safety_break=False,
            )
            configuration.integrate_inplace(velocity, 1.0)
        return np.clip(configuration.q, self._lower, self._upper)


# `python -m benchmarks.ik --tune` tries all of these. Taken is the quickest that brings every step within the
# micrometre that this project promises, without larger jumps than others.
TRIED: Final = tuple(
    Settings(posture, damping, tolerance)
    for posture in (1e-3, 1e-4, 3e-5)
    for damping in (1e-12, 1e-8, 1e-7, 1e-5)
    for tolerance in (1e-6, 1e-7)
)
TUNED: Final = {"mink": Settings(1e-4, 1e-7, 1e-6), "pin-pink": Settings(1e-4, 1e-7, 1e-6)}
LIBRARIES: Final = {"mink": ("mink", Mink), "pin-pink": ("pink", Pink)}


def settled(
    solver: Solver, start: NDArray[np.float64], target: NDArray[np.float64], heading: float
) -> NDArray[np.float64]:
    """Where a solver comes to rest at a target [3] in [m]: the fair start of a path."""
    angles = start
    for _ in range(N_SETTLING):
        angles = solver.step(angles, target, heading)
    return angles


def installed() -> list[str]:
    """Which of the other two can be compared with."""
    return [name for name, (module, _) in LIBRARIES.items() if find_spec(module) and find_spec(SOLVER)]


def library(name: str, robot: Robot, settings: Settings) -> Solver:
    """One of the other two."""
    return LIBRARIES[name][1](robot, settings)


def bare_model(robot: Robot) -> mujoco.MjModel:
    """The robot in MuJoCo with nothing to draw or to meet: what mink needs, and no more."""
    spec = build_spec(robot)
    for name in OBJECTS:
        spec.delete(spec.body(name))
    for geom in list(spec.geoms):
        spec.delete(geom)
    for mesh in list(spec.meshes):
        spec.delete(mesh)
    return spec.compile()
