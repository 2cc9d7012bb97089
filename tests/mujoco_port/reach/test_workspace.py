"""The planar map: where the hand has to be, and how high."""

import numpy as np
import pytest

from arm2d.readings import PLAIN
from models.build import build_model
from mujoco_port.reach.workspace import (
    beta_of,
    for_world,
    hand_headings,
    hand_height,
    hand_targets,
    tip_in_plane,
)


@pytest.fixture(scope="module")
def beta():
    return np.linspace(0.0, 90.0, 901)


def test_hand_is_low_while_s2_is_straight_and_lifted_while_it_is_bent(robot):
    plane = robot.plane
    first, last = plane.lift_range
    assert hand_height(plane, 0.0) == hand_height(plane, first) == plane.hand_height
    assert hand_height(plane, last) == hand_height(plane, 90.0) == plane.hand_height + plane.lift


def test_a_record_is_laid_for_the_plain_world(robot):
    """To the bit: its rim and objects are those of discs of 5 cm in sectors of 10 degrees to either side."""
    assert for_world(robot, PLAIN) == robot


@pytest.mark.parametrize(
    "world", [{"object_radius": 8.0}, {"object_radius": 3.0}, {"sector_half_width": 5.0}]
)
def test_hand_is_as_high_where_discs_begin_in_every_world(robot, world):
    """S2, bent as far as it can be when it meets a disc, ends where the disc in its chord's middle begins."""
    heights = []
    for readings in (PLAIN, PLAIN.with_values(world)):
        begins = 150.0 * np.cos(np.radians(readings.sector_half_width)) - readings.object_radius
        bent = beta_of(robot.plane, robot.plane.scale * np.array([begins, 0.0]))
        assert np.linalg.norm(tip_in_plane(0.0, bent)) == pytest.approx(begins)
        heights.append(float(hand_height(for_world(robot, readings).plane, bent)))
    assert heights[0] == pytest.approx(heights[1])
    assert robot.plane.hand_height < heights[0] < robot.plane.hand_height + robot.plane.lift


def test_hand_rises_steadily_with_beta(robot, beta):
    assert (np.diff(hand_height(robot.plane, beta)) >= 0.0).all()


def test_hand_rises_without_a_jerk(robot, beta):
    """The slope of t^2 (3 - 2 t) changes by at most 6 per unit of t."""
    height, step = hand_height(robot.plane, beta), beta[1] - beta[0]
    first, last = robot.plane.lift_range
    steepest_change = 6.0 * robot.plane.lift * (step / (last - first)) ** 2
    assert np.abs(np.diff(height, 2)).max() <= steepest_change * (1.0 + 1e-9)


def test_map_is_a_scale_about_the_first_joint(robot):
    alpha, beta = np.array([-30.0, 30.0, 210.0]), np.array([0.0, 45.0, 90.0])
    targets = hand_targets(robot.plane, alpha, beta)
    np.testing.assert_allclose(targets[:, :2], robot.plane.scale * tip_in_plane(alpha, beta), rtol=1e-15)
    np.testing.assert_array_equal(targets[:, 2], hand_height(robot.plane, beta))


def test_lifted_hand_stands_higher_above_the_table_than_the_objects(robot):
    top = max(2.0 * build_model(robot).geom(name).size[1] for name in ("blue", "green", "red"))
    assert robot.plane.hand_height + robot.plane.lift > top


@pytest.mark.parametrize("alpha", [-30.0, 90.0, 210.0])
def test_hand_too_near_is_a_bent_arm_and_one_too_far_a_straight_one(robot, alpha):
    """Beta ends at 90 and 0 degrees, wherever a joint's stop lets the hand go."""
    straight, bent = hand_targets(robot.plane, np.full(2, alpha), np.array([0.0, 90.0]))
    assert beta_of(robot.plane, straight * [1.02, 1.02, 1.0]) == 0.0
    for share in (0.99, 0.9, 0.5):
        assert beta_of(robot.plane, bent * [share, share, 1.0]) == pytest.approx(90.0, abs=1e-12)


def test_hand_points_to_the_right_of_its_bearing_by_the_lead(robot):
    """So that what its right side pushes is pushed along its own arc."""
    alpha, beta = np.meshgrid(np.linspace(0.0, 150.0, 16), np.linspace(0.0, 90.0, 10))
    x, y, _ = np.moveaxis(hand_targets(robot.plane, alpha, beta), -1, 0)
    ahead = hand_headings(robot.plane, alpha, beta)
    to_the_left = np.cos(ahead) * y - np.sin(ahead) * x  # of the fingers, where J1's ray is seen
    within = (ahead > robot.plane.heading_range[0]) & (ahead < robot.plane.heading_range[1])
    assert within.sum() > 120
    lead = np.arcsin(to_the_left / np.hypot(x, y))[within]
    np.testing.assert_allclose(lead, np.pi / 30, rtol=1e-9)
