"""How far a robot stays from the table and from itself, by the geometry of its MuJoCo model.

MuJoCo measures between the convex hulls of the shown meshes, so a gap it tells is there in full. A shoulder
lies in a hollow of the chest, though: where hulls come near, the meshes themselves are asked, with coal.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import product
from typing import Final

import coal
import mujoco
import numpy as np
from numpy.typing import NDArray

from models.build import ROBOT_PREFIX, build_model
from models.robots import Robot

TABLE: Final = "table"
# Pairs of links that are not asked about. With fewer joints between them their hulls overlap whatever the
# posture; and links that are hardly apart in most postures are parts of one joint, as the shoulder's ball and
# the hollow of the chest it lies in. It is the joints' limits that keep both kinds apart.
JOINTS_BETWEEN: Final = 3
HARDLY_APART: Final = 0.005  # [m], median over postures; meshes are thinned to some 2 mm
N_POSTURES: Final = 41  # random ones within the joint limits
NEAR: Final = 0.005  # [m], between hulls; then meshes are asked
FARTHEST: Final = 0.25  # [m]; more than this is told as this, which saves most of the work


class Clearance:
    """The gaps between a robot's links and the table, and between its links, in any posture."""

    def __init__(self, robot: Robot) -> None:
        self._meshes: dict[int, coal.BVHModelOBBRSS] = {}
        self._model = model = build_model(robot)
        self._data = mujoco.MjData(model)
        self._addresses = [model.joint(ROBOT_PREFIX + name).qposadr[0] for name in robot.joints]
        links = [body for body in range(model.nbody) if model.body(body).name.startswith(ROBOT_PREFIX)]
        self._root = links[0]
        table = _geoms(model, model.body(TABLE).id)
        self._to_table = [pair for link in links for pair in product(_geoms(model, link), table)]
        self._to_itself = [
            pair
            for nth, one in enumerate(links)
            for other in links[:nth]
            if _joints_between(model, one, other) >= JOINTS_BETWEEN
            for pair in product(_meshes(model, one), _meshes(model, other))
        ]
        self._to_itself = self._usually_apart(self._to_itself, robot)

    def stand(self, position: Sequence[float]) -> None:
        """Put the robot's root at a position [3] in [m] in the world."""
        self._model.body_pos[self._root] = position

    def measure(self, angles: NDArray[np.float64]) -> tuple[float, float]:
        """Give the least gaps [m] for joint angles [J] in [rad]: to the table, and between links.

        A negative gap tells of an overlap; it is the depth of the hulls in each other.
        """
        self._place(angles)
        return self._least(self._to_table)[0], self._least(self._to_itself)[0]

    def nearest(self, angles: NDArray[np.float64]) -> tuple[str, str]:
        """Name the link nearest to the table, and the two that are nearest to each other, as 'a-b'."""
        self.measure(angles)
        to_table, to_itself = self._least(self._to_table)[1], self._least(self._to_itself)[1]
        return self._link(to_table[0]), f"{self._link(to_itself[0])}-{self._link(to_itself[1])}"

    def _usually_apart(self, pairs: list[tuple[int, int]], robot: Robot) -> list[tuple[int, int]]:
        """Those pairs that are not parts of one joint."""
        ranges = np.array([self._model.joint(ROBOT_PREFIX + name).range for name in robot.joints])
        gaps = []
        for angles in np.random.default_rng(0).uniform(ranges[:, 0], ranges[:, 1], (N_POSTURES, len(ranges))):
            self._place(angles)
            gaps.append([self._gap(pair, FARTHEST) for pair in pairs])
        apart = np.median(gaps, axis=0) > HARDLY_APART
        return [pair for pair, kept in zip(pairs, apart, strict=True) if kept]

    def _place(self, angles: NDArray[np.float64]) -> None:
        self._data.qpos[self._addresses] = angles
        mujoco.mj_kinematics(self._model, self._data)

    def _least(self, pairs: list[tuple[int, int]]) -> tuple[float, tuple[int, int]]:
        """The least gap of all pairs of geoms, and which pair it is."""
        least, nearest = FARTHEST, pairs[0]
        for pair in pairs:
            gap = self._gap(pair, least)
            if gap < least:
                least, nearest = gap, pair
        return least, nearest

    def _gap(self, pair: tuple[int, int], limit: float) -> float:
        """The gap [m] of two geoms, exact below `limit`; if they meet, minus the overlap of their hulls."""
        gap = mujoco.mj_geomDistance(self._model, self._data, *pair, limit, None)
        if gap < NEAR and all(self._model.geom_dataid[geom] >= 0 for geom in pair):
            gap = self._gap_of_meshes(*pair) or min(gap, 0.0)
        return gap

    def _gap_of_meshes(self, one: int, other: int) -> float:
        """The gap [m] between the surfaces of two meshes; 0 if they meet."""
        meshes = [self._mesh(geom) for geom in (one, other)]
        places = [
            coal.Transform3s(
                self._data.geom_xmat[geom].reshape(3, 3).copy(), self._data.geom_xpos[geom].copy()
            )
            for geom in (one, other)
        ]
        request, result = coal.DistanceRequest(), coal.DistanceResult()
        gap = coal.distance(meshes[0], places[0], meshes[1], places[1], request, result)
        return max(float(gap), 0.0)

    def _mesh(self, geom: int) -> coal.BVHModelOBBRSS:
        """A geom's mesh as coal has it; made when first asked for."""
        if geom not in self._meshes:
            model, mesh = self._model, self._model.geom_dataid[geom]
            corners, faces = coal.StdVec_Vec3s(), coal.StdVec_Triangle()
            first, first_face = model.mesh_vertadr[mesh], model.mesh_faceadr[mesh]
            for corner in model.mesh_vert[first : first + model.mesh_vertnum[mesh]].astype(float):
                corners.append(corner)
            for face in model.mesh_face[first_face : first_face + model.mesh_facenum[mesh]].tolist():
                faces.append(coal.Triangle(*face))
            made = coal.BVHModelOBBRSS()
            made.beginModel(len(faces), len(corners))
            made.addSubModel(corners, faces)
            made.endModel()
            self._meshes[geom] = made
        return self._meshes[geom]

    def _link(self, geom: int) -> str:
        return self._model.body(self._model.geom_bodyid[geom]).name.removeprefix(ROBOT_PREFIX)


def _geoms(model: mujoco.MjModel, body: int) -> list[int]:
    first = model.body_geomadr[body]
    return [*range(first, first + model.body_geomnum[body])]


def _meshes(model: mujoco.MjModel, body: int) -> list[int]:
    """A link's meshes; ornaments lie within them."""
    return [geom for geom in _geoms(model, body) if model.geom_type[geom] == mujoco.mjtGeom.mjGEOM_MESH]


def _joints_between(model: mujoco.MjModel, one: int, other: int) -> int:
    """How many joints can move two links of a robot against each other."""
    chains = []
    for body in (one, other):
        chain = set()
        while body > 0:
            chain.update(range(model.body_jntadr[body], model.body_jntadr[body] + model.body_jntnum[body]))
            body = model.body_parentid[body]
        chains.append(chain)
    return len(chains[0] ^ chains[1])
