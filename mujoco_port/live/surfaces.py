"""Triangles of MuJoCo's shapes: V vertices, F triangles."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Final

import mujoco
import numpy as np
from numpy.typing import NDArray

from arm2d.records import brief

SMALL_M: Final = 0.02  # up to this radius a shape is round with fewer sides
MINUTE_M: Final = 0.012  # the same of a cylinder, whose rim is seen
SIDES, BANDS = (14, 28), (3, 6)  # of what is small, and large: all round; from a ball's rim to its top
PLANE_HALF: Final = 8.0  # [m]; MuJoCo's planes have no end


@dataclass(frozen=True)
class Surface:
    """A surface with normals.

    Attributes:
        places: [V, 3] in [m].
        normals: [V, 3].
        triangles: [F, 3], seen from outside anticlockwise.
    """

    places: NDArray[np.float64]
    normals: NDArray[np.float64]
    triangles: NDArray[np.int64]

    __repr__ = brief

    def moved(self, place: NDArray[np.float64], rotation: NDArray[np.float64]) -> Surface:
        """The same turned, then put to a place."""
        return Surface(self.places @ rotation.T + place, self.normals @ rotation.T, self.triangles)

    @staticmethod
    def joined(surfaces: Sequence[Surface]) -> Surface:
        """Several as one."""
        offsets = np.cumsum([0, *(len(each.places) for each in surfaces)])
        triangles = [each.triangles + offset for each, offset in zip(surfaces, offsets, strict=False)]
        return Surface(
            np.concatenate([each.places for each in surfaces]),
            np.concatenate([each.normals for each in surfaces]),
            np.concatenate(triangles),
        )


def surface_of(model: mujoco.MjModel, geom: int) -> Surface:
    """The surface of a geom in its own frame.

    Raises:
        ValueError: If its shape is none that our scene has.
    """
    kind = int(model.geom_type[geom])
    if kind == mujoco.mjtGeom.mjGEOM_MESH:
        return mesh(model, int(model.geom_dataid[geom]))
    if kind not in SHAPES:
        raise ValueError(f"geom {geom} has the shape {mujoco.mjtGeom(kind).name}, which is not drawn")
    return SHAPES[kind](np.array(model.geom_size[geom]))


def mesh(model: mujoco.MjModel, number: int) -> Surface:
    """A mesh of the model; a vertex with several normals becomes several."""
    faces = slice(model.mesh_faceadr[number], model.mesh_faceadr[number] + model.mesh_facenum[number])
    corners = np.stack([model.mesh_face[faces], model.mesh_facenormal[faces]], axis=-1).reshape(-1, 2)
    pairs, indices = np.unique(corners, axis=0, return_inverse=True)
    places = model.mesh_vert[model.mesh_vertadr[number] + pairs[:, 0]]
    normals = model.mesh_normal[model.mesh_normaladr[number] + pairs[:, 1]]
    return Surface(places.astype(float), normals.astype(float), indices.reshape(-1, 3))


def roundness(radius: float) -> tuple[int, int]:
    """Sides and bands of what has this radius [m]."""
    large = int(radius > SMALL_M)
    return SIDES[large], BANDS[large]


def turned(profile: NDArray[np.float64], normals: NDArray[np.float64], sides: int) -> Surface:
    """A profile [P, 2] (radius, height), from above to below, turned about z."""
    angles = 2 * np.pi * np.arange(sides + 1) / sides
    round_ = np.stack([np.cos(angles), np.sin(angles)], axis=-1)  # [S, 2]

    def all_round(rows: NDArray[np.float64]) -> NDArray[np.float64]:
        flat = rows[:, None, :1] * round_[None]
        heights = np.broadcast_to(rows[:, None, 1:], (*flat.shape[:2], 1))
        return np.concatenate([flat, heights], axis=-1).reshape(-1, 3)

    row, column = np.meshgrid(np.arange(len(profile) - 1), np.arange(sides), indexing="ij")
    a = (row * (sides + 1) + column).ravel()
    b = a + sides + 1
    triangles = np.concatenate([np.stack([a, b, a + 1], -1), np.stack([a + 1, b, b + 1], -1)])
    return Surface(all_round(profile), all_round(normals), triangles)


def ball(radius: float, half_length: float = 0.0) -> Surface:
    """A ball, or a capsule along z."""
    sides, bands = roundness(radius)
    angles = np.linspace(0.0, np.pi, 2 * bands + 2)
    normals = np.stack([np.sin(angles), np.cos(angles)], axis=-1)
    profile = radius * normals
    profile[:, 1] += np.where(np.arange(len(angles)) <= bands, half_length, -half_length)
    return turned(profile, normals, sides)


def ellipsoid(size: NDArray[np.float64]) -> Surface:
    """A stretched ball."""
    unit = ball(1.0)
    normals = unit.normals / size
    return Surface(
        unit.places * size, normals / np.linalg.norm(normals, axis=1, keepdims=True), unit.triangles
    )


def cylinder(radius: float, half_length: float) -> Surface:
    """A cylinder along z, its rims a little rounded so that they catch the light."""
    rim = min(0.12 * radius, half_length)
    inner = radius - rim
    profile = [(0, half_length), (inner, half_length), (inner, half_length), (radius, half_length - rim)]
    up, out = (0.0, 1.0), (1.0, 0.0)
    slope = (np.sqrt(0.5), np.sqrt(0.5))
    half = np.array([*profile, (radius, half_length - rim)])
    upper = np.array([up, up, slope, slope, out])
    mirror = np.array([1.0, -1.0])
    return turned(
        np.concatenate([half, half[::-1] * mirror]),
        np.concatenate([upper, upper[::-1] * mirror]),
        SIDES[1] if radius > MINUTE_M else SIDES[0],
    )


def box(size: NDArray[np.float64]) -> Surface:
    """A box of half the edges `size`."""
    faces = []
    for axis in range(3):
        for sign in (1.0, -1.0):
            normal, first = sign * np.eye(3)[axis], np.eye(3)[(axis + 1) % 3]
            second = np.cross(normal, first)
            corners = [normal - first - second, normal + first - second]
            corners += [normal + first + second, normal - first + second]
            faces.append(_quad(np.array(corners) * size, normal))
    return Surface.joined(faces)


def plane(_: NDArray[np.float64]) -> Surface:
    """A part of a plane that is large enough."""
    corners = np.array([(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)], float)
    return _quad(PLANE_HALF * corners, np.array([0.0, 0.0, 1.0]))


def _quad(corners: NDArray[np.float64], normal: NDArray[np.float64]) -> Surface:
    """Four corners, anticlockwise."""
    return Surface(corners, np.tile(normal, (4, 1)), np.array([(0, 1, 2), (0, 2, 3)]))


SHAPES: Final[Mapping[int, Callable[[NDArray[np.float64]], Surface]]] = {
    int(mujoco.mjtGeom.mjGEOM_PLANE): plane,
    int(mujoco.mjtGeom.mjGEOM_SPHERE): lambda size: ball(size[0]),
    int(mujoco.mjtGeom.mjGEOM_CAPSULE): lambda size: ball(size[0], size[1]),
    int(mujoco.mjtGeom.mjGEOM_ELLIPSOID): ellipsoid,
    int(mujoco.mjtGeom.mjGEOM_CYLINDER): lambda size: cylinder(size[0], size[1]),
    int(mujoco.mjtGeom.mjGEOM_BOX): box,
}
