"""The camera at the end of S1 (reading `camera_origin` end), in situations made by hand."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from arm2d import ActionWord, LabelChanges, ObjectWord, record_trial
from arm2d.geometry import camera_offsets, in_view
from arm2d.kernel import lanes as at
from arm2d.kernel.camera_at_end import look_from_end, look_in_lane
from arm2d.kernel.contact import place_disc
from arm2d.kernel.world import world_of
from arm2d.readings import PLAIN
from tests.arm2d.controllers import one_trial, steady_controller

MOVE, TOUCH, INDICATE, IGNORE = ActionWord
BLUE, GREEN, RED = ObjectWord
STILL, LEFT_TURN, RIGHT_TURN, UNBEND = (0, 0), (1, 0), (-1, 0), (0, -1)
J1, END = PLAIN, replace(PLAIN, camera_origin="end")


def play(turns, discs, action=INDICATE, alpha=60.0, readings=END):
    return record_trial(steady_controller(*turns, readings), one_trial(action, GREEN, alpha, discs), readings)


def seen_from_end(distance, offset, alpha=60.0):
    """(distance from J1, bearing) of a point so far from J2 [cm], so far to the left of S1 [deg]."""
    a, h = np.radians(alpha), np.radians(alpha + offset)
    x, y = 100.0 * np.cos(a) + distance * np.cos(h), 100.0 * np.sin(a) + distance * np.sin(h)
    return np.hypot(x, y), np.degrees(np.arctan2(y, x))


def sectors_of(record, step=0, disc=GREEN):
    """Numbers of the sectors that a disc is seen in."""
    return (np.flatnonzero(record.inputs[step, 2:11].reshape(3, 3)[:, disc]) + 1).tolist()


@pytest.mark.parametrize("distance", [20.0, 50.0])
@pytest.mark.parametrize(
    ("offset", "sectors"),
    [(-15.1, []), (-14.9, [1]), (-5.1, [1]), (-4.9, [2]), (4.9, [2]), (5.1, [3]), (14.9, [3]), (15.1, [])],
)
def test_disc_is_seen_in_the_sector_of_its_bearing_from_j2(distance, offset, sectors):
    assert sectors_of(play(STILL, {GREEN: seen_from_end(distance, offset)})) == sectors


def test_disc_at_the_edge_of_a_sector_moves_outwards_or_out_of_view():
    """At 150 cm, 1 degree from J1 is 3 from J2; at 4 degrees it is 12; at 8 it is 23."""
    for bearing, from_j1, from_end in ((61.0, [2], [2]), (64.0, [2], [3]), (68.0, [3], []), (52.0, [1], [])):
        discs = {GREEN: (150.0, bearing)}
        assert sectors_of(play(STILL, discs, readings=J1)) == from_j1
        assert sectors_of(play(STILL, discs)) == from_end


@given(st.floats(-30, 210), st.floats(100, 500), st.floats(-90, 270))
def test_whatever_is_in_view_from_j2_is_in_view_from_j1_and_nearer_to_s1_there(alpha, distance, bearing):
    """The kernel works out bearings from J2 only where the disc is in view from J1."""
    angle = np.radians(bearing)
    centre = distance * np.array([np.cos(angle), np.sin(angle)])
    if in_view(np.array(alpha), centre, END):
        near, far = (abs(camera_offsets(np.array(alpha), centre, each)) for each in (J1, END))
        assert near <= far + 1e-9


def test_disc_beside_j2_is_not_seen_though_s1_all_but_points_at_it():
    assert sectors_of(play(STILL, {GREEN: (100.5, 63.0)})) == []
    assert sectors_of(play(STILL, {GREEN: (100.5, 63.0)}, readings=J1)) == [2]


# How far beside the end of a sector a disc stands [deg]: from a rounding to well away, on either side.
BESIDE = [
    0.0,
    1e-15,
    1e-14,
    1e-13,
    1e-12,
    1e-11,
    1e-10,
    1e-9,
    1e-8,
    1e-7,
    9e-7,
    1.1e-6,
    2e-6,
    1e-5,
    1e-3,
    0.1,
]


@pytest.mark.parametrize("distance", [1e-6, 0.5, 0.999, 1.001, 1.2, 5.0, 49.9, 50.0, 90.0, 300.0])
@pytest.mark.parametrize("end", [-15.0, -5.0, 5.0, 15.0])
def test_a_look_by_the_edges_of_sectors_is_a_look_at_each_bearing(distance, end):
    """So near an end that rounding decides, the bearing from J2 does; both looks agree in every bit."""
    world, objects, rng = world_of(END), np.arange(at.N_LANES) % 3, np.random.default_rng(7)
    s, n = np.zeros(at.N_WORLD_FIELDS * at.N_LANES), np.zeros(at.N_INTEGER_FIELDS * at.N_LANES, np.int64)
    for i, beside in enumerate([*BESIDE, *(-each for each in BESIDE)]):
        s[at.ALPHA + i] = rng.uniform(0.0, 180.0)
        n[at.TRIAL + i], n[at.TARGET_BITS + i] = i, 0o111 << objects[i]
        for disc in range(3):
            offset = end + beside if disc == i % 3 else -3.0
            place_disc(
                s, disc * at.N_LANES + i, *seen_from_end(distance, offset, s[at.ALPHA + i])[::-1], world
            )
    look_from_end(s, n, at.N_LANES, at.N_LANES, objects, world)
    quick = n.copy()
    for i in range(at.N_LANES):
        look_in_lane(s, n, i, objects[i], world)
    for field in (at.CAMERA, at.SEEN):
        np.testing.assert_array_equal(*(each[field : field + at.N_LANES] for each in (quick, n)))
    clear = at.N_LANES - n[at.UNCLEAR : at.UNCLEAR + at.N_LANES].sum()
    fewest, most = (2 * sum(each > limit for each in BESIDE) for limit in (1e-4, 1e-6))
    assert fewest <= clear <= most if distance > 1.1 else clear == 0


def test_camera_is_white_at_the_bounds_as_from_j1():
    right = play(RIGHT_TURN, {}, alpha=0.0)
    np.testing.assert_array_equal(right.inputs[11:, 2:5], 1.0)
    assert not right.inputs[:11, 2:11].any()
    np.testing.assert_array_equal(play(LEFT_TURN, {}, alpha=180.0).inputs[11:, 8:11], 1.0)
    near = play(RIGHT_TURN, {}, alpha=0.0, readings=replace(END, bound_vision="near"))
    np.testing.assert_array_equal(near.inputs[:, 2:5].any(axis=1), near.alpha[:-1] <= -15.0)


def test_any_part_of_a_disc_is_seen_by_its_width_from_j2():
    """A disc of 5 cm at 50 cm covers 5.74 degrees to either side of its bearing."""
    readings = replace(END, object_vision="any_part")
    for offset, sectors in {-20.7: [1], -20.8: [], -10.7: [1, 2], 10.8: [3], 10.7: [2, 3], 20.7: [3]}.items():
        assert sectors_of(play(STILL, {GREEN: seen_from_end(50.0, offset)}, readings=readings)) == sectors
    assert sectors_of(play(STILL, {GREEN: seen_from_end(10.0, 34.0)}, readings=readings)) == [2, 3]


def test_a_disc_around_j2_fills_the_whole_view_if_any_part_counts():
    for distance, offset in ((3.0, 0.0), (4.9, 80.0), (5.0, 60.0)):
        discs = {GREEN: seen_from_end(distance, offset)}
        assert sectors_of(play(STILL, discs, readings=replace(END, object_vision="any_part"))) == [1, 2, 3]
        assert sectors_of(play(STILL, discs)) == ([2] if offset == 0.0 else [])


@pytest.mark.parametrize(("offset", "sectors"), [(-92.0, [1]), (92.0, [3])])
def test_a_wide_disc_beside_j2_reaches_into_view_from_either_side(offset, sectors):
    """11.8 cm wide at 11.9 cm it covers 82.6 degrees to either side, though its centre is behind J2."""
    readings = replace(END, object_vision="any_part", object_radius=11.8)
    assert sectors_of(play(STILL, {GREEN: seen_from_end(11.9, offset)}, readings=readings)) == sectors


def test_pushed_disc_is_seen_exactly_where_s2_has_it():
    """Carried 40 cm along S2 at its right side, it lies atan(5 / 40) to the right of S2, that is, of beta."""
    alpha, beta = 80.0 - 15 * 2.9, 90.0 - 15 * 2.9
    a, h = np.radians(alpha), np.radians(alpha + beta)
    joint, along = np.array([np.cos(a), np.sin(a)]), np.array([np.cos(h), np.sin(h)])
    centre = 100.0 * joint + 40.0 * along + 5.05 * np.array([along[1], -along[0]])
    disc = (np.hypot(*centre), np.degrees(np.arctan2(centre[1], centre[0])))
    record = play((-1, -1), {GREEN: disc}, alpha=80.0)
    carried = np.flatnonzero(record.contact[:, GREEN] == 1)[:18]
    assert len(set(np.diff(carried))) == 1
    u = np.sqrt(((record.discs[:, GREEN] - 100.0 * _directions(record.alpha)) ** 2).sum(axis=-1) - 25.0)
    offsets = record.beta - np.degrees(np.arctan2(5.0, u))
    np.testing.assert_allclose(
        camera_offsets(record.alpha, record.discs[:, GREEN], END)[carried], offsets[carried], atol=1e-9
    )
    seen = [sectors_of(record, row) for row in carried]
    assert seen == [_sector(offset) for offset in offsets[carried]]
    assert [] in seen
    assert all([number] in seen for number in (1, 2, 3))


def _directions(alpha):
    return np.stack([np.cos(np.radians(alpha)), np.sin(np.radians(alpha))], axis=-1)


def _sector(offset):
    if abs(offset) > 15.0:
        return []
    return [1] if offset < -5.0 else [2] if offset <= 5.0 else [3]


def test_ignore_judges_what_is_in_view_from_j2():
    away, seen = (play(STILL, {GREEN: seen_from_end(50.0, d)}, action=IGNORE) for d in (15.1, 14.9))
    assert (away.steps, away.success, away.fitness) == (100, True, 2.0)
    assert (seen.steps, seen.success, seen.fitness) == (250, False, 0.0)


@pytest.mark.parametrize("f3_time", ["end", "best"])
def test_f3_asks_for_the_target_in_view_from_j2(f3_time):
    readings = replace(END, f3_time=f3_time)
    seen, unseen = (
        play(UNBEND, {GREEN: seen_from_end(70.0, d)}, action=MOVE, readings=readings) for d in (14.0, 16.0)
    )
    assert seen.scores.f3[0, 0] == 1.0
    assert unseen.scores.f3[0, 0] == 0.0


def test_being_on_target_stays_an_angle_at_j1():
    """A disc at 150 cm and 4.5 degrees from J1 is 13 degrees off as seen from J2, and on target."""
    assert play(STILL, {GREEN: (150.0, 64.5)}).success
    assert not play(STILL, {GREEN: (150.0, 64.7)}).success


@pytest.mark.parametrize("readings", [J1, END], ids=["J1", "end"])
def test_words_change_when_the_target_is_first_in_view_of_the_camera(readings):
    trial = one_trial(INDICATE, GREEN, 40.0, {GREEN: (150.0, 90.0)})
    changes = LabelChanges(*(np.array([code]) for code in (TOUCH, GREEN, INDICATE, GREEN, 0)))
    genotype = steady_controller(*LEFT_TURN, readings)
    record = record_trial(genotype, replace(trial, changes=changes), readings)
    first = int(np.argmax(in_view(record.alpha, record.discs[:, GREEN], readings)))
    assert first == {"J1": 13, "end": 16}[readings.camera_origin]
    np.testing.assert_array_equal(record.inputs[:first, 15:], [[1, 0, 1]] * first)
    np.testing.assert_array_equal(record.inputs[first:, 15:], [[1, 1, 0]] * (record.steps - first))
