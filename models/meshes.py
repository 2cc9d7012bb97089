"""Reading the meshes of a robot, and leaving out what no picture shows.

CAD meshes spend most of their triangles on screws. Software rendering takes its time by the triangle, and
once more for the shadows; thinning them makes a frame more than twice as fast.
"""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

STL_HEADER_BYTES = 80
STL_TRIANGLE = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])


def read_mesh(path: Path) -> tuple[NDArray[np.float64], NDArray[np.int32]]:
    """Give the vertices [V, 3] in the file's unit and the faces [F, 3] of an STL or DAE file.

    Raises:
        ValueError: If an STL file is not binary or is cut short.
    """
    return _read_stl(path) if path.suffix.lower() == ".stl" else _read_other(path)


def thin(
    vertices: NDArray[np.float64], faces: NDArray[np.int32], cell: float
) -> tuple[NDArray[np.float64], NDArray[np.int32]]:
    """Merge all vertices that share a cell of a cubic grid into their mean; faces that vanish are left out.

    Args:
        vertices: [V, 3].
        faces: [F, 3], indices of vertices.
        cell: Edge of a cell, in the unit of the vertices.

    Returns:
        Fewer vertices and faces; no vertex moves by more than a cell's diagonal.
    """
    _, merged, counts = np.unique(
        np.floor(vertices / cell).astype(np.int64), axis=0, return_inverse=True, return_counts=True
    )
    merged = merged.ravel()
    means = np.stack([np.bincount(merged, vertices[:, axis]) for axis in range(3)], axis=-1) / counts[:, None]
    corners = merged[faces]
    flat = (corners == np.roll(corners, 1, axis=1)).any(axis=1)
    corners = corners[~flat]
    # Equal faces once: rotate the smallest index to the front, so that the side that is seen stays.
    first = corners.argmin(axis=1)[:, None]
    turned = np.take_along_axis(corners, (first + np.arange(3)) % 3, axis=1)
    return means, np.unique(turned, axis=0).astype(np.int32)


def thin_to(
    vertices: NDArray[np.float64], faces: NDArray[np.int32], n_faces: int, cells: Iterable[float]
) -> tuple[NDArray[np.float64], NDArray[np.int32]]:
    """Thin a mesh with the first of some growing cells that leaves at most `n_faces`, or with the last."""
    thinned = vertices, faces
    for cell in cells:
        if len(thinned[1]) <= n_faces:
            break
        thinned = thin(vertices, faces, cell)
    return thinned


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
    """Read what MuJoCo cannot, such as DAE."""
    import coal

    mesh = coal.MeshLoader().load(str(path), np.ones(3))
    corners = [mesh.tri_indices(i) for i in range(mesh.num_tris)]
    faces = np.array([[triangle[0], triangle[1], triangle[2]] for triangle in corners], dtype=np.int32)
    return np.array(mesh.vertices()), faces
