"""What a robot's record is wished to give: the walks, what is seen on them, and what a lack costs."""

from dataclasses import replace

import numpy as np
import pytest

from mujoco_port.reach.kinematics import ArmKinematics
from mujoco_port.reach.search import varied
from mujoco_port.reach.wishes import Seen, priced, walk, walks
from mujoco_port.reach.workspace import hand_headings, hand_targets

NOTHING = 0.5  # [m], a gap that leaves nothing to be wished


def ends(path):
    """Where a walk begins and ends: (alpha, beta) [deg]."""
    alpha, beta = path
    return (alpha[0], beta[0]), (alpha[-1], beta[-1])


def test_the_first_walk_goes_to_and_fro_four_times():
    alpha, beta = walks()[0]
    for bend, first, last in ((90.0, -30.0, 210.0), (30.0, 210.0, -30.0), (20.0, -30.0, 210.0)):
        sweep = alpha[beta == bend]
        assert (sweep[0], sweep[-1]) == (first, last)
        assert len(sweep) == 84  # 83 turns
        assert (np.sign(np.diff(sweep)) == np.sign(last - first)).all()
    assert (alpha[-1], beta[-1]) == (-30.0, 0.0)
    assert (np.diff(beta) <= 0.0).all()


def test_six_walks_stretch_s2_alone_and_six_turn_s1_besides():
    stretches, diagonals = walks()[1:7], walks()[7:13]
    for (alpha, beta), at in zip(stretches, (-30.0, 30.0, 90.0, 150.0, 195.0, 210.0), strict=True):
        assert (alpha == at).all()
        assert (beta[0], beta[-1], len(beta)) == (90.0, 0.0, 33)
    turns = [ends(path)[1][0] - ends(path)[0][0] for path in diagonals]
    assert turns == pytest.approx([-90.0, -60.0, -92.8, 89.0, 60.0, 30.0])
    for _, beta in diagonals:
        np.testing.assert_array_equal(beta, stretches[0][1])


def test_two_walks_lead_into_the_corner_at_the_left_bound():
    assert [ends(path) for path in walks()[13:]] == [
        ((150.0, 90.0), (210.0, 0.0)),
        ((150.0, 45.0), (210.0, 90.0)),
    ]
    for alpha, beta in walks()[13:]:
        at_bound = alpha == 210.0
        assert (beta[~at_bound] == beta[0]).all()
        assert (np.abs(np.diff(beta)) > 0.0).sum() == at_bound.sum() - 1


def test_a_step_of_the_search_is_a_step_of_what_it_varies(robot, kinematics):
    """Three centimetres of place, 15 % of a joint's range, and e times a weight."""
    n = len(robot.joints)
    for place in range(3 + 2 * n + 2):
        change = np.zeros(3 + 2 * n + 2)
        change[place] = -0.5 if place < 3 + n else 1.0
        posture = varied(robot, kinematics, change).posture
        base = np.subtract(varied(robot, kinematics, change).base_position, robot.base_position)
        rest = np.subtract(posture.rest, np.clip(robot.posture.rest, kinematics.lower, kinematics.upper))
        weights = [*posture.weights, posture.heading_weight, posture.level_weight]
        before = [*robot.posture.weights, robot.posture.heading_weight, robot.posture.level_weight]
        span = kinematics.upper - kinematics.lower
        np.testing.assert_allclose(base, -0.03 * 0.5 * np.eye(3)[place] if place < 3 else 0.0, atol=1e-12)
        lowest = kinematics.lower - robot.posture.rest
        asked = np.maximum(-0.15 * 0.5 * span, lowest) * (np.arange(n) == place - 3)
        np.testing.assert_allclose(rest, asked, atol=1e-3)
        np.testing.assert_allclose(
            np.log(np.divide(weights, before)), np.arange(n + 2) == place - 3 - n, atol=1e-12
        )


@pytest.fixture
def seen(kinematics):
    """Two steps in which nothing is left to be wished; the arm is in the middle of its range."""
    middle = (kinematics.lower + kinematics.upper) / 2
    torso = np.array([name.startswith("torso") for name in kinematics.robot.joints])
    angles = np.where(torso, 0.0, middle)
    return Seen(0, [angles, angles.copy()], [0.0, 0.0], [0.0, 0.0], [1.0, 4.0], [0.0], [(NOTHING, NOTHING)])


def test_nothing_to_be_wished_costs_nothing(seen, kinematics):
    assert priced(seen, kinematics).total == 0.0


def test_a_tilt_costs_by_its_square_where_it_counts_and_beyond_twelve_degrees_more(seen, kinematics):
    seen.tilts[:] = 0.1, 0.2
    assert priced(seen, kinematics).total == pytest.approx(8.0 * (0.2 * 0.01 + 0.8 * 0.04))
    seen.tilts[0] = np.radians(20.0)
    beyond = 10.0 * np.radians(8.0)
    assert priced(seen, kinematics).roll == pytest.approx(
        8.0 * (0.2 * np.radians(20.0) ** 2 + 0.8 * 0.04) + beyond
    )


def test_a_heading_costs_by_its_square_up_to_two(seen, kinematics):
    seen.headings[:] = 0.3, -0.5
    assert priced(seen, kinematics).total == pytest.approx(10.0 * (0.2 * 0.09 + 0.8 * 0.25))
    seen.headings[:] = 3.0, 0.0
    assert priced(seen, kinematics).total == pytest.approx(10.0 * 0.2 * 2.0)


def test_a_turn_costs_and_beyond_a_tenth_of_a_radian_more(seen, kinematics):
    seen.turns[:] = 0.02, 0.08, 0.01
    assert priced(seen, kinematics).total == pytest.approx(0.3 * 0.08)
    seen.turns[:] = 0.02, 0.15
    assert priced(seen, kinematics).total == pytest.approx(0.3 * 0.15 + 20.0 * 0.05)


@pytest.mark.parametrize(("place", "wished"), [("table", 0.008), ("body", 0.006)])
def test_a_gap_costs_by_the_largest_lack_and_by_the_mean_square(seen, kinematics, place, wished):
    gaps = {"table": (0.005, NOTHING), "body": (NOTHING, 0.005)}
    seen.gaps[:] = [(NOTHING, NOTHING), gaps[place]]
    lack = wished - 0.005
    cost = priced(seen, kinematics)
    assert getattr(cost, place) == pytest.approx(100.0 * lack + 4e3 * lack**2 / 2)
    assert cost.total == pytest.approx(getattr(cost, place))


def test_a_joint_at_its_limit_costs_from_three_percent_of_its_range_on(seen, kinematics):
    span = kinematics.upper - kinematics.lower
    joint = kinematics.robot.joints.index("r_elbow")
    for bound, inward in ((kinematics.lower, 1.0), (kinematics.upper, -1.0)):
        seen.angles[1][joint] = bound[joint] + inward * 0.03 * span[joint]
        assert priced(seen, kinematics).limits == pytest.approx(0.0, abs=1e-12)
        seen.angles[1][joint] = bound[joint] + inward * 0.01 * span[joint]
        assert priced(seen, kinematics).limits == pytest.approx(2.0 * (2 / 3) / 2)


def test_a_leaning_torso_costs_the_sum_of_its_squares(seen, kinematics):
    torso = [k for k, name in enumerate(kinematics.robot.joints) if name.startswith("torso")]
    seen.angles[0][torso] = 0.1, 0.2, 0.3
    assert priced(seen, kinematics).leaning == pytest.approx(0.5 * 0.14 / 2)


def test_a_place_that_is_missed_costs_three_and_no_step_is_needed(seen, kinematics):
    seen.missed = 2
    assert priced(seen, kinematics).total == 6.0
    assert priced(Seen(missed=7), kinematics).total == 21.0


def test_a_walk_tells_what_the_arm_does(kinematics):
    """From outside a sector into it while S2 is nearly straight, where the hand's pose counts four times."""
    alpha = 14.0 + 2.9 * np.arange(20)
    beta = np.where(np.arange(20) < 10, 11.9, 12.1)
    seen, asked = Seen(), []
    walk(kinematics, alpha, beta, seen, lambda posture: (asked.append(posture), (0.1, 0.2))[1])
    plane = kinematics.robot.plane
    targets, headings = hand_targets(plane, alpha, beta), hand_headings(plane, alpha, beta)
    assert seen.missed == 0
    assert seen.counts == [1.0] * 3 + [4.0] * 7 + [1.0] * 10
    assert [len(each) for each in (seen.angles, seen.turns, seen.tilts, seen.headings)] == [20, 19, 20, 20]
    assert seen.turns == pytest.approx(np.abs(np.diff(seen.angles, axis=0)).max(axis=1))
    for posture, target, heading, tilt, off in zip(
        seen.angles, targets, headings, seen.tilts, seen.headings, strict=True
    ):
        hand = kinematics.forward(posture)
        assert np.linalg.norm(hand.position - target) < 1e-3
        assert tilt == kinematics.roll_error(hand)
        assert off == kinematics.heading_error(hand, heading)
    np.testing.assert_array_equal(asked, [seen.angles[k] for k in (0, 13, 19)])
    assert seen.gaps == [(0.1, 0.2)] * 3


def test_gaps_are_asked_more_often_in_the_corner(kinematics):
    """At the first step, outside it, by the usual rule; then at steps 3 and 6, and at the end, step 9."""
    seen = Seen()
    walk(kinematics, np.linspace(192.0, 210.0, 10), np.full(10, 60.0), seen, lambda posture: (0.1, 0.2))
    assert len(seen.gaps) == 4
    assert set(seen.counts) == {1.0}


def test_a_walk_ends_where_the_arm_does_not_reach_and_all_that_is_left_is_missed(robot):
    larger = replace(robot, plane=replace(robot.plane, scale=1.4 * robot.plane.scale))
    (alpha, beta), seen = walks()[3], Seen(missed=5)
    walk(ArmKinematics(larger), alpha, beta, seen, lambda posture: (0.1, 0.2))
    assert 2 < len(seen.angles) < len(alpha) - 2
    assert seen.missed == 5 + len(alpha) - len(seen.angles)
