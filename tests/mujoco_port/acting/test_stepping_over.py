"""The hand stays above what lies below it, and low beside what it pushes."""

import numpy as np
import pytest

from models.robots import get_robot
from mujoco_port.acting.stepping_over import stepping_over
from mujoco_port.reach.workspace import hand_headings, hand_height, on_table, tip_in_plane

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
        tip = on_table(robot.plane, tip_in_plane(record.alpha, record.beta))
        heading = hand_headings(robot.plane, record.alpha, record.beta)
        pushed = (record.contact == 1) & (record.beta < 1.0)[:, np.newaxis]
        for k, target in np.argwhere(pushed):
            disc = on_table(robot.plane, record.discs[k, target])
            assert stepping_over(PRINT, tip[k], heading[k], disc[np.newaxis]) < 0.1
            seen += 1
    assert seen > 100
