"""A robot as a film shows it: that of `models.build` with a head that turns, fingers, and an arm at rest.

Only looked at: what acts is built in `models.physics`, and what is certified in `models.build`.
"""

from __future__ import annotations

from dataclasses import replace

import mujoco
import numpy as np

from models.appearance import Ornament
from models.build import ROBOT_PREFIX, add_ornament, build_spec
from models.head import ORIGIN, add_eyes, loosened
from models.presence import Finger, Presence
from models.robots import Robot
from models.spec import read_spec

# Of a hand, in its frame: where the palm is thick, as ellipsoids (centre, half axes) [m].
PALM = (
    ((-0.003, 0.0085, -0.010), (0.040, 0.026, 0.0155)),
    ((-0.004, -0.009, -0.009), (0.040, 0.024, 0.0155)),
    ((-0.016, -0.019, -0.001), (0.027, 0.017, 0.0145)),
    ((-0.038, 0.0, -0.006), (0.026, 0.023, 0.017)),
)
KNUCKLE, TIP = 1.04, 0.90  # radii, of the finger's
WRIST = 0.0175  # [m], radius


def film_spec(robot: Robot, finer: float = 1.0) -> mujoco.MjSpec:
    """Put a robot at its table to be filmed.

    Args:
        robot: Its record.
        finer: How many times the triangles that do for a small picture are kept.

    Raises:
        RobotNotInstalledError: If the robot's package is missing.
    """
    presence = robot.presence
    if presence is None:
        return build_spec(robot, finer)
    spec = build_spec(_undressed(robot, presence), finer)
    add_eyes(spec, presence)
    frames = read_spec(robot)
    for mirror, (link, frame) in zip((1.0, -1.0), presence.hands.items(), strict=True):
        hand = spec.body(ROBOT_PREFIX + link).add_body(
            name=ROBOT_PREFIX + hand_name(link), pos=frames.body(frame).pos, quat=frames.body(frame).quat
        )
        _add_hand(spec, hand, presence.fingers, mirror)
    return spec


def hand_name(link: str) -> str:
    """The body that carries the fingers of a hand's link."""
    return f"{link}_shown"


def finger_joint(link: str, finger: Finger, phalanx: int) -> str:
    """The joint by which a phalanx, from 0, of a hand's finger bends."""
    return f"{hand_name(link)}_{finger.name}_{phalanx}"


def _undressed(robot: Robot, presence: Presence) -> Robot:
    """The robot without what is added here, its left arm at rest, its neck loose."""
    frames = {*presence.hands, *presence.hands.values()}
    look = robot.appearance
    look = replace(
        look,
        bare=(*look.bare, *presence.hands),
        swaps=tuple(each for each in look.swaps if each.link not in frames),
        ornaments=tuple(each for each in look.ornaments if each.link not in frames),
    )
    fixed = {**robot.fixed, **presence.resting}
    return loosened(replace(robot, appearance=look, fixed=fixed), presence)


def _add_hand(spec: mujoco.MjSpec, hand: mujoco.MjsBody, fingers: tuple[Finger, ...], mirror: float) -> None:
    """Add palm and fingers; a left hand's z leaves its back, so there all z change sign."""
    link = hand.name.removeprefix(ROBOT_PREFIX)
    flip = np.array([1.0, 1.0, mirror])
    for centre, size in PALM:
        add_ornament(spec, Ornament(link, "ellipsoid", size, tuple(flip * centre), "hand"))
    start, end = flip * (-0.064, 0.0, -0.006), flip * (-0.05, 0.0, -0.006)
    add_ornament(spec, Ornament(link, "capsule", (WRIST,), tuple(start), "cover", to=tuple(end)))
    for finger in fingers:
        _add_finger(spec, hand, finger, flip)


def _add_finger(spec: mujoco.MjSpec, hand: mujoco.MjsBody, finger: Finger, flip: np.ndarray) -> None:
    """Add three phalanges, one at the end of the other."""
    along, bend = flip * finger.axes[0], flip[2] * flip * finger.axes[1]  # an axis mirrors the other way
    body, place = hand, flip * finger.base
    for phalanx, length in enumerate(finger.lengths):
        body = body.add_body(name=f"{hand.name}_{finger.name}_{phalanx}", pos=list(place))
        body.add_joint(name=body.name, axis=list(bend), type=mujoco.mjtJoint.mjJNT_HINGE)
        _give_mass(body)
        place = length * along
        link = body.name.removeprefix(ROBOT_PREFIX)
        last = phalanx == len(finger.lengths) - 1
        radius = finger.radius * (TIP if last else 1.0)
        add_ornament(spec, Ornament(link, "sphere", (finger.radius * KNUCKLE,), ORIGIN, "metal"))
        skin = "fingertip" if last else "hand"
        add_ornament(spec, Ornament(link, "capsule", (radius,), tuple(0.12 * place), skin, to=tuple(place)))


def _give_mass(body: mujoco.MjsBody) -> None:
    """What moves must weigh something, though nothing here asks how much."""
    body.mass, body.inertia, body.explicitinertial = 1e-3, [1e-6] * 3, True
