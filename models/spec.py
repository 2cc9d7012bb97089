"""A robot's URDF as MuJoCo reads it, with nothing left out."""

from __future__ import annotations

import re

import mujoco

from models.robots import Robot
from models.urdf import RobotNotInstalledError, read_urdf

# Else MuJoCo would leave out what is only shown, and merge links that do not move into others.
KEEP_ALL = '<mujoco><compiler discardvisual="false" fusestatic="false"/></mujoco>'


def read_spec(robot: Robot) -> mujoco.MjSpec:
    """Give a robot's URDF as a specification of MuJoCo, all links and all shapes that are shown kept.

    Raises:
        RobotNotInstalledError: If the robot's package is missing.
    """
    text = read_urdf(robot)
    opened = re.search(r"<robot\b[^>]*>", text)
    if opened is None:
        raise RobotNotInstalledError(
            f"{robot.urdf} of the package {robot.package} holds no robot; "
            f"run: pip install --force-reinstall {robot.package}"
        )
    return mujoco.MjSpec.from_string(text[: opened.end()] + KEEP_ALL + text[opened.end() :])
