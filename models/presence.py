"""What a robot moves besides the arm that reaches: neck, eyes, fingers, and the arm that rests.

None of it touches anything or is part of the kinematics, where it stands still: what is certified there stays
so. Neck and eyes have motors of their own in physics; fingers and the resting arm are moved by films only.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from math import pi
from types import MappingProxyType

from models.appearance import EYE_RADIUS
from models.limits import MotorLimits

Triple = tuple[float, float, float]


@dataclass(frozen=True)
class Eye:
    """An eyeball that turns in its head.

    Attributes:
        name: Of its body.
        link: The head.
        centre: [3] in [m], in the head's frame.
        ahead: [3], unit vector it looks along while it does not turn.
        left: [3], unit vector to the robot's left, square to it.
        still: [3], unit vector it looks along where it cannot turn.
    """

    name: str
    link: str
    centre: Triple
    ahead: Triple
    left: Triple
    still: Triple

    @property
    def joints(self) -> tuple[str, str]:
        """By which it turns: to the left, and down."""
        return f"{self.name}_pan", f"{self.name}_tilt"

    @property
    def axes(self) -> tuple[Triple, Triple]:
        """Of its joints, [3] each in the head's frame: up, and to the left."""
        (a, b, c), (x, y, z) = self.ahead, self.left
        return (b * z - c * y, c * x - a * z, a * y - b * x), self.left


@dataclass(frozen=True)
class Finger:
    """Three phalanges, the first from the palm; x along the finger, which bends towards the palm.

    Attributes:
        name: Its name.
        base: [3] in [m], the knuckle in the hand's frame (x to the fingers, y to the little finger, z out of
            the palm).
        axes: [2, 3], unit vectors along the straight finger, and of its bending (right-handed).
        lengths: [3] in [m].
        radius: [m], at the knuckle; the tip is a little thinner.
        pointing: [3] in [rad], how far the joints bend while the hand points.
        resting: [3] in [rad], the same in a hand that does nothing.
    """

    name: str
    base: Triple
    axes: tuple[Triple, Triple]
    lengths: Triple
    radius: float
    pointing: Triple
    resting: Triple


@dataclass(frozen=True)
class Presence:
    """What moves besides what reaches.

    Attributes:
        neck: Three joints, from the chest to the head: pitch, roll, yaw.
        head: The link they carry.
        ahead: [3], unit vector the face looks along, in the head's frame.
        left: [3], unit vector to the robot's left there.
        neck_speed: [rad/s], the largest of a neck joint.
        neck_torque: [N m], the largest of a neck joint's motor.
        eyes: Both.
        eye_range: [rad], how far an eye turns to either side, up and down.
        eye_speed: [rad/s].
        eye_torque: [N m], the largest of an eye's motors.
        eye_mass: [kg], of an eyeball; the URDF has it in the head.
        hands: Link of a hand -> its frame; z leaves the palm of the right hand and the back of the left.
        fingers: Of either hand; mirrored for the left.
        resting: [rad], angles of joints that stand still otherwise than in physics: the left arm's.
    """

    neck: tuple[str, str, str]
    head: str
    ahead: Triple
    left: Triple
    neck_speed: float
    neck_torque: float
    eyes: tuple[Eye, ...]
    eye_range: float
    eye_speed: float
    eye_torque: float
    eye_mass: float
    hands: Mapping[str, str]
    fingers: tuple[Finger, ...]
    resting: Mapping[str, float] = field(default_factory=dict)

    def __post_init__(self) -> None:
        """Freeze the mappings."""
        object.__setattr__(self, "hands", MappingProxyType(dict(self.hands)))
        object.__setattr__(self, "resting", MappingProxyType(dict(self.resting)))

    @property
    def head_joints(self) -> tuple[str, ...]:
        """The H joints that turn face and eyes: the neck's first, then two for every eye."""
        return (*self.neck, *(name for eye in self.eyes for name in eye.joints))

    @property
    def eye_moment(self) -> float:
        """Moment of inertia of an eyeball about any axis through its centre [kg m^2]."""
        return 0.4 * self.eye_mass * EYE_RADIUS**2

    @property
    def limits(self) -> MotorLimits:
        """Of the motors of `head_joints`."""
        necks, eyes = len(self.neck), 2 * len(self.eyes)
        return MotorLimits(
            velocity=(self.neck_speed,) * necks + (self.eye_speed,) * eyes,
            torque=(self.neck_torque,) * necks + (self.eye_torque,) * eyes,
        )


ALONG, BEND = (1.0, 0.0, 0.0), (0.0, -1.0, 0.0)
CURLED, RELAXED = (1.35, 1.65, 1.0), (0.42, 0.55, 0.35)
# The straight fingers are the capsules of `models.shapes` that meet objects.
FINGERS = (
    Finger("little", (0.022, 0.0225, -0.010), (ALONG, BEND), (0.024, 0.017, 0.015), 0.0095, CURLED, RELAXED),
    Finger("ring", (0.026, 0.0055, -0.010), (ALONG, BEND), (0.026, 0.018, 0.015), 0.0092, CURLED, RELAXED),
    Finger("middle", (0.027, -0.010, -0.010), (ALONG, BEND), (0.027, 0.019, 0.015), 0.0092, CURLED, RELAXED),
    Finger(
        "index",
        (0.024, -0.0245, -0.010),
        (ALONG, BEND),
        (0.025, 0.016, 0.013),
        0.0092,
        (0.02, 0.02, 0.02),
        (0.3, 0.4, 0.25),
    ),
    Finger(
        "thumb",
        (-0.012, -0.026, 0.002),
        ((0.33, -0.943, 0.03), (-0.25, -0.12, 0.96)),
        (0.026, 0.020, 0.017),
        0.0092,
        (0.75, 0.75, 0.5),
        (0.4, 0.3, 0.2),
    ),
)
RESTING = {
    "l_shoulder_pitch": 0.1,
    "l_shoulder_roll": 0.36,
    "l_shoulder_yaw": 0.1,
    "l_elbow": 0.42,
    "l_wrist_prosup": 0.2,
    "l_wrist_pitch": -0.1,
}
NECK = ("neck_pitch", "neck_roll", "neck_yaw")
HANDS = {"r_hand": "r_hand_dh_frame", "l_hand": "l_hand_dh_frame"}
# Speeds: a neck that turns by 60 degrees in a second follows S1, which turns by 29; eyes are quicker.
# The motors of the neck could do 100 (Gazebo files of icub-models); their torque is `effort` in the URDF of
# example-robot-data. No URDF has eyes that turn: the rest is chosen, with a camera in every eyeball.
NECK_SPEED, EYE_SPEED, EYE_RANGE = pi / 3, 4 * pi / 3, pi / 6
NECK_TORQUE, EYE_TORQUE, EYE_MASS = 20.0, 0.1, 0.05


def _presence(ahead: Triple, left: Triple, still: Triple, centres: tuple[Triple, Triple]) -> Presence:
    """The presence of an iCub, whose versions differ in the frame of the head."""
    names = ("left_eye", "right_eye")
    eyes = tuple(
        Eye(name, "head", centre, ahead, left, still) for name, centre in zip(names, centres, strict=True)
    )
    return Presence(
        neck=NECK,
        head="head",
        ahead=ahead,
        left=left,
        neck_speed=NECK_SPEED,
        neck_torque=NECK_TORQUE,
        eyes=eyes,
        eye_range=EYE_RANGE,
        eye_speed=EYE_SPEED,
        eye_torque=EYE_TORQUE,
        eye_mass=EYE_MASS,
        hands=HANDS,
        fingers=FINGERS,
        resting=RESTING,
    )


# y is up and z ahead in the iCub's head; 10 degrees down where the eyes cannot turn: to the table.
ICUB_PRESENCE = _presence(
    ahead=(0.0, 0.0, 1.0),
    left=(1.0, 0.0, 0.0),
    still=(0.0, -0.17, 0.985),
    centres=((0.034, 0.1043, 0.0505), (-0.034, 0.1043, 0.0505)),
)
# In the older one's head x is back, y down and z to the right.
ICUB_ERD_PRESENCE = _presence(
    ahead=(-1.0, 0.0, 0.0),
    left=(0.0, 0.0, -1.0),
    still=(-0.985, 0.17, 0.0),
    centres=((-0.0435, -0.107, -0.034), (-0.0435, -0.107, 0.034)),
)
