"""The robots that can take the place of the 2D arm, as data: one frozen record for each.

A robot comes from an installed package; nothing of it is kept here but names and numbers.
A further robot is a further record. Units: metres and radians, unless a name says otherwise.

World frame: that of the 2D world, x to the right and y straight ahead, with the arm's first
joint J1 in the origin and z = 0 on the table top.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from math import pi
from types import MappingProxyType

from models.appearance import ICUB_APPEARANCE, ICUB_ERD_APPEARANCE, Appearance
from models.limits import ICUB_LIMITS, MotorLimits
from models.presence import ICUB_ERD_PRESENCE, ICUB_PRESENCE, Presence
from models.shapes import ICUB_SHAPES, ContactShape


class UnknownRobotError(ValueError):
    """A robot was asked for that no record describes."""


@dataclass(frozen=True)
class HandPrint:
    """Where an object's centre is, seen from the hand's reference point, while a lowered hand would be in it.

    Between the two numbers of a pair, in [m], the hand rises from low (the first) to above the object.

    Attributes:
        left_of_edge: To the left of the little finger's side; what is pressed against it does not count.
        width: To the left, as far as the palm is wide.
        length: Ahead, as far as the fingers are long.
        before_wrist: Behind (negative), as far as the palm is long.
        clear_height: [m], of the reference point, from which on the hand's lowest place is above all objects.
    """

    left_of_edge: tuple[float, float]
    width: tuple[float, float]
    length: tuple[float, float]
    before_wrist: tuple[float, float]
    clear_height: float


@dataclass(frozen=True)
class PlaneMap:
    """How the 2D world is laid on the table: X = scale x, Y = scale y, the higher the more S2 is bent.

    Attributes:
        scale: [m/cm], metres on the table per centimetre in the 2D world.
        hand_height: [m], height of the hand's reference point above the table top while S2 is straight.
        lift: [m], how much higher it is while S2 is bent: above the objects, which a bent S2 passes by.
        lift_range: [deg], beta at which the hand begins to rise, and from which on it is lifted fully.
        rim: [cm], from J1 to where the discs begin: with its end nearer than this S2 meets none of them.
        heading_lead: [rad], how much further to the right than the radial direction from J1 the hand points:
            a pushed object is some degrees ahead of the hand, and is to be pushed along its own arc.
        heading_range: [rad], the hand turns no further than this: beyond, the arm would have to fold behind
            the robot's side.
        hand_edge: [m], how far to the left of the reference point the hand's rightmost places are: an object
            reaches so much further than the disc it plays, and the hand meets it when S2 meets the disc.
        object_radius: [m], of the three objects: `hand_edge` + `scale` * the disc's radius in [cm].
        hand_print: Over what the hand does not come down.

    `lift_range` and `hand_print` were measured with objects of `object_radius` whose discs begin at `rim`;
    the port fits all four to the world of a trial. How wide objects are is a matter of `hand_edge`.
    """

    scale: float
    hand_height: float
    lift: float
    lift_range: tuple[float, float]
    rim: float
    heading_lead: float
    heading_range: tuple[float, float]
    hand_edge: float
    object_radius: float
    hand_print: HandPrint


@dataclass(frozen=True)
class Posture:
    """What the arm prefers among the infinitely many postures that reach one target.

    Attributes:
        rest: [J] in [rad], the posture that is approached.
        weights: [J], cost of the squared distance to `rest` per joint [1/rad^2].
        heading_weight: cost of the squared error of the hand's heading [1/rad^2].
        roll: [rad], wanted turn of the palm about the fingers: the thumb is to be so far above the edge of
            the little finger; at 0 the palm lies flat above the table.
        level_weight: cost of the squared departure from it, and from fingers parallel to the table.
        inertia: cost of the squared change per step [1/rad^2]; below 0.3 the arm oscillates, and the more
            there is, the smaller are its jumps.
    """

    rest: tuple[float, ...]
    weights: tuple[float, ...]
    heading_weight: float
    level_weight: float
    roll: float
    inertia: float


@dataclass(frozen=True)
class Robot:
    """One humanoid: where its description comes from, which joints act, where its hand is.

    Attributes:
        name: What the user types.
        title: What the user reads.
        package: Name of the installed distribution that brings the URDF and the meshes.
        urdf: How the URDF's path ends within that distribution.
        joints: The J joints that act, from the trunk to the hand.
        hand_frame: Link of the URDF with x along the fingers, y to the little finger, z out of the palm.
        hand_offset: [3] in [m], in `hand_frame`: the point that plays S2's end.
        base_position: [3] in [m], where the robot's root stands in the world.
        base_yaw: [rad], turn of the root about the vertical.
        plane: How the 2D world is laid on the table.
        posture: What the arm prefers.
        left_out: Links that are not built in MuJoCo, with all that hangs on them.
        fixed: [rad], the angle at which a joint that does not act is held; 0 if not named.
        appearance: Colours and ornaments.
        presence: What moves besides: neck, eyes, fingers and an arm that rests. Without, the head is still.
        loose: Further joints that are not held at their angle in `fixed`, but belong to nobody.
        limits: What the motors can do; None if nothing is known of it, then there is no physics.
        shapes: What meets the objects.
    """

    name: str
    title: str
    package: str
    urdf: str
    joints: tuple[str, ...]
    hand_frame: str
    hand_offset: tuple[float, float, float]
    base_position: tuple[float, float, float]
    base_yaw: float
    plane: PlaneMap
    posture: Posture
    left_out: tuple[str, ...] = ()
    fixed: Mapping[str, float] = field(default_factory=dict)
    appearance: Appearance = field(default_factory=Appearance)
    presence: Presence | None = None
    loose: tuple[str, ...] = ()
    limits: MotorLimits | None = None
    shapes: tuple[ContactShape, ...] = ()

    def __post_init__(self) -> None:
        """Check that the numbers fit the joints, and freeze the mapping."""
        for name in ("rest", "weights"):
            if len(getattr(self.posture, name)) != len(self.joints):
                raise ValueError(
                    f"robot '{self.name}' has {len(self.joints)} joints, "
                    f"but {len(getattr(self.posture, name))} numbers in posture.{name}; give one per joint"
                )
        object.__setattr__(self, "fixed", MappingProxyType(dict(self.fixed)))

    @property
    def head_joints(self) -> tuple[str, ...]:
        """The H joints that turn its head and eyes; none if nothing is known of them."""
        return () if self.presence is None else self.presence.head_joints

    @property
    def with_head_held(self) -> Robot:
        """The same with a head that is still in physics; a film of it has no fingers either."""
        return replace(self, presence=None)


ICUB = Robot(
    name="icub",
    title="iCub (icub-models, iCubGenova04)",
    package="icub-models",
    urdf="iCubGenova04/model.urdf",
    joints=(
        "torso_pitch",
        "torso_roll",
        "torso_yaw",
        "r_shoulder_pitch",
        "r_shoulder_roll",
        "r_shoulder_yaw",
        "r_elbow",
        "r_wrist_prosup",
        "r_wrist_pitch",
        "r_wrist_yaw",
    ),
    hand_frame="r_hand_dh_frame",
    # Beside the little finger, 20 mm behind its tip: what is pushed may come that much further out before
    # the finger's round end lets it slip. With the roll below, the hand's rightmost places are 8 mm to the
    # left of the point (`hand_edge`). The hand's lowest place is 18 mm below it.
    hand_offset=(0.0684, 0.0260, -0.0271),
    base_position=(-0.0763, -0.3161, 0.1252),
    base_yaw=-pi / 2,  # the iCub of the URDF faces -x
    plane=PlaneMap(
        scale=0.0018,
        hand_height=0.029,
        lift=0.061,
        lift_range=(24.0, 43.0),
        rim=142.7211629518312,
        heading_lead=pi / 30,
        heading_range=(-pi / 6, 17 * pi / 18),
        hand_edge=0.008,
        object_radius=0.017,
        hand_print=HandPrint(
            left_of_edge=(-0.004, 0.008),  # a pushed object is 9 mm to the right
            width=(0.092, 0.066),
            length=(0.068, 0.048),
            before_wrist=(-0.15, -0.12),
            clear_height=0.068,
        ),
    ),
    posture=Posture(
        rest=(-0.121, 0.215, -0.155, -1.667, 1.002, 0.429, 0.946, 0.161, 0.061, 0.009),
        weights=(0.0958, 0.148, 0.0755, 0.00323, 0.102, 0.0264, 0.0953, 0.0835, 0.053, 0.387),
        heading_weight=0.831,
        level_weight=0.588,
        roll=pi / 3,
        inertia=0.7,
    ),
    # Nothing of the legs is seen at the table, and they are half of the triangles to be drawn.
    left_out=("l_hip_1", "r_hip_1"),
    fixed={
        "neck_pitch": 0.35,
        "neck_yaw": -0.35,
        "l_shoulder_pitch": 0.5,
        "l_shoulder_roll": 0.3,
        "l_elbow": 0.9,
    },
    appearance=ICUB_APPEARANCE,
    presence=ICUB_PRESENCE,
    limits=ICUB_LIMITS,
    shapes=ICUB_SHAPES,
)

# An older iCub: the same joints and frames, the arm a centimetre longer, other joint limits, a block as hand.
# Map and posture of the other one serve it as well: docs/port.md has the figures. Links without inertia
# (`models.inertias` names them) keep it from acting with motors.
ICUB_ERD = replace(
    ICUB,
    name="icub-erd",
    title="iCub (example-robot-data)",
    package="example-robot-data",
    urdf="icub_description/robots/icub.urdf",
    plane=replace(ICUB.plane, hand_height=0.038, lift=0.052),  # its block of a hand reaches further down
    appearance=ICUB_ERD_APPEARANCE,
    presence=ICUB_ERD_PRESENCE,
    limits=None,
    shapes=(),
)

# All of them, by name.
ROBOTS: Mapping[str, Robot] = MappingProxyType({robot.name: robot for robot in (ICUB, ICUB_ERD)})


def get_robot(name: str) -> Robot:
    """Give the record of a robot by its name.

    Raises:
        UnknownRobotError: If no robot has this name; the message lists those that exist.
    """
    try:
        return ROBOTS[name]
    except KeyError:
        raise UnknownRobotError(f"unknown robot '{name}'; there are: {', '.join(ROBOTS)}") from None
