"""Trajectories of one's own: judged like an agent's, and carried out by the robot."""

import numpy as np
import pytest

from arm2d import Readings
from mujoco_port.film.physical_port import port_physical_trial
from mujoco_port.reach.driving import angles_to, drive
from mujoco_port.reach.workspace import tip_in_plane


def sweep(first, last, beta=0.0, turn=2.0):
    """Angles [K + 1] of S1 that turns from one bearing to another at `turn` degrees a step, S2 held."""
    alpha = np.linspace(first, last, round(abs(last - first) / turn) + 1)
    return alpha, np.full_like(alpha, beta)


def test_a_recorded_trial_driven_again_is_the_same_trial(champion_records):
    for record in champion_records:
        again = drive(record.instruction, record.alpha, record.beta, record.discs[0], record.readings)
        np.testing.assert_array_equal(again.contact, record.contact)
        np.testing.assert_allclose(again.discs, record.discs, atol=1e-9)
        np.testing.assert_array_equal(again.inputs[:, :11], record.inputs[:, :11])
        assert (again.success, again.steps) == (record.success, record.steps)
        assert again.fitness == pytest.approx(record.fitness, abs=1e-9)


def test_discs_stand_amid_their_sectors_unless_placed():
    record = drive("indicate green", *sweep(60, 62))
    bearings = np.degrees(np.arctan2(record.discs[0, :, 1], record.discs[0, :, 0]))
    np.testing.assert_allclose(bearings, Readings().sector_centres)
    placed = drive("indicate green", *sweep(60, 62), discs=record.discs[0][::-1])
    np.testing.assert_array_equal(placed.discs[0], record.discs[0][::-1])


def test_a_sweep_that_pushes_the_disc_far_enough_moves_it():
    # S2 comes from the left with its right side ahead, stretched, and pushes green to the right.
    record = drive("move green", *sweep(120, 45))
    assert record.success
    assert record.discs[-1, 1, 0] > 50
    stopped = drive("move green", *sweep(120, 80))
    assert not stopped.success


def test_a_pass_on_the_wrong_side_does_not_count():
    assert not drive("move green", *sweep(50, 130)).success


def test_angles_to_a_point_end_in_it():
    way = np.radians(np.linspace(-9, 209, 60))  # S1 reaches so far with S2 half bent
    points = np.stack([130 * np.cos(way), 130 * np.sin(way)], axis=-1)
    alpha, beta = angles_to(points)
    np.testing.assert_allclose(tip_in_plane(alpha, beta), points, atol=1e-9)
    assert (np.abs(np.diff(alpha)) < 10).all()  # no jump of a full turn


@pytest.mark.parametrize(("reach", "beta"), [(150.0 + 5e-10, 0.0), (np.hypot(100.0, 50.0) - 5e-10, 90.0)])
def test_a_point_that_is_too_far_by_rounding_alone_is_reached(reach, beta):
    alpha, found = angles_to([[0.0, reach]])
    assert found == pytest.approx(beta, abs=1e-6)
    np.testing.assert_allclose(tip_in_plane(alpha, found), [[0.0, reach]], atol=1e-6)


@pytest.mark.parametrize(
    ("points", "sentence"),
    [
        ([[0, 130], [0, 100]], "point 1 is 100.0 cm from J1; S2 ends between 111.8 and 150 cm from it"),
        ([[0, 151]], "point 0 is 151.0 cm from J1"),
        ([[0, -140]], "point 0 asks S1 to turn to -"),
        ([[np.nan, 130]], "points must be numbers"),
        ([0, 130], "points must be numbers"),
    ],
)
def test_points_that_cannot_be_reached_are_named(points, sentence):
    with pytest.raises(ValueError, match=sentence):
        angles_to(points)


@pytest.mark.parametrize(
    ("changed", "sentence"),
    [
        ({"alpha": [60, np.nan, 62]}, r"alpha must be a row of numbers in \[-30, 210\] degrees"),
        ({"alpha": [60, np.inf, 62]}, r"alpha must be a row of numbers in \[-30, 210\] degrees"),
        ({"beta": [0, 91, 0]}, r"beta must be a row of numbers in \[0, 90\] degrees"),
        ({"beta": [0, 0]}, "there are 3 angles alpha and 2 beta"),
        ({"alpha": [60], "beta": [90]}, "there are 1 angles alpha and 1 beta"),
        ({"discs": [[0, 140]]}, r"discs must be the centres \[3, 2\] in cm"),
        ({"instruction": "push green"}, "unknown action word 'push'"),
    ],
)
def test_a_trajectory_that_is_none_is_refused(changed, sentence):
    given = {"instruction": "touch green", "alpha": [60, 61, 62], "beta": [90, 90, 90], **changed}
    with pytest.raises(ValueError, match=sentence):
        drive(**given)


def test_the_robot_follows_it_to_its_end_and_is_judged(lab):
    alpha, beta = sweep(120, 45)
    still = drive("move green", np.append(alpha, [45.0] * 5), np.append(beta, [0.0] * 5))
    physical, verdict = lab.follow(still)
    assert verdict.success
    assert verdict.end < len(physical.alpha) - 250  # certain before the end, and yet it went on
    assert physical.steps == still.steps
    np.testing.assert_array_equal(physical.orders, np.stack([still.alpha, still.beta], axis=-1))
    assert physical.objects[-1, 1, 0] > 50 * lab.body.robot.plane.scale


def test_more_steps_than_a_trial_on_the_robot_has_are_refused(lab):
    with pytest.raises(
        ValueError, match=r"this trial has 300 steps of 0\.1 s; on an acting robot it can have"
    ):
        lab.follow(drive("indicate green", np.full(301, 60.0), np.full(301, 90.0)))


def test_a_loop_without_an_agent_cannot_be_closed():
    record = drive("indicate green", *sweep(60, 62))
    with pytest.raises(ValueError, match=r"a loop that is closed \(geometric\) needs an agent"):
        port_physical_trial(record, closed_loop="geometric")


def test_there_is_no_network_to_be_recorded():
    assert np.isnan(drive("indicate green", *sweep(60, 62)).states).all()
