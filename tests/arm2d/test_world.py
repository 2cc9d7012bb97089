"""Rules of the world (spec sections 2 to 8), each in a situation made by hand."""

import numpy as np
import pytest

from arm2d import ActionWord, ObjectWord, record_trial
from arm2d.readings import PLAIN
from tests.arm2d.controllers import one_trial, steady_controller

MOVE, TOUCH, INDICATE, IGNORE = ActionWord
BLUE, GREEN, RED = ObjectWord
STILL, LEFT_TURN, RIGHT_TURN = (0, 0), (1, 0), (-1, 0)
UNBEND = (0, -1)


def play(turns, action=INDICATE, target=GREEN, alpha=60.0, discs=None, **readings):
    chosen = PLAIN.with_values(readings)
    trial = one_trial(action, target, alpha, discs or {GREEN: (150.0, 90.0)})
    return record_trial(steady_controller(*turns, chosen), trial, chosen)


def in_s2_frame(record, disc):
    """(u, v) of a disc along and to the left of S2 in every state, [K + 1, 2]."""
    a, h = np.radians(record.alpha), np.radians(record.alpha + record.beta)
    rest = record.discs[:, disc] - 100.0 * np.stack([np.cos(a), np.sin(a)], axis=-1)
    u = rest[:, 0] * np.cos(h) + rest[:, 1] * np.sin(h)
    return np.stack([u, rest[:, 1] * np.cos(h) - rest[:, 0] * np.sin(h)], axis=-1)


def test_trial_of_a_motionless_arm_lasts_25_seconds_and_scores_nothing():
    record = play(STILL)
    assert record.steps == 250
    assert record.fitness == 0.0
    assert not record.success


def test_each_joint_turns_by_2_9_degrees_a_step():
    np.testing.assert_allclose(play(LEFT_TURN).turns[:10], [[2.9, 0.0]] * 10, atol=1e-12)
    np.testing.assert_allclose(play(UNBEND).turns[:10], [[0.0, -2.9]] * 10, atol=1e-12)


def test_last_turn_before_a_bound_is_cut_short_and_counts_as_it_was_made():
    record = play(RIGHT_TURN, alpha=0.0)
    assert record.alpha[11] == -30.0
    assert record.turns[10, 0] == pytest.approx(-1.0)
    assert not record.turns[11:, 0].any()
    unbent = play(UNBEND)
    assert unbent.beta[32] == 0.0
    assert unbent.turns[31, 1] == pytest.approx(-0.1)


def test_camera_is_white_in_its_outer_sector_exactly_at_the_bounds():
    right = play(RIGHT_TURN, alpha=0.0)
    np.testing.assert_array_equal(right.inputs[11:, 2:5], 1.0)
    assert not right.inputs[:11, 2:11].any()
    left = play(LEFT_TURN, alpha=180.0)
    np.testing.assert_array_equal(left.inputs[11:, 8:11], 1.0)


def test_near_reading_is_white_from_fifteen_degrees_before_the_bound():
    record = play(RIGHT_TURN, alpha=0.0, bound_vision="near")
    np.testing.assert_array_equal(record.inputs[:, 2:5].any(axis=1), record.alpha[:-1] <= -15.0)


@pytest.mark.parametrize(
    ("offset", "sector"),
    [(-15.1, None), (-14.9, 1), (-5.1, 1), (-4.9, 2), (4.9, 2), (5.1, 3), (14.9, 3), (15.1, None)],
)
def test_disc_is_seen_in_the_sector_of_its_bearing(offset, sector):
    record = play(STILL, discs={GREEN: (150.0, 60.0 + offset)})
    expected = np.zeros((3, 3))
    if sector:
        expected[sector - 1, GREEN] = 1.0
    np.testing.assert_array_equal(record.inputs[0, 2:11].reshape(3, 3), expected)


def test_any_part_reading_sees_a_disc_in_every_sector_it_overlaps():
    # A disc of 5 cm at 150 cm covers 1.91 degrees to either side of its bearing.
    for offset, sectors in {-16.0: [0], -16.95: [], -5.5: [0, 1], 6.0: [1, 2], 16.8: [2]}.items():
        record = play(STILL, discs={GREEN: (150.0, 60.0 + offset)}, object_vision="any_part")
        seen = record.inputs[0, 2:11].reshape(3, 3)[:, GREEN]
        np.testing.assert_array_equal(np.nonzero(seen)[0], sectors)


def test_bend_and_words_are_sensed():
    record = play(UNBEND, action=TOUCH, target=RED)
    np.testing.assert_allclose(record.inputs[:, 11], record.beta[:-1] / 90.0)
    np.testing.assert_array_equal(record.inputs[:, 12:], [[0, 1, 1, 1, 0, 1]] * record.steps)


def test_unbending_s2_meets_a_disc_with_its_right_side_and_carries_it():
    # The disc stands 40 cm along the direction that S2 takes when bent by 30 degrees.
    a, h = np.radians(60.0), np.radians(90.0)
    centre = 100.0 * np.array([np.cos(a), np.sin(a)]) + 40.0 * np.array([np.cos(h), np.sin(h)])
    disc = (np.hypot(*centre), np.degrees(np.arctan2(centre[1], centre[0])))
    record = play(UNBEND, action=MOVE, target=GREEN, alpha=60.0, discs={GREEN: disc})
    first = int(np.argmax(record.contact[:, GREEN] != 0))
    assert first > 10
    np.testing.assert_array_equal(record.contact[first:, GREEN], 1)
    np.testing.assert_array_equal(record.inputs[first:, 0], 1.0)
    np.testing.assert_array_equal(record.discs[:first, GREEN], record.discs[:1, GREEN].repeat(first, axis=0))
    frame = in_s2_frame(record, GREEN)[first:]
    np.testing.assert_allclose(frame, frame[:1].repeat(len(frame), axis=0), atol=1e-9)
    np.testing.assert_allclose(frame[:, 1], -5.0, atol=1e-9)


def test_s2_swept_by_s1_meets_a_disc_with_its_left_side():
    record = play(LEFT_TURN, alpha=0.0, discs={GREEN: (108.0, 90.0)}, action=INDICATE, target=GREEN)
    first = int(np.argmax(record.contact[:, GREEN] != 0))
    assert record.contact[first, GREEN] == 2
    assert record.inputs[first, 1] == 1.0


def test_disc_that_s2_leaves_stays_where_it_was_left():
    record = play((-1, 1), alpha=60.0, discs={GREEN: (140.0, 62.0)}, action=INDICATE)
    assert not record.contact.any()
    np.testing.assert_array_equal(record.discs[0], record.discs[-1])


def test_touching_another_disc_ends_the_trial_and_costs_two_fifths_of_the_way():
    turns, discs = (1, -1), {GREEN: (150.0, 150.0), RED: (150.0, 200.0)}
    record = play(turns, action=INDICATE, target=RED, alpha=60.0, discs=discs)
    assert record.contact[-1, GREEN] != 0
    assert not record.contact[:-1].any()
    way = (140.0 - (200.0 - record.alpha[-1])) / 140.0
    assert record.scores.f1[0, 0] == pytest.approx(0.6 * way)


def test_indicate_succeeds_after_a_hundred_steps_on_target():
    record = play(STILL, discs={GREEN: (150.0, 64.5)})
    assert (record.steps, record.success, record.fitness) == (100, True, 2.0)
    assert not play(STILL, discs={GREEN: (150.0, 64.7)}).success


def test_touch_needs_contact_on_the_right_side():
    # S1 stands on the target; unbending S2 comes to rest against it or passes within reach of it.
    record = play(UNBEND, action=TOUCH, alpha=60.0, discs={GREEN: (140.0, 59.0)})
    assert record.contact[-1, GREEN] == 1
    assert record.scores.f1[0, 0] == 1.0


def test_ignore_succeeds_out_of_view_and_fails_in_view():
    away, seen = (play(STILL, action=IGNORE, discs={GREEN: (150.0, 60.0 + d)}) for d in (15.1, 14.9))
    assert (away.steps, away.success, away.fitness) == (100, True, 2.0)
    assert (seen.steps, seen.success, seen.fitness) == (250, False, 0.0)


def test_ignore_runs_on_if_the_reading_says_so():
    record = play(STILL, action=IGNORE, discs={GREEN: (150.0, 80.0)}, ignore_stops="never")
    assert (record.steps, record.success) == (250, True)


def test_wide_reading_lets_indicate_count_within_thirty_degrees():
    record = play(STILL, discs={GREEN: (150.0, 89.0)}, indicate_angle="wide")
    assert record.steps == 100
    assert record.scores.f1[0, 0] == 0.0


def test_f3_is_how_far_s2_is_stretched_with_the_target_in_view():
    seen, unseen = (play(UNBEND, action=MOVE, discs={GREEN: (170.0, 60.0 + d)}) for d in (14.0, 16.0))
    assert seen.scores.f3[0, 0] == 1.0
    assert unseen.scores.f3[0, 0] == 0.0
    assert play(UNBEND, action=INDICATE, discs={GREEN: (170.0, 74.0)}).scores.f3[0, 0] == 0.0


def test_best_reading_of_f3_remembers_the_best_step():
    turns = (1, -1)
    discs = {GREEN: (170.0, 75.0)}
    end, best = (play(turns, action=MOVE, discs=discs, f3_time=time) for time in ("end", "best"))
    assert end.scores.f3[0, 0] == 0.0
    in_view = np.abs(75.0 - best.alpha[1:]) <= 15.0
    assert best.scores.f3[0, 0] == pytest.approx(np.max(1.0 - best.beta[1:][in_view] / 90.0))
