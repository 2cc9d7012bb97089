"""The parts of a robot that only a film moves: neck, eyes, fingers, and the arm that rests.

They touch nothing, carry nothing and are no part of kinematics or physics, where they stand still: what is
certified there stays so.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from math import pi
from types import MappingProxyType

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
    """What a film moves besides what acts.

    Attributes:
        neck: Three joints, from the chest to the head: pitch, roll, yaw.
        head: The link they carry.
        ahead: [3], unit vector the face looks along, in the head's frame.
        left: [3], unit vector to the robot's left there.
        neck_speed: [rad/s], the largest of a neck joint.
        eyes: Both.
        eye_range: [rad], how far an eye turns to either side, up and down.
        eye_speed: [rad/s].
        hands: Link of a hand -> its frame; z leaves the palm of the right hand and the back of the left.
        fingers: Of either hand; mirrored for the left.
        resting: [rad], angles of joints that stand still otherwise than in physics: the left arm's.
    """

    neck: tuple[str, str, str]
    head: str
    ahead: Triple
    left: Triple
    neck_speed: float
    eyes: tuple[Eye, ...]
    eye_range: float
    eye_speed: float
    hands: Mapping[str, str]
    fingers: tuple[Finger, ...]
    resting: Mapping[str, float] = field(default_factory=dict)

    def __post_init__(self) -> None:
        """Freeze the mappings."""
        object.__setattr__(self, "hands", MappingProxyType(dict(self.hands)))
        object.__setattr__(self, "resting", MappingProxyType(dict(self.resting)))


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
NECK_SPEED, EYE_SPEED, EYE_RANGE = pi / 3, 4 * pi / 3, pi / 6


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
        eyes=eyes,
        eye_range=EYE_RANGE,
        eye_speed=EYE_SPEED,
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
