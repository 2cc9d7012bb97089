"""What a robot looks like beyond its URDF: covers, a smoother head, eyes and a face.

Ornaments are shapes without mass and without contact. Colours are RGB in [0, 1].
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from itertools import pairwise
from types import MappingProxyType


@dataclass(frozen=True)
class Ornament:
    """One shape without mass, fixed to a link.

    Attributes:
        link: The link it moves with.
        shape: "sphere", "capsule", "cylinder" or "ellipsoid".
        size: [3] in [m], as MuJoCo reads it for this shape.
        position: [3] in [m], in the link's frame.
        material: Name of a material of `scene.xml`.
        to: [3] in [m], the other end of a capsule or cylinder.
    """

    link: str
    shape: str
    size: tuple[float, ...]
    position: tuple[float, float, float]
    material: str
    to: tuple[float, float, float] | None = None


@dataclass(frozen=True)
class MeshSwap:
    """A mesh of the same package that shows a link better than the URDF's own.

    Attributes:
        link: The link whose frame the mesh is given in.
        replaces: The link whose own mesh is left out.
        file: Path below the package's share folder.
        scale: [3], metres per unit of the file; a negative number mirrors.
        position: [3] in [m], in the frame of `link`.
        material: Name of a material of `scene.xml`.
    """

    link: str
    replaces: str
    file: str
    scale: tuple[float, float, float]
    position: tuple[float, float, float]
    material: str


@dataclass(frozen=True)
class Appearance:
    """Materials by link, meshes to show instead, and ornaments.

    Attributes:
        materials: Link name -> material of `scene.xml`.
        otherwise: Material of all other links.
        swaps: Meshes shown instead of the URDF's.
        ornaments: Shapes to add.
        detail: How many triangles are kept, as a multiple of what does for meshes of smooth covers.
        bare: Links without any mesh.
    """

    materials: Mapping[str, str] = field(default_factory=dict)
    otherwise: str = "shell"
    swaps: tuple[MeshSwap, ...] = ()
    ornaments: tuple[Ornament, ...] = ()
    detail: float = 1.0
    bare: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        """Freeze the mapping."""
        object.__setattr__(self, "materials", MappingProxyType(dict(self.materials)))


EYE_RADIUS = 0.024  # [m]
# What lies on the eyeball: material, radius, and where its flat front is along the gaze, from the centre [m].
EYE_DISCS = (("iris", 0.0108, 0.0242), ("pupil", 0.0064, 0.0245))


def eyeball(
    link: str, centre: tuple[float, float, float], gaze: tuple[float, float, float]
) -> tuple[Ornament, ...]:
    """Make an eyeball with iris and pupil, flat discs in front of it like a cornea.

    Args:
        link: The head, or a body that turns in it.
        centre: [3] in [m], centre of the eyeball.
        gaze: [3], unit vector the eye looks along.
    """

    def ahead(distance: float) -> tuple[float, float, float]:
        return (
            centre[0] + distance * gaze[0],
            centre[1] + distance * gaze[1],
            centre[2] + distance * gaze[2],
        )

    discs = (
        Ornament(link, "cylinder", (radius,), centre, material, to=ahead(front))
        for material, radius, front in EYE_DISCS
    )
    return (Ornament(link, "sphere", (EYE_RADIUS,), centre, "eye"), *discs)


def line(
    link: str, points: tuple[tuple[float, float, float], ...], radius: float, material: str
) -> tuple[Ornament, ...]:
    """Make a rounded line through points [3] in [m] of a link, such as a mouth."""
    return tuple(
        Ornament(link, "capsule", (radius,), start, material, to=end) for start, end in pairwise(points)
    )


ICUB_COVERS = (
    "chest",
    *(f"{side}_{link}" for side in "lr" for link in ("upper_arm", "elbow_1", "forearm")),
)
# Where the robot has lines of red lamps; the points lie on the surface of the head's mesh [m].
BROW = ((0.020, 0.1425, 0.0787), (0.033, 0.1430, 0.0742), (0.046, 0.1375, 0.0687))
MOUTH = (
    (-0.022, 0.0515, 0.0780),
    (-0.012, 0.0475, 0.0792),
    (0.0, 0.0460, 0.0812),
    (0.012, 0.0475, 0.0792),
    (0.022, 0.0515, 0.0780),
)
LAMP_RADIUS = 0.0020  # [m]

# Without legs, the robot stands on a column.
COLUMN = (
    Ornament("root_link", "cylinder", (0.045,), (0.0, 0.0, -0.02), "leg", to=(0.0, 0.0, -0.89)),
    Ornament("root_link", "cylinder", (0.16,), (0.0, 0.0, -0.877), "leg", to=(0.0, 0.0, -0.8945)),
)

ICUB_APPEARANCE = Appearance(
    materials={**dict.fromkeys(ICUB_COVERS, "cover"), "head": "shell", "l_hand": "shell", "r_hand": "shell"},
    otherwise="metal",
    swaps=(
        MeshSwap(
            "head",
            "head",
            "iCub/meshes/dae/head.dae",
            (0.001, 0.001, 0.001),
            (0.0, -0.067153, -0.0295008),
            "shell",
        ),
    ),
    ornaments=(
        *COLUMN,
        *line("head", MOUTH, LAMP_RADIUS, "lamp"),
        *line("head", BROW, LAMP_RADIUS, "lamp"),
        *line("head", tuple((-x, y, z) for x, y, z in BROW), LAMP_RADIUS, "lamp"),
    ),
)

# The hand of this iCub is a block, its mesh the one that is not given with y up as the others are. Fingers
# are drawn where the other iCub has them: one sees what the hand's point belongs to.
ERD_HANDS = tuple(
    MeshSwap(
        f"{side}_hand",
        f"{side}_hand",
        f"example-robot-data/robots/icub_description/meshes/upmc/visual/icub_{side}_hand.dae",
        (-1.0, -1.0, 1.0) if side == "r" else (1.0, 1.0, 1.0),
        (0.0, 0.0204334, 0.000144),
        "shell",
    )
    for side in "lr"
)
ERD_FINGERS = tuple(
    Ornament("r_hand_dh_frame", "capsule", (radius,), start, "shell", to=end)
    for start, end, radius in (
        ((-0.010, 0.0225, -0.010), (0.078, 0.0225, -0.010), 0.0105),
        ((-0.010, 0.005, -0.010), (0.085, 0.005, -0.010), 0.0095),
        ((-0.010, -0.010, -0.010), (0.088, -0.010, -0.010), 0.0095),
        ((-0.010, -0.024, -0.010), (0.078, -0.024, -0.010), 0.0095),
        ((-0.020, -0.020, 0.003), (0.010, -0.070, 0.004), 0.0085),
    )
)

ICUB_ERD_APPEARANCE = Appearance(
    materials={**dict.fromkeys(ICUB_COVERS, "cover"), "head": "shell"},
    otherwise="metal",
    swaps=ERD_HANDS,
    detail=8.0,  # screws and all, in many small parts
    # This head's mesh has eyeballs, but one material for all: ours lie on them.
    ornaments=(
        *COLUMN,
        *ERD_FINGERS,
    ),
)
