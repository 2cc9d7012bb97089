"""Geometry in plain Python: what it gives all around the arm, against vectors and the kernel's arithmetic."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from arm2d.arithmetic import bearing
from arm2d.geometry import (
    bearing_of,
    camera_offsets,
    camera_position,
    distance_from_end,
    from_s2,
    in_view,
    offset_from_end,
    offset_of,
    s2_pose,
    to_s2,
)
from arm2d.readings import PLAIN

ANGLES, BENDS = st.floats(-30, 210), st.floats(0, 90)
DIRECTIONS, DISTANCES = st.floats(-89.9, 269.9), st.floats(1, 500)


def point(direction, distance):
    return distance * np.cos(np.radians(direction)), distance * np.sin(np.radians(direction))


@given(DIRECTIONS, DISTANCES)
def test_a_bearing_is_the_direction_from_minus_90_up_to_270_degrees(direction, distance):
    centre = point(direction, distance)
    assert bearing_of(centre) == pytest.approx(direction, abs=1e-9)
    assert bearing_of(centre) == pytest.approx(bearing(*centre), abs=1e-9)


@given(ANGLES, BENDS)
def test_s2_begins_at_the_end_of_s1_and_leads_along_alpha_plus_beta(alpha, beta):
    x, y, along_x, along_y = s2_pose(alpha, beta)
    np.testing.assert_allclose((x, y), point(alpha, 100.0), atol=1e-9)
    np.testing.assert_allclose((along_x, along_y), point(alpha + beta, 1.0), atol=1e-12)


@given(ANGLES, BENDS, st.floats(-60, 60), st.floats(-60, 60))
def test_what_is_to_the_left_of_s2_has_a_positive_v(alpha, beta, u, v):
    pose = s2_pose(alpha, beta)
    heading = alpha + beta
    there = np.add(pose[:2], np.add(point(heading, u), point(heading + 90.0, v)))
    np.testing.assert_allclose(from_s2(pose, u, v), there, atol=1e-9)
    np.testing.assert_allclose(to_s2(pose, tuple(there)), (u, v), atol=1e-9)


@given(ANGLES, DIRECTIONS, DISTANCES)
def test_d_is_the_smaller_angle_between_s1_and_a_bearing(alpha, direction, distance):
    cosine = np.dot(point(alpha, 1.0), point(direction, 1.0))
    asked = np.degrees(np.arccos(np.clip(cosine, -1.0, 1.0)))
    assert offset_of(alpha, point(direction, distance)) == pytest.approx(asked, abs=1e-5)


@given(ANGLES, st.floats(-179.9, 179.9), DISTANCES)
def test_an_offset_seen_from_the_end_of_s1_is_positive_to_the_left(alpha, offset, distance):
    joint = np.array(point(alpha, 100.0))
    centre = joint + point(alpha + offset, distance)
    end, first = replace(PLAIN, camera_origin="end"), PLAIN
    assert offset_from_end(alpha, tuple(centre)) == pytest.approx(offset, abs=1e-6)
    assert distance_from_end(alpha, tuple(centre)) == pytest.approx(distance, abs=1e-9)
    np.testing.assert_allclose(camera_offsets(np.array(alpha), centre, end), offset, atol=1e-6)
    assert in_view(np.array(alpha), centre, end) == (abs(offset) <= 15.0) or abs(abs(offset) - 15) < 1e-6
    np.testing.assert_allclose(camera_position(alpha, end), joint, atol=1e-9)
    np.testing.assert_array_equal(camera_position(alpha, first), 0.0)


@given(ANGLES, st.floats(-179.9, 179.9))
def test_an_offset_seen_from_j1_does_not_depend_on_the_distance(alpha, offset):
    centres = np.array([point(alpha + offset, distance) for distance in (3.0, 150.0)])
    np.testing.assert_allclose(camera_offsets(np.full(2, alpha), centres, PLAIN), offset, atol=1e-9)
