"""Pinocchio's model of a robot's acting joints, standing in the world, its hand a frame of its own."""

from __future__ import annotations

import numpy as np
import pinocchio as pin

from models.robots import Robot
from models.urdf import find_urdf


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
