"""Thinning the meshes that are only looked at."""

import numpy as np
import pytest

from models.meshes import read_mesh, thin, thin_to


def sheet(n):
    """A flat square sheet of edge 1, n by n cells of two triangles each."""
    x, y = np.meshgrid(np.linspace(0, 1, n + 1), np.linspace(0, 1, n + 1), indexing="ij")
    vertices = np.stack([x.ravel(), y.ravel(), np.zeros(x.size)], axis=-1)
    corner = (np.arange(n)[:, None] * (n + 1) + np.arange(n)).ravel()
    faces = np.concatenate(
        [
            np.stack([corner, corner + n + 1, corner + 1], axis=-1),
            np.stack([corner + 1, corner + n + 1, corner + n + 2], axis=-1),
        ]
    )
    return vertices, faces.astype(np.int32)


def area(vertices, faces):
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    return np.cross(b - a, c - a)[:, 2].sum() / 2


def test_thin_sheet_keeps_its_shape_with_fewer_faces():
    vertices, faces = sheet(40)
    fewer_vertices, fewer_faces = thin(vertices, faces, 0.1)
    assert len(fewer_faces) < len(faces) / 5
    assert np.abs(fewer_vertices[:, 2]).max() == 0.0
    # The outermost vertices move inwards by at most half a cell on each side.
    assert 0.8 < area(fewer_vertices, fewer_faces) <= area(vertices, faces)


def test_cells_smaller_than_every_edge_change_nothing():
    vertices, faces = sheet(5)
    same_vertices, same_faces = thin(vertices, faces, 1e-3)
    assert len(same_vertices) == len(vertices)
    assert area(same_vertices, same_faces) == pytest.approx(1.0)


def test_first_cell_that_suffices_is_taken():
    vertices, faces = sheet(40)
    assert len(thin_to(vertices, faces, len(faces), [0.5])[1]) == len(faces)
    expected = thin(vertices, faces, 0.1)[1]
    np.testing.assert_array_equal(thin_to(vertices, faces, len(expected), [0.04, 0.1, 0.5])[1], expected)


def test_stl_that_is_cut_short_is_refused(tmp_path):
    path = tmp_path / "cut.stl"
    path.write_bytes(bytes(80) + (7).to_bytes(4, "little") + bytes(50))
    with pytest.raises(ValueError, match=r"cut\.stl is not a whole binary STL file; install its"):
        read_mesh(path)
