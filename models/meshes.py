"""Reading the meshes of a robot, and leaving out what no picture shows.

CAD meshes spend most of their triangles on screws. Software rendering takes its time by the triangle, three
times over where there are shadows.
"""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

STL_HEADER_BYTES = 80
# A part of a DAE file: triangles, or polygons whose numbers of corners follow.
PART = re.compile(rb'<triangles[^>]* count="(\d+)"|<vcount>([\d\s]*)<')
STL_TRIANGLE = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])


def read_mesh(path: Path) -> tuple[NDArray[np.float64], NDArray[np.int32]]:
    """Give the vertices [V, 3] in the file's unit and the faces [F, 3] of an STL or DAE file.

    Raises:
        ValueError: If an STL file is not binary or is cut short.
    """
    return _read_stl(path) if path.suffix.lower() == ".stl" else _read_other(path)


def standing(path: Path, vertices: NDArray[np.float64]) -> NDArray[np.float64]:
    """Turn the vertices [V, 3] of a file that says its y is up so that z is up, as a URDF takes it to be.

    Simulators for ROS read DAE files so, and URDFs were made with them.
    """
    if path.suffix.lower() != ".dae" or b"<up_axis>Y_UP" not in path.read_bytes():
        return vertices
    return np.stack([vertices[:, 0], -vertices[:, 2], vertices[:, 1]], axis=-1)


def thin(
    vertices: NDArray[np.float64], faces: NDArray[np.int32], n_faces: int
) -> tuple[NDArray[np.float64], NDArray[np.int32]]:
    """Thin a mesh to about `n_faces` faces by collapsing the edges whose loss changes its shape least.

    Quadric error metrics (Garland and Heckbert, SIGGRAPH 1997), as in the package fast-simplification.

    Args:
        vertices: [V, 3].
        faces: [F, 3], indices of vertices.
        n_faces: How many may stay; a mesh that has no more is given back as it is.
    """
    if len(faces) <= n_faces:
        return vertices, faces
    import fast_simplification

    reduction = 1.0 - n_faces / len(faces)
    few, corners = fast_simplification.simplify(vertices, faces, target_reduction=reduction)[:2]
    return few.astype(np.float64), corners.astype(np.int32)


def _read_stl(path: Path) -> tuple[NDArray[np.float64], NDArray[np.int32]]:
    """Read a binary STL; equal corners become one vertex."""
    raw = path.read_bytes()
    n_faces = int.from_bytes(raw[STL_HEADER_BYTES : STL_HEADER_BYTES + 4], "little")
    if len(raw) < STL_HEADER_BYTES + 4 + n_faces * STL_TRIANGLE.itemsize:
        raise ValueError(f"{path} is not a whole binary STL file; install its package again")
    triangles = np.frombuffer(raw, STL_TRIANGLE, n_faces, STL_HEADER_BYTES + 4)
    vertices, faces = np.unique(triangles["corners"].reshape(-1, 3), axis=0, return_inverse=True)
    return vertices.astype(np.float64), faces.reshape(-1, 3).astype(np.int32)


def _read_other(path: Path) -> tuple[NDArray[np.float64], NDArray[np.int32]]:
    """Read what MuJoCo cannot, such as DAE; equal corners become one vertex."""
    import coal

    mesh = coal.MeshLoader().load(str(path), np.ones(3))
    corners = [mesh.tri_indices(i) for i in range(mesh.num_tris)]
    faces = np.array([[triangle[0], triangle[1], triangle[2]] for triangle in corners])
    faces = _apart(path, faces, mesh.num_vertices)
    vertices, merged = np.unique(np.array(mesh.vertices()), axis=0, return_inverse=True)
    return vertices, merged.ravel()[faces].astype(np.int32)


def _apart(path: Path, faces: NDArray[np.int64], n_vertices: int) -> NDArray[np.int64]:
    """Let the parts of a DAE file, one for each material, index vertices of their own.

    Coal joins the vertices of all parts, but lets the faces of a node's parts all count from the same vertex.
    """
    counts = [
        int(triangles) if triangles else sum(int(corners) - 2 for corners in polygons.split())
        for triangles, polygons in PART.findall(path.read_bytes())
    ]
    if len(counts) < 2 or sum(counts) != len(faces):
        return faces
    parts = np.split(faces, np.cumsum(counts)[:-1])
    sizes = [int(np.ptp(part)) + 1 for part in parts]
    if sum(sizes) != n_vertices:  # vertices without a face: where a part starts is unknown
        return faces
    starts = np.cumsum([0, *sizes[:-1]])
    return np.concatenate([part - part.min() + start for part, start in zip(parts, starts, strict=True)])
