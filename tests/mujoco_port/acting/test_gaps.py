"""What the hand touches on the robot is what S2 touches in the 2D world."""

import numpy as np
import pytest

from arm2d import Readings
from arm2d.constants import BETA_MAX
from mujoco_port.acting.gaps import FARTHEST, Gaps
from mujoco_port.film.kinematic import roll_out
from mujoco_port.reach.driving import drive
from mujoco_port.reach.workspace import for_world, hand_headings, hand_targets

RIGHT = 1
OVERLAP_M = 3e-3  # a heading some degrees off lets the hand reach a little ahead of S2
TOUCH_M = 4e-3


@pytest.fixture(scope="module")
def gaps(robot):
    return Gaps(for_world(robot, Readings()))


@pytest.fixture(scope="module")
def measured(robot, gaps, champion_records):
    """Every third state of trials that succeed: trial, beta, contact in 2D [3], gaps of hand, of arm [3]."""
    rows = []
    for trial, record in enumerate(champion_records):
        rollout = roll_out(record, robot, frames_per_step=1)
        if record.success:
            for k in range(0, record.steps + 1, 3):
                hand, arm = gaps.measure(rollout.angles[k], rollout.objects[k])
                rows.append((trial, record.beta[k], record.contact[k], hand, arm))
    return [np.array(column) for column in zip(*rows, strict=True)]


def test_gap_of_a_far_object_is_told_as_the_farthest(gaps, kinematics):
    hand, arm = gaps.measure(kinematics.rest, np.full((3, 2), 2.0))
    assert (hand == FARTHEST).all()
    assert (arm == FARTHEST).all()


def test_hand_seldom_overlaps_an_object_that_s2_does_not_touch(measured):
    """The hand is wider than a line: what lies close to the left of a straight S2 is still in its way."""
    trial, _, contact, hand, _ = measured
    overlaps = ((hand < -OVERLAP_M) & (contact == 0)).any(axis=1)
    assert len(np.unique(trial[overlaps])) <= 1 < 12 <= len(np.unique(trial))


def test_hand_touches_what_a_straight_s2_touches(robot, measured):
    _, beta, contact, hand, _ = measured
    low = for_world(robot, Readings()).plane.lift_range[0]
    straight = (beta <= low)[:, np.newaxis] & (contact == RIGHT)
    assert straight.sum() > 50
    assert np.abs(hand[straight]).max() < TOUCH_M


@pytest.mark.parametrize("radius", [0.1, 3.0, 8.0, 11.8])
def test_objects_are_as_wide_as_the_discs_of_the_world_want_it(robot, kinematics, radius):
    """Straight, S2 just touches the green disc that is to its right; so does the hand, whatever its size."""
    laid, distance = for_world(robot, Readings(object_radius=radius)), 147.7
    gaps = Gaps(laid)
    for alpha in (20.0, 90.0, 160.0):
        bearing = np.radians(alpha) - np.arcsin(radius / distance)
        touched = laid.plane.scale * distance * np.array([np.cos(bearing), np.sin(bearing)])
        angles = kinematics.settle(
            hand_targets(laid.plane, alpha, 0.0), float(hand_headings(laid.plane, alpha, 0.0))
        )
        away = np.array([[0.4, -0.2], touched, [-0.6, -0.2]])
        assert abs(gaps.measure(angles, away)[0][1]) < 2e-3


@pytest.mark.parametrize("radius", [5.0, 8.0])
def test_robot_follows_a_trial_at_the_table_of_its_world(robot, radius):
    """At 28 degrees S2 may still meet a disc of 8 cm, and the hand is low; above those of 5 cm it rises."""
    readings = Readings().with_values({"object_radius": radius, "sector_half_width": 10.0})
    record = drive("indicate green", np.full(6, -25.0), np.full(6, 28.0), readings=readings)
    height = roll_out(record, robot).targets[-1, 2]
    assert (height == pytest.approx(robot.plane.hand_height)) == (radius == 8.0)


def test_rest_of_the_arm_stays_away_from_all_objects(measured):
    assert measured[4].min() > 0.01


def test_bent_arm_passes_above_the_objects(robot, gaps, kinematics):
    """Objects all along the circle that the end of S2 describes: the hand is right above one of them."""
    for alpha in (0.0, 60.0, 120.0):
        target = hand_targets(robot.plane, alpha, BETA_MAX)
        angles = kinematics.settle(target, float(hand_headings(robot.plane, alpha, BETA_MAX)))
        hand, _ = gaps.measure(angles, np.tile(target[:2], (3, 1)))
        assert 0.0 < hand.min() < FARTHEST
