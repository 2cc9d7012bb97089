"""Verdicts in 3D, on trials made by hand: what counts, what breaks a run, what fails a trial."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from arm2d import Instruction
from arm2d.readings import PLAIN
from mujoco_port.acting.contacts import ARM, LEFT_SIDE, OBJECT, RIGHT_SIDE
from mujoco_port.acting.rollout import PhysicalRecord
from mujoco_port.acting.verdict import arcs, bearings, closed, judge

BLUE, GREEN, RED = 0, 1, 2
TEN_SECONDS = 5000  # physics steps
READINGS = PLAIN  # a camera in J1, and 4.6 degrees for INDICATE


def trial(words, n=6000, step_s=0.002, **changes):
    """S1 at rest on the target, which nothing touches; `changes` replace what was measured."""
    instruction = Instruction.parse(words)
    bearings = np.radians([30.0, 90.0, 150.0])
    places = 0.3 * np.stack([np.cos(bearings), np.sin(bearings), 0 * bearings], axis=-1)
    measured = {
        "alpha": np.full(n, (30.0, 90.0, 150.0)[instruction.object]),
        "still": np.ones(n, bool),
        "angles": np.zeros((n, 10)),
        "velocities": np.zeros((n, 10)),
        "torques": np.zeros((n, 10)),
        "hand": np.zeros((n, 3)),
        "joints": np.zeros((n, 10)),
        "head": np.zeros((n, 7)),
        "head_velocities": np.zeros((n, 7)),
        "head_torques": np.zeros((n, 7)),
        "places": np.tile(np.hstack([places, np.tile([1.0, 0.0, 0.0, 0.0], (3, 1))]), (n, 1, 1)),
        "contact": np.zeros((n, 3), np.uint8),
        "depth": np.zeros(n),
    }
    orders = changes.pop("orders", np.zeros((n // 50 + 1, 2)))
    return PhysicalRecord(instruction, 0.002, step_s, orders, **{**measured, **changes})


def touching(target, sides, n=6000):
    contact = np.zeros((n, 3), np.uint8)
    contact[:, target] = sides
    return contact


def pushed(target, degrees, n=1000, distance=0.3):
    """An object that moves to smaller bearings, S1 behind it by 2 degrees."""
    bearing = np.linspace((30.0, 90.0, 150.0)[target], (30.0, 90.0, 150.0)[target] - degrees, n)
    places = trial("move red", n).places.copy()
    places[:, target, :2] = distance * np.stack(
        [np.cos(np.radians(bearing)), np.sin(np.radians(bearing))], -1
    )
    return {"places": places, "alpha": bearing + 2.0, "still": np.zeros(n, bool)}


def test_indicate_is_ten_seconds_on_target_without_a_touch():
    verdict = judge(trial("indicate green"), READINGS)
    assert verdict.success
    assert verdict.end == TEN_SECONDS - 1
    assert not judge(trial("indicate green", n=TEN_SECONDS - 1), READINGS).success
    assert not judge(trial("indicate green", alpha=np.full(6000, 94.7)), READINGS).success


def test_one_touch_of_the_target_resets_indicate_and_touching_it_on_and_on_fails():
    contact = touching(GREEN, 0)
    contact[3000, GREEN] = LEFT_SIDE
    verdict = judge(trial("indicate green", contact=contact), READINGS)
    assert not verdict.success
    assert not verdict.certain
    assert verdict.progress == pytest.approx(6.0)
    assert not judge(trial("indicate green", contact=touching(GREEN, RIGHT_SIDE)), READINGS).success


def test_touch_wants_the_little_fingers_side_and_s1_at_rest():
    assert judge(trial("touch red", contact=touching(RED, RIGHT_SIDE)), READINGS).success
    assert not judge(trial("touch red", contact=touching(RED, LEFT_SIDE)), READINGS).success
    turning = trial("touch red", contact=touching(RED, RIGHT_SIDE), still=np.zeros(6000, bool))
    assert not judge(turning, READINGS).success


@pytest.mark.parametrize(("steps", "unbroken"), [(10, True), (11, False)])
def test_a_contact_may_chatter_for_twenty_milliseconds_and_no_longer(steps, unbroken):
    contact = touching(RED, RIGHT_SIDE)
    contact[3000 : 3000 + steps, RED] = 0
    assert judge(trial("touch red", contact=contact), READINGS).success == unbroken


def test_move_is_an_arc_about_j1_under_contact():
    n = 1000
    contact = touching(BLUE, RIGHT_SIDE, n)
    contact[:100] = 0  # it moves by 3.5 degrees before it is touched
    far = judge(trial("move blue", n, contact=contact, **pushed(BLUE, 40.0)), READINGS)
    assert far.success
    assert 34.4 <= far.progress < 36.6
    near = judge(trial("move blue", n, contact=contact, **pushed(BLUE, 36.0)), READINGS)
    assert not near.success
    assert near.progress == pytest.approx(36.0 * 0.9, abs=0.1)


def test_move_does_not_count_while_the_object_is_off_target_tilted_or_let_go():
    n, whole = 1000, {"contact": touching(BLUE, RIGHT_SIDE, 1000), **pushed(BLUE, 40.0)}
    assert judge(trial("move blue", n, **whole), READINGS).success
    assert not judge(trial("move blue", n, **{**whole, "alpha": whole["alpha"] + 5.0}), READINGS).success
    tilted = whole["places"].copy()
    tilted[500, BLUE, 3:] = np.cos(np.radians(6.0)), np.sin(np.radians(6.0)), 0.0, 0.0
    assert not judge(trial("move blue", n, **{**whole, "places": tilted}), READINGS).success
    tilted[500, BLUE, 3:] = np.cos(np.radians(6.0)), 0.0, np.sin(np.radians(6.0)), 0.0
    assert not judge(trial("move blue", n, **{**whole, "places": tilted}), READINGS).success
    gone = touching(BLUE, RIGHT_SIDE, n)
    gone[500:520] = 0
    assert not judge(trial("move blue", n, **{**whole, "contact": gone}), READINGS).success


@pytest.mark.parametrize("how", [RIGHT_SIDE, LEFT_SIDE, ARM, OBJECT])
def test_touching_another_object_fails_a_trial_for_good(how):
    contact = touching(GREEN, 0)
    contact[2000, BLUE] = how
    contact[2000, GREEN] = how & OBJECT
    verdict = judge(trial("indicate green", contact=contact), READINGS)
    assert (verdict.success, verdict.certain, verdict.end) == (False, True, 2000)
    assert verdict.reason == "another object was touched"
    late = touching(GREEN, 0)
    late[TEN_SECONDS + 1, BLUE] = how
    assert judge(trial("indicate green", contact=late), READINGS).success


def test_ignore_is_ten_seconds_with_the_target_neither_in_view_nor_touched():
    away = np.full(6000, 60.0)
    assert judge(trial("ignore green", alpha=away), READINGS).success
    assert not judge(trial("ignore green", alpha=away + 16.0), READINGS).success
    assert not judge(trial("ignore green", alpha=away, contact=touching(GREEN, LEFT_SIDE)), READINGS).success


def test_ignore_takes_in_view_as_the_camera_at_the_end_of_s1_does():
    """Objects stand 150 cm from J1: one 8 degrees off S1 is 23 degrees off as seen from its end, 4 are 12."""
    end = replace(READINGS, camera_origin="end")
    for off, from_j1, from_end in ((16.0, True, True), (8.0, False, True), (4.0, False, False)):
        record = trial("ignore green", alpha=np.full(6000, 90.0 - off))
        assert judge(record, READINGS).success == from_j1
        assert judge(record, end).success == from_end


def test_only_breaks_between_good_moments_are_closed():
    good = np.array([0, 1, 1, 0, 0, 1, 0, 0, 0, 1, 0], bool)
    np.testing.assert_array_equal(closed(good, 2), np.array([0, 1, 1, 1, 1, 1, 0, 0, 0, 1, 0], bool))
    np.testing.assert_array_equal(closed(good, 0), good)


def test_upright_is_the_cosine_of_the_tilt_whatever_the_turn():
    """Held against the rotation that scipy makes of the quaternion."""
    places = trial("move red", 50).places.copy()
    turns = Rotation.random(150, rng=np.random.default_rng(0))
    places[..., 3:] = np.roll(turns.as_quat(), 1, axis=-1).reshape(50, 3, 4)  # w comes first in MuJoCo
    expected = turns.apply([0.0, 0.0, 1.0])[:, 2].reshape(50, 3)
    np.testing.assert_allclose(trial("move red", 50, places=places).upright, expected, atol=1e-12)


@pytest.mark.parametrize("side", [-1.0, 1.0])
def test_target_is_met_just_inside_its_cone_on_either_side_and_not_outside(side):
    """4.6 degrees."""
    for off, met in ((4.5, True), (4.7, False)):
        alpha = np.full(6000, 90.0 + side * off)
        assert judge(trial("indicate green", alpha=alpha), READINGS).success == met
        touch = trial("touch green", alpha=alpha, contact=touching(GREEN, RIGHT_SIDE))
        assert judge(touch, READINGS).success == met


@pytest.mark.parametrize("side", [-1.0, 1.0])
def test_the_wide_cone_is_indicates_only(side):
    """30 degrees until the end, when F1 asks for 4.6; TOUCH keeps its 4.6."""
    wide = replace(READINGS, indicate_angle="wide")
    for off, met in ((4.7, True), (29.9, True), (30.1, False)):
        alpha = np.full(6000, 90.0 + side * off)
        alpha[TEN_SECONDS - 100 :] = 90.0 + side * 4.5
        assert judge(trial("indicate green", alpha=alpha), wide).success == met
        touch = trial("touch green", alpha=alpha, contact=touching(GREEN, RIGHT_SIDE))
        assert not judge(touch, wide).success


def test_who_points_beside_the_object_in_the_end_has_not_indicated_it():
    """As in the plane, where the trial ends then, with F1 below 1."""
    alpha = np.full(6000, 90.0 + 4.7)
    verdict = judge(trial("indicate green", alpha=alpha), replace(READINGS, indicate_angle="wide"))
    assert (verdict.success, verdict.certain) == (False, True)
    assert verdict.reason == "4.7 degrees beside the object in the end"
    assert verdict.end == TEN_SECONDS - 1
    # The plane looks ten times a second: who pointed well within the last tenth did so when it looked.
    alpha[TEN_SECONDS - 50] = 90.0 + 4.5
    assert judge(trial("indicate green", alpha=alpha), replace(READINGS, indicate_angle="wide")).success


def test_bearings_run_from_minus_90_over_the_left_bound_without_a_jump():
    degrees = np.arange(-89.0, 269.0)
    places = trial("move red", len(degrees)).places.copy()
    places[:, RED, :2] = np.stack([np.cos(np.radians(degrees)), np.sin(np.radians(degrees))], axis=-1)
    found = bearings(trial("move red", len(degrees), places=places))
    np.testing.assert_allclose(found[:, RED], degrees, atol=1e-9)
    np.testing.assert_allclose(found[:, BLUE], 30.0, atol=1e-9)


def test_a_fault_in_the_step_of_success_costs_nothing_unless_f1_is_cut_whole():
    """As in the plane, which scores all of its last step of 0.1 s, 50 moments here."""
    whole = replace(READINGS, collision_penalty="whole")
    for moment, met in ((TEN_SECONDS - 1, True), (TEN_SECONDS - 50, True), (TEN_SECONDS - 51, False)):
        contact = touching(GREEN, 0)
        contact[moment, BLUE] = ARM
        assert judge(trial("indicate green", contact=contact), READINGS).success == met
        assert not judge(trial("indicate green", contact=contact), whole).success


def test_objects_that_touch_one_another_beside_the_target_are_no_fault():
    contact = touching(GREEN, 0)
    contact[:, [BLUE, RED]] = OBJECT
    assert judge(trial("indicate green", contact=contact), READINGS).success


def seen_at(moments):
    """S1 30 degrees beside green, but on it at these moments."""
    alpha = np.full(12_750, 60.0)  # 25.5 s
    alpha[moments] = 90.0
    return alpha


@pytest.mark.parametrize(
    ("moments", "early", "never"),
    [
        (slice(0, 0), True, True),
        (slice(0, 7000), True, True),  # ten seconds away afterwards, and away in the end
        (slice(6000, None), True, False),  # away for ten seconds, but not in the end
        (slice(4000, 8500), False, False),  # never ten seconds, as the plane's 25 s end at 12,500
    ],
)
def test_ignore_that_nothing_ends_has_to_look_away_in_the_end_too(moments, early, never):
    record = trial("ignore green", 12_750, alpha=seen_at(moments))
    assert judge(record, READINGS).success == early
    strict = replace(READINGS, ignore_stops="never")
    verdict = judge(record, strict)
    assert (verdict.success, verdict.certain) == (never, True)
    # Until the end nothing is certain.
    so_far = trial("ignore green", 12_000, alpha=seen_at(moments)[:12_000])
    assert not judge(so_far, strict).certain


def test_ignore_that_nothing_ends_is_decided_by_a_touch_of_another_object():
    strict = replace(READINGS, ignore_stops="never")
    for moment, met in ((6000, True), (4000, False)):
        contact = touching(GREEN, 0, 12_750)
        contact[moment, BLUE] = ARM
        verdict = judge(trial("ignore green", 12_750, alpha=seen_at([]), contact=contact), strict)
        assert (verdict.success, verdict.certain, verdict.end) == (met, True, moment)


def test_strict_success_asks_for_a_straight_forearm_of_touch_and_move_only():
    strict = replace(READINGS, success="f1_f2_f3")
    contact = touching(GREEN, RIGHT_SIDE)
    for beta, met in ((0.8, True), (1.0, False)):
        orders = np.full((121, 2), beta)
        assert judge(trial("indicate green", orders=orders), strict).success
        record = trial("touch green", orders=orders, contact=contact)
        assert judge(record, READINGS).success
        assert judge(record, strict).success == met
    # Straight at some time is enough if the best counts.
    orders = np.full((121, 2), 30.0)
    orders[40] = 0.0
    record = trial("touch green", orders=orders, contact=contact)
    assert not judge(record, strict).success
    assert judge(record, strict).reason == "S2 was bent by 30.0 degrees"
    assert judge(record, replace(strict, f3_time="best")).success


def test_runs_may_be_counted_all_in_all():
    """Twice six seconds on the object, twice 20 degrees on the way: not on end, but more than is asked."""
    in_all = replace(READINGS, run_counting="cumulative")
    alpha = np.full(12_500, 90.0)
    alpha[3000:6000] = 70.0
    pointing = trial("indicate green", 9000, alpha=alpha[:9000])
    assert [judge(pointing, each).success for each in (READINGS, in_all)] == [False, True]
    moved = pushed(BLUE, 40.0)
    contact = touching(BLUE, RIGHT_SIDE, 1000)
    contact[490:510] = 0
    pushing = trial("move blue", 1000, contact=contact, **moved)
    assert [judge(pushing, each).success for each in (READINGS, in_all)] == [False, True]
    # A way back is taken off.
    bearing = np.concatenate([np.linspace(30.0, 10.0, 500), np.linspace(10.0, 30.0, 500)])
    assert arcs(np.ones(1000, bool), bearing, in_all=True)[[499, 999]] == pytest.approx([20.0, 0.0], abs=1e-9)


@pytest.mark.parametrize("step_s", [0.001, 0.002, 0.004])
def test_ten_seconds_are_ten_seconds_whatever_a_physics_step_is(step_s):
    needed = round(10.0 / step_s)
    assert judge(trial("indicate red", needed, step_s), READINGS).success
    assert not judge(trial("indicate red", needed - 1, step_s), READINGS).success


@pytest.mark.parametrize("step_s", [0.001, 0.004])
def test_a_break_of_twenty_milliseconds_is_none_whatever_a_physics_step_is(step_s):
    n, gap = round(11.0 / step_s), round(0.02 / step_s)
    for longer in (0, 1):
        contact = np.zeros((n, 3), np.uint8)
        contact[:, RED] = RIGHT_SIDE
        contact[n // 2 : n // 2 + gap + longer, RED] = 0
        assert judge(trial("touch red", n, step_s, contact=contact), READINGS).success == (longer == 0)
