"""The hand stays above what lies below it, and low beside what it pushes."""

from types import SimpleNamespace

import numpy as np
import pytest

from arm2d import Readings
from models.robots import get_robot
from mujoco_port.acting.contacts import LEFT_SIDE, RIGHT_SIDE
from mujoco_port.acting.rollout import above_objects
from mujoco_port.acting.stepping_over import stepping_over
from mujoco_port.reach.workspace import (
    for_world,
    hand_headings,
    hand_height,
    hand_targets,
    on_table,
    tip_in_plane,
)

HAND = np.array([0.1, 0.2])
PRINT = get_robot("icub").plane.hand_print


def raised(ahead, left, heading=0.7):
    """For one object so far [m] ahead and to the left of the hand."""
    along = np.array([np.cos(heading), np.sin(heading)])
    place = HAND + ahead * along + left * np.array([-along[1], along[0]])
    return float(stepping_over(PRINT, HAND, heading, place[np.newaxis]))


@pytest.mark.parametrize(
    ("ahead", "left", "expected"),
    [
        (0.0, 0.03, 1.0),  # below the palm
        (0.02, 0.06, 1.0),  # below the thumb
        (0.0, -0.009, 0.0),  # pushed by the little finger
        (0.0, 0.12, 0.0),  # beyond the thumb
        (0.08, 0.03, 0.0),  # beyond the fingers
        (-0.2, 0.03, 0.0),  # behind the wrist, where the arm is higher
    ],
)
def test_hand_is_raised_over_what_is_below_it_and_nothing_else(ahead, left, expected):
    assert raised(ahead, left) == pytest.approx(expected)


@pytest.mark.parametrize("radius", [3.0, 8.0, 11.8])
@pytest.mark.parametrize(
    ("first", "last", "outwards"),
    [
        ((0.0, 0.06), (0.0, 0.10), (0.0, 1.0)),  # beyond the thumb
        ((0.0, -0.01), (0.0, 0.01), (0.0, -1.0)),  # at the little finger
        ((0.04, 0.03), (0.08, 0.03), (1.0, 0.0)),  # beyond the fingers
        ((-0.16, 0.03), (-0.11, 0.03), (-1.0, 0.0)),  # behind the wrist
    ],
)
def test_hand_stays_as_far_from_a_wider_object_as_from_a_narrow_one(radius, first, last, outwards):
    """Told by where the object's edge is, not its centre."""
    plane = for_world(get_robot("icub"), Readings(object_radius=radius)).plane
    places = np.linspace(first, last, 20)
    moved = places + (plane.object_radius - 0.017) * np.array(outwards)
    ours, theirs = (
        [float(stepping_over(prints, np.zeros(2), 0.0, place[np.newaxis])) for place in each]
        for prints, each in ((PRINT, places), (plane.hand_print, moved))
    )
    assert min(ours) < 0.5 < max(ours)
    np.testing.assert_allclose(theirs, ours, atol=1e-9)


def test_a_table_can_be_laid_anew():
    robot = get_robot("icub")
    laid = for_world(for_world(robot, Readings(object_radius=11.8)), Readings(object_radius=5.0)).plane
    assert laid.object_radius == pytest.approx(robot.plane.object_radius)
    assert laid.hand_print.width == pytest.approx(PRINT.width)


def test_hand_rises_without_a_jump_while_it_comes_near():
    ways = [[raised(0.0, y) for y in np.arange(-0.05, 0.15, 1e-4)]]
    ways.append([raised(x, 0.03) for x in np.arange(-0.2, 0.1, 1e-4)])
    assert max(np.abs(np.diff(way)).max() for way in ways) < 0.02


def test_without_objects_and_with_far_ones_the_height_is_that_of_beta(robot):
    beta = np.linspace(0.0, 90.0, 31)
    nothing = stepping_over(PRINT, HAND, 0.0, np.empty((0, 2)))
    np.testing.assert_array_equal(hand_height(robot.plane, beta, nothing), hand_height(robot.plane, beta))


def test_pushed_objects_of_all_trials_do_not_raise_the_hand(robot, champion_records):
    """S2 touches with its right side while it is straight: the hand must be low there."""
    seen = 0
    for record in champion_records:
        hand_print = for_world(robot, record.readings).plane.hand_print
        tip = on_table(robot.plane, tip_in_plane(record.alpha, record.beta))
        heading = hand_headings(robot.plane, record.alpha, record.beta)
        pushed = (record.contact == 1) & (record.beta < 1.0)[:, np.newaxis]
        for k, target in np.argwhere(pushed):
            disc = on_table(robot.plane, record.discs[k, target])
            assert stepping_over(hand_print, tip[k], heading[k], disc[np.newaxis]) < 0.1
            seen += 1
    assert seen > 100


HIGH, LOW = (90.0, 90.0), (90.0, 0.0)


def below(plane, alpha, beta):
    """The place [2] in [m] below the palm of a hand that is where S2 ends."""
    heading = float(hand_headings(plane, alpha, beta))
    return on_table(plane, tip_in_plane(alpha, beta)) + 0.03 * np.array([-np.sin(heading), np.cos(heading)])


def above(lab, here, order, place, touched=0):
    """How far a hand that stands at (alpha, beta) has to be above one object, touched 4 ms ago."""
    plane, contact = lab.body.robot.plane, np.zeros((100, 3), np.uint8)
    alpha, beta = np.array(here[0]), np.array(here[1])
    angles = lab.kinematics.settle(hand_targets(plane, alpha, beta), float(hand_headings(plane, alpha, beta)))
    objects = np.array([[0.40, 0.38], place, [-0.62, 0.38]])
    lab.body.start(angles, objects)
    contact[-2, 1] = touched
    return above_objects(lab.body, objects, SimpleNamespace(contact=contact), order)


def test_hand_stays_up_over_what_is_below_it_now_or_will_be(lab):
    plane = lab.body.robot.plane
    now, later, neither = below(plane, *HIGH), below(plane, 50.0, 30.0), np.array([0.35, 0.1])
    assert above(lab, HIGH, HIGH, now) > 0.9
    assert above(lab, HIGH, (50.0, 30.0), now) > 0.9
    assert above(lab, HIGH, (50.0, 30.0), later) > 0.9
    assert above(lab, HIGH, HIGH, later) == 0.0
    assert above(lab, HIGH, (50.0, 30.0), neither) == 0.0


def test_low_hand_pushes_what_it_will_meet(lab):
    assert above(lab, LOW, (50.0, 30.0), below(lab.body.robot.plane, 50.0, 30.0)) == 0.0


def test_what_is_pushed_does_not_count_and_what_is_touched_otherwise_does(lab):
    now = below(lab.body.robot.plane, *HIGH)
    assert above(lab, HIGH, HIGH, now, RIGHT_SIDE) == 0.0
    assert above(lab, HIGH, HIGH, now, LEFT_SIDE) > 0.9
