"""A head that turns: the neck's joints of the URDF, and eyeballs that are cut out of the head."""

from __future__ import annotations

from dataclasses import replace

import mujoco
import numpy as np

from models.appearance import eyeball
from models.build import ROBOT_PREFIX, add_ornament
from models.presence import Presence
from models.robots import Robot

ORIGIN = (0.0, 0.0, 0.0)


def loosened(robot: Robot, presence: Presence) -> Robot:
    """The robot with a neck that is not held, and without eyes: `add_eyes` gives it some that turn."""
    return replace(robot, presence=None, loose=presence.neck)


def add_eyes(spec: mujoco.MjSpec, presence: Presence) -> None:
    """Add eyeballs that turn to the left, then down."""
    for eye in presence.eyes:
        ball = spec.body(ROBOT_PREFIX + eye.link).add_body(name=ROBOT_PREFIX + eye.name, pos=list(eye.centre))
        for name, axis in zip(eye.joints, eye.axes, strict=True):
            ball.add_joint(
                name=ROBOT_PREFIX + name,
                axis=list(axis),
                type=mujoco.mjtJoint.mjJNT_HINGE,
                range=[-presence.eye_range, presence.eye_range],
            )
        ball.mass, ball.ipos, ball.inertia = presence.eye_mass, list(ORIGIN), [presence.eye_moment] * 3
        ball.explicitinertial = True
        for part in eyeball(eye.name, ORIGIN, eye.ahead):
            add_ornament(spec, part)


def cut_out_eyes(spec: mujoco.MjSpec, presence: Presence) -> None:
    """Take the eyeballs' mass from the head, whose inertia in the URDF has them in it.

    Head and eyes together weigh what they did, wherever the eyes look: a ball that turns about its centre
    stays the same ball.
    """
    head = spec.body(ROBOT_PREFIX + presence.head)
    centre, mass = np.array(head.ipos), head.mass
    about_origin = _symmetric(head.fullinertia) + _of_point(mass, centre)
    moment = centre * mass
    for eye in presence.eyes:
        mass -= presence.eye_mass
        moment = moment - presence.eye_mass * np.array(eye.centre)
        about_origin -= presence.eye_moment * np.eye(3) + _of_point(presence.eye_mass, np.array(eye.centre))
    about_centre = about_origin - _of_point(mass, moment / mass)
    (xx, xy, xz), (_, yy, yz), (_, _, zz) = about_centre
    head.mass, head.ipos, head.fullinertia = mass, moment / mass, [xx, yy, zz, xy, xz, yz]


def _symmetric(moments: np.ndarray) -> np.ndarray:
    """MuJoCo's six moments as a matrix [3, 3]."""
    xx, yy, zz, xy, xz, yz = moments
    return np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])


def _of_point(mass: float, place: np.ndarray) -> np.ndarray:
    """Inertia [3, 3] about the origin of a mass [kg] in a point [3] in [m]."""
    return mass * (place @ place * np.eye(3) - np.outer(place, place))
