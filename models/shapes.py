"""The shapes with which a robot meets objects: its meshes are only looked at.

Boxes and capsules, fitted by eye to the meshes, for a mesh in contact would be replaced by its convex hull,
and the hull of a hand has thumb and fingers webbed together.
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class ContactShape:
    """One capsule or box that moves with a link.

    Attributes:
        name: What it stands for.
        link: The link whose frame the places are given in.
        start: [3] in [m], one end of a capsule, or the centre of a box.
        end: [3] in [m], the other end of a capsule, or half the edges of a box.
        radius: [m], of a capsule; None for a box.
    """

    name: str
    link: str
    start: tuple[float, float, float]
    end: tuple[float, float, float]
    radius: float | None = None


# r_hand_dh_frame has x along the fingers, y to the little finger, z out of the palm.
ICUB_SHAPES = (
    ContactShape(
        "little_finger", "r_hand_dh_frame", (-0.030, 0.0225, -0.010), (0.078, 0.0225, -0.010), 0.0105
    ),
    ContactShape("ring_finger", "r_hand_dh_frame", (0.0, 0.005, -0.010), (0.085, 0.005, -0.010), 0.0095),
    ContactShape("middle_finger", "r_hand_dh_frame", (0.0, -0.010, -0.010), (0.088, -0.010, -0.010), 0.0095),
    ContactShape("index_finger", "r_hand_dh_frame", (0.0, -0.024, -0.010), (0.078, -0.024, -0.010), 0.0095),
    ContactShape("palm", "r_hand_dh_frame", (-0.008, 0.0, -0.013), (0.033, 0.029, 0.022)),
    ContactShape("thumb", "r_hand_dh_frame", (0.0, -0.030, 0.003), (0.020, -0.087, 0.004), 0.0085),
    ContactShape("forearm", "r_forearm", (-0.0747, 0.0, 0.0172), (-0.0083, 0.0, -0.0052), 0.038),
)
