"""Pinocchio's models of a robot in the world: what reaches, its hand a frame; and all that turns."""

from __future__ import annotations

from collections.abc import Sequence
from difflib import get_close_matches

import numpy as np
import pinocchio as pin

from models.presence import Eye, Presence
from models.robots import Robot
from models.urdf import find_urdf


def hand_model(robot: Robot) -> tuple[pin.Model, int]:
    """Give the model of the joints that reach, all others held, and the index of its hand's frame.

    Raises:
        ValueError: If the robot's description has no such joint or frame.
    """
    model = _standing(robot, robot.joints)
    _refuse_unknown(robot, "frame", [robot.hand_frame], [frame.name for frame in model.frames])
    link = model.frames[model.getFrameId(robot.hand_frame)]
    offset = pin.SE3(np.eye(3), np.array(robot.hand_offset))
    hand = pin.Frame("hand", link.parentJoint, link.placement * offset, pin.FrameType.OP_FRAME)
    return model, model.addFrame(hand)


def turning_model(robot: Robot) -> tuple[pin.Model, list[int]]:
    """Give the model of all that turns in physics: what reaches, neck and eyes.

    Returns:
        The model, and which of its angles are those of `robot.joints` and of its `head_joints`, in this
        order.
    """
    presence = robot.presence
    model = _standing(robot, (*robot.joints, *(() if presence is None else presence.neck)))
    if presence is not None:
        for eye in presence.eyes:
            _add_eye(model, presence, eye)
    names = (*robot.joints, *robot.head_joints)
    return model, [model.joints[model.getJointId(name)].idx_q for name in names]


def _add_eye(model: pin.Model, presence: Presence, eye: Eye) -> None:
    """Cut an eyeball out of the head and let it turn there."""
    head = model.frames[model.getFrameId(eye.link)]
    place = head.placement * pin.SE3(np.eye(3), np.array(eye.centre))
    ball = pin.Inertia(presence.eye_mass, np.zeros(3), presence.eye_moment * np.eye(3))
    left = model.inertias[head.parentJoint].toDynamicParameters() - place.act(ball).toDynamicParameters()
    model.inertias[head.parentJoint] = pin.Inertia.FromDynamicParameters(left)
    joint = head.parentJoint
    for name, axis in zip(eye.joints, eye.axes, strict=True):
        joint = model.addJoint(joint, pin.JointModelRevoluteUnaligned(np.array(axis)), place, name)
        place = pin.SE3.Identity()
    model.appendBodyToJoint(joint, ball, place)


def _standing(robot: Robot, joints: tuple[str, ...]) -> pin.Model:
    """A model of some joints, the others held at their angle in the robot's record."""
    whole = pin.buildModelFromUrdf(str(find_urdf(robot)))
    _refuse_unknown(robot, "joint", [*joints, *robot.fixed], list(whole.names)[1:])
    locked = [index for index, name in enumerate(whole.names) if index > 0 and name not in joints]
    angles = pin.neutral(whole)
    for name, angle in robot.fixed.items():
        angles[whole.joints[whole.getJointId(name)].idx_q] = angle
    model = pin.buildReducedModel(whole, locked, angles)
    base = pin.SE3(pin.rpy.rpyToMatrix(0.0, 0.0, robot.base_yaw), np.array(robot.base_position))
    for joint in range(1, model.njoints):
        if model.parents[joint] == 0:
            model.jointPlacements[joint] = base * model.jointPlacements[joint]
    return model


def _refuse_unknown(robot: Robot, kind: str, asked: Sequence[str], there: Sequence[str]) -> None:
    """Refuse names that the robot's description does not have, and say which is nearest."""
    for name in asked:
        if name not in there:
            near = get_close_matches(name, there, n=1, cutoff=0.0)
            raise ValueError(
                f"{robot.urdf} of the robot '{robot.name}' has no {kind} '{name}'; near to it: {near[0]}"
            )
