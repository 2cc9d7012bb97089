"""Thinning the meshes that are only looked at."""

import numpy as np
import pytest

from models.meshes import read_mesh, standing, thin


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
    fewer_vertices, fewer_faces = thin(vertices, faces, 200)
    assert len(fewer_faces) <= 202
    assert np.abs(fewer_vertices[:, 2]).max() < 1e-6
    assert area(fewer_vertices, fewer_faces) == pytest.approx(1.0, abs=0.02)


def test_thin_ball_stays_round_and_keeps_its_outside():
    turn, tilt = np.meshgrid(np.linspace(0, 2 * np.pi, 81)[:-1], np.linspace(0.05, np.pi - 0.05, 60))
    points = np.stack([np.sin(tilt) * np.cos(turn), np.sin(tilt) * np.sin(turn), np.cos(tilt)], axis=-1)
    k = np.arange(59 * 80)
    right = k - k % 80 + (k + 1) % 80
    faces = np.concatenate([np.stack(c, axis=-1) for c in ((k, k + 80, right), (right, k + 80, right + 80))])
    vertices, few = thin(points.reshape(-1, 3), faces.astype(np.int32), 600)
    assert len(few) <= 602
    np.testing.assert_allclose(np.linalg.norm(vertices, axis=1), 1.0, atol=0.03)
    a, b, c = (vertices[few[:, corner]] for corner in range(3))
    assert (np.einsum("ij,ij->i", np.cross(b - a, c - a), a + b + c) > 0).mean() > 0.99


def test_mesh_of_few_faces_is_left_as_it_is():
    vertices, faces = sheet(5)
    same_vertices, same_faces = thin(vertices, faces, len(faces))
    assert same_vertices is vertices
    assert same_faces is faces


def test_stl_that_is_cut_short_is_refused(tmp_path):
    path = tmp_path / "cut.stl"
    path.write_bytes(bytes(80) + (7).to_bytes(4, "little") + bytes(50))
    with pytest.raises(ValueError, match=r"cut\.stl is not a whole binary STL file; install its"):
        read_mesh(path)


DAE = """<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><up_axis>{up}</up_axis></asset>
<library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="a" count="24">{places}</float_array><technique_common>
<accessor source="#a" count="8" stride="3"><param name="X" type="float"/><param name="Y" type="float"/>
<param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles material="first" count="2"><input semantic="VERTEX" source="#v" offset="0"/>
<p>0 1 2 0 2 3</p></triangles>
<polylist material="second" count="1"><input semantic="VERTEX" source="#v" offset="0"/>
<vcount>4</vcount><p>4 5 6 7</p></polylist>
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node><instance_geometry url="#g"/></node></visual_scene>
</library_visual_scenes><scene><instance_visual_scene url="#s"/></scene></COLLADA>"""
SQUARES = "0 0 0 1 0 0 1 1 0 0 1 0   0 0 5 3 0 5 3 3 5 0 3 5"  # of edge 1, and above it of edge 3


def dae(folder, up="Z_UP"):
    path = folder / "squares.dae"
    path.write_text(DAE.format(up=up, places=SQUARES))
    return path


def test_parts_of_a_dae_file_keep_their_own_vertices(tmp_path):
    vertices, faces = read_mesh(dae(tmp_path))
    heights = vertices[faces][..., 2]
    assert sorted(heights.mean(axis=1)) == pytest.approx([0, 0, 5, 5])
    assert np.ptp(heights, axis=1).max() == 0.0  # no face leads from one square to the other
    assert area(vertices, faces) == pytest.approx(1 + 9)


def test_a_file_with_y_up_is_turned_so_that_z_is_up(tmp_path):
    vertices = np.array([[1.0, 2.0, 3.0]])
    np.testing.assert_array_equal(standing(dae(tmp_path, "Y_UP"), vertices), [[1.0, -3.0, 2.0]])
    np.testing.assert_array_equal(standing(dae(tmp_path, "Z_UP"), vertices), vertices)
