"""The model of `models.build`, made to act: a robot with motors and a hand that can touch."""

from __future__ import annotations

from collections.abc import Mapping

import mujoco
import numpy as np

from models.build import OBJECTS, ROBOT_PREFIX, build_spec
from models.head import add_eyes, cut_out_eyes, loosened
from models.inertias import unsound_inertias
from models.limits import MotorLimits
from models.robots import Robot
from models.shapes import ContactShape

SHAPE_PREFIX = "touching/"  # of the names of the shapes that meet objects
SHAPE_GROUP = 3  # not drawn
TABLE_TOPS = ("top", "right_wing", "left_wing")
EYE = "eye"  # a camera in J1
# Which shapes meet: objects (1) with everything, the robot's shapes (2) with objects only.
OBJECT_BIT, ROBOT_BIT = 1, 2

# Sliding friction. Rubber skin of a hand on an object: 1.2 to 1.5. Object on table: plastic on wood, 0.3 to
# 0.5; with less, an object comes loose from a hand that stops.
HAND_FRICTION = 1.3
TABLE_FRICTION = 0.5
# [m], resistance to rolling: the force of a soft skin acts somewhere in the patch that it makes with a
# cylinder, whose half-width is sqrt(2 radius depth), 8 mm where a cylinder of 17 mm is pressed in by 1.9 mm,
# or one of 22 mm by 1.5 mm. Without it cylinders roll off a hand that is not quite square to its way.
ROLLING_RESISTANCE = 0.008
# [m], of a skin's soft layer, two millimetres thick, that gives way under next to no force, and is felt. An
# arm that stops swings by a tenth of a millimetre; without this, what it has pushed counts as untouched.
# Since MuJoCo 3.9 a geom's gap is where contacts are found that push nothing.
SKIN = 0.0005
# A motor pulls like a spring of this natural frequency on the inertia that the joint moves at rest,
# critically damped: stiff enough to hold the hand, soft enough for steps of 2 ms.
NATURAL_FREQUENCY = 66.0  # [rad/s]


class NoPhysicsError(ValueError):
    """A robot's record says too little for it to act."""


def limits_of_acting(robot: Robot) -> MotorLimits:
    """Give the limits of a robot's motors; one that cannot act gets a NoPhysicsError."""
    refuse_unsound(robot)
    if robot.limits is None or not robot.shapes:
        missing = "motor limits" if robot.limits is None else "contact shapes"
        raise NoPhysicsError(
            f"the record of robot '{robot.name}' has no {missing}; play the trial without physics"
        )
    return robot.limits


def build_physics_model(robot: Robot) -> mujoco.MjModel:
    """Compile the robot with one position actuator for each joint that reaches, then for each of its head.

    An actuator's torque is kp (ctrl - q) - kv q', cut off at the motor's limit.

    Raises:
        NoPhysicsError: If nothing is known of the robot's motors, or of the shape of its hand.
        RobotNotInstalledError: If the robot's package is missing.
    """
    limits = limits_of_acting(robot)
    spec = turning_spec(robot)
    for shape in robot.shapes:
        add_shape(spec, shape)
    for name in TABLE_TOPS:
        spec.geom(name).friction = [TABLE_FRICTION, 0.005, 0.0001]
    for name in OBJECTS:
        spec.geom(name).friction = [TABLE_FRICTION, 0.005, 0.0001]
        spec.geom(name).contype = OBJECT_BIT
        spec.geom(name).conaffinity = OBJECT_BIT | ROBOT_BIT
    motors = dict(zip(robot.joints, limits.torque, strict=True))
    if robot.presence is not None:
        motors |= zip(robot.head_joints, robot.presence.limits.torque, strict=True)
    add_motors(spec, robot, motors)
    middle = spec.geom(OBJECTS[0]).size[1]  # of an object that stands on the table
    spec.worldbody.add_camera(name=EYE, pos=[0.0, 0.0, middle])
    return spec.compile()


def turning_spec(robot: Robot) -> mujoco.MjSpec:
    """A robot at its table whose neck and eyes can turn, if anything is known of them."""
    if robot.presence is None:
        return build_spec(robot)
    spec = build_spec(loosened(robot, robot.presence))
    cut_out_eyes(spec, robot.presence)
    add_eyes(spec, robot.presence)
    return spec


def refuse_unsound(robot: Robot) -> None:
    """Check that every link has an inertia that a body can have.

    Raises:
        NoPhysicsError: If some have not; it names them.
    """
    if unsound := unsound_inertias(robot):
        raise NoPhysicsError(
            f"robot '{robot.name}' has {len(unsound)} links that cannot act: {', '.join(map(str, unsound))}; "
            "play the trial without physics, or take the robot 'icub'"
        )


def add_shape(spec: mujoco.MjSpec, shape: ContactShape) -> None:
    """Add one shape without mass that meets objects."""
    body = spec.body(ROBOT_PREFIX + shape.link)
    place = {"type": mujoco.mjtGeom.mjGEOM_BOX, "pos": list(shape.start), "size": list(shape.end)}
    if shape.radius is not None:
        ends = [*shape.start, *shape.end]
        place = {"type": mujoco.mjtGeom.mjGEOM_CAPSULE, "fromto": ends, "size": [shape.radius, 0.0, 0.0]}
    body.add_geom(
        name=SHAPE_PREFIX + shape.name,
        group=SHAPE_GROUP,
        mass=0.0,
        contype=ROBOT_BIT,
        conaffinity=0,
        priority=1,  # the hand's friction holds, not the larger of both
        friction=[HAND_FRICTION, 0.005, ROLLING_RESISTANCE],
        condim=6,
        gap=SKIN,
        **place,
    )


def add_motors(spec: mujoco.MjSpec, robot: Robot, motors: Mapping[str, float]) -> None:
    """Add position actuators: joint -> largest torque [N m]."""
    inertias = moved_inertias(spec.compile(), robot, tuple(motors))
    for (name, torque), inertia in zip(motors.items(), inertias, strict=True):
        stiffness, damping = inertia * NATURAL_FREQUENCY**2, 2.0 * inertia * NATURAL_FREQUENCY
        actuator = spec.add_actuator(name=name, target=ROBOT_PREFIX + name, trntype=mujoco.mjtTrn.mjTRN_JOINT)
        actuator.gainprm[0] = stiffness
        actuator.biastype = mujoco.mjtBias.mjBIAS_AFFINE
        actuator.biasprm[1:3] = -stiffness, -damping
        actuator.forcelimited = True
        actuator.forcerange = [-torque, torque]


def moved_inertias(model: mujoco.MjModel, robot: Robot, names: tuple[str, ...]) -> np.ndarray:
    """What some joints move when the robot is at rest, one by one in [kg m^2]: the mass matrix's diagonal."""
    data = mujoco.MjData(model)
    joints = [model.joint(ROBOT_PREFIX + name) for name in names]
    rest = {**robot.fixed, **dict(zip(robot.joints, robot.posture.rest, strict=True))}
    data.qpos[[joint.qposadr[0] for joint in joints]] = [rest.get(name, 0.0) for name in names]
    mujoco.mj_forward(model, data)
    dofs = [joint.dofadr[0] for joint in joints]
    return np.array([acceleration_cost(model, data, dof) for dof in dofs])


def acceleration_cost(model: mujoco.MjModel, data: mujoco.MjData, dof: int) -> float:
    """One diagonal entry of the mass matrix."""
    unit, column = np.zeros(model.nv), np.zeros(model.nv)
    unit[dof] = 1.0
    mujoco.mj_mulM(model, data, column, unit)
    return column[dof]
