"""The record of readings: presets, what it derives, and what it refuses."""

import re
from dataclasses import fields, replace

import numpy as np
import pytest

from arm2d import Readings
from arm2d.readings import PLAIN, PRESETS, choices


def test_plain_readings_are_the_printed_numbers_in_their_simplest_meaning():
    readings = PLAIN
    assert (readings.mutation_probability, readings.mutation_sd) == (0.4, 0.1)
    assert (readings.object_radius, readings.sector_half_width) == (5.0, 10.0)
    assert readings.sector_centres == (30.0, 90.0, 150.0)
    assert readings.start_intervals == ((56.0, 64.0), (116.0, 124.0))


def test_printed_preset_lets_ignore_run_on_and_nothing_else():
    assert PRESETS["printed"].ignore_stops == "never"
    assert PRESETS["printed"].with_values({"ignore_stops": "early"}) == PLAIN


def test_start_areas_follow_the_sectors():
    assert replace(PLAIN, sector_centres=(45.0, 90.0, 135.0)).start_intervals == (
        (63.5, 71.5),
        (108.5, 116.5),
    )
    assert replace(PLAIN, start_areas="bounds").start_intervals == ((-30.0, 0.0), (180.0, 210.0))
    assert replace(PLAIN, start_half_width=0.0).start_intervals == ((60.0, 60.0), (120.0, 120.0))


def test_cones_are_the_printed_ones_and_indicates_may_be_wide():
    assert (PLAIN.target_cone, PLAIN.indicate_cone) == (4.6, 4.6)
    wide = replace(PLAIN, indicate_angle="wide")
    assert (wide.target_cone, wide.indicate_cone) == (4.6, 30.0)


def test_whole_numbers_are_written_like_their_fractions():
    whole = Readings.from_mapping({"object_radius": 8, "sector_centres": [45, 90, 135]})
    assert repr(whole) == repr(replace(PLAIN, object_radius=8.0, sector_centres=(45.0, 90.0, 135.0)))


@pytest.mark.parametrize("values", [{"mutation_sd": 10**400}, {"sector_centres": [30, 90, -(10**400)]}])
def test_a_number_that_no_float_can_hold_is_refused_by_name(values):
    (name,) = values
    with pytest.raises(ValueError, match=f"^reading {name} holds a number that no float can hold"):
        Readings.from_mapping(values)


def test_turn_is_the_printed_one_to_a_tenth_of_a_picodegree():
    assert PLAIN.turn_size == pytest.approx(2.9, abs=1e-13)
    assert replace(PLAIN, turn="radians").turn_size == pytest.approx(2.864788975654116, abs=1e-13)


@pytest.mark.parametrize("turn", ["degrees", "radians"])
def test_turn_is_a_whole_number_of_the_steps_that_the_page_rounds_to(turn):
    assert (replace(PLAIN, turn=turn).turn_size * 2**44).is_integer()


def test_sums_of_turns_from_ninety_degrees_are_exact():
    turn = PLAIN.turn_size
    there = [90.0]
    for _ in range(31):
        there.append(there[-1] - turn)
    back = there[-1:]
    for _ in range(31):
        back.append(back[-1] + turn)
    assert back[::-1] == there


def test_readings_survive_the_way_through_plain_values():
    readings = replace(PLAIN, turn="radians", sector_centres=(45.0, 90.0, 135.0))
    assert Readings.from_mapping(readings.to_mapping()) == readings


def test_every_field_is_documented_in_the_source():
    import inspect

    source = inspect.getsource(Readings)
    for each in fields(Readings):
        _, _, after = source.partition(f"    {each.name}:")
        assert after.splitlines()[1].strip().startswith('"""'), each.name


def test_every_choice_between_words_names_the_plain_one_first():
    assert {name: words[0] for name, words in choices().items()} == {
        name: getattr(PLAIN, name) for name in choices()
    }


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ({"object_radios": 5.0}, "unknown reading 'object_radios'; there are mutation_probability, "),
        ({"turn": "gradians"}, "reading turn = 'gradians'; choose degrees or radians"),
        ({"object_radius": 12.0}, r"reading object_radius = 12 must lie in \[0.1, 11.8\]"),
        ({"object_radius": "5"}, r"reading object_radius = '5' is not of the kind of its default \d\.0"),
        ({"mutation_probability": float("nan")}, "reading mutation_probability = nan must lie in"),
        ({"sector_centres": [90.0, 30.0, 150.0]}, "give three rising bearings"),
        ({"sector_centres": [30.0, 90.0]}, "give three rising bearings"),
        ({"tau_exponent_max": True}, "reading tau_exponent_max = True is not of the kind"),
    ],
)
def test_unsound_reading_is_refused_with_what_would_be_right(values, message):
    with pytest.raises(ValueError, match=message):
        Readings.from_mapping(values)


@pytest.mark.parametrize(
    ("centres", "half_width", "span"),
    [((-15.0, 0.0, 15.0), 30.0, "-37.5 and 37.5"), ((160.0, 180.0, 195.0), 25.0, "145 and 212.5")],
)
def test_start_areas_in_which_s1_cannot_stand_are_refused(centres, half_width, span):
    sentence = (
        f"with sector_centres = {centres}, start_half_width = {half_width:g} and start_areas = 'between', "
        f"S1 would start between {span} degrees; it turns from -30 to 210"
    )
    with pytest.raises(ValueError, match=f"^{re.escape(sentence)}$"):
        Readings(sector_centres=centres, start_half_width=half_width)
    assert Readings(sector_centres=centres, start_half_width=half_width, start_areas="bounds")


def test_start_areas_may_reach_the_bounds():
    assert Readings(sector_centres=(-10.0, 10.0, 30.0), start_half_width=30.0).start_intervals[0] == (-30, 30)
    assert Readings(sector_centres=(150, 170, 190), start_half_width=30).start_intervals[1] == (150, 210)


@pytest.mark.parametrize(
    "values", [{"object_radius": "5"}, {"sector_centres": 5}, {"turn": 2.9}, {"crossover": None}]
)
def test_a_value_of_another_kind_is_refused_by_the_record_itself(values):
    with pytest.raises(ValueError, match="is not of the kind of its default"):
        replace(PLAIN, **values)


def test_numbers_of_any_kind_make_the_same_record():
    plain = replace(PLAIN, object_radius=8.0, sector_centres=(45.0, 90.0, 135.0))
    for radius, centres in ((8, [45, 90, 135]), (np.float64(8), tuple(np.array([45, 90, 135])))):
        made = replace(PLAIN, object_radius=radius, sector_centres=centres)
        assert made == plain
        assert repr(made.to_mapping()) == repr(plain.to_mapping())


@pytest.mark.parametrize(
    ("name", "low", "high"),
    [
        ("mutation_probability", 0.0, 1.0),
        ("mutation_sd", 0.0, 1.0),
        ("crossover", 0.0, 1.0),
        ("tau_exponent_max", -1.0, 3.0),
        ("object_radius", 0.1, 11.8),
        ("sector_half_width", 0.1, 30.0),
        ("start_half_width", 0.0, 30.0),
    ],
)
def test_a_bound_is_allowed_and_what_lies_just_beyond_it_is_not(name, low, high):
    for bound, beyond in ((low, -np.inf), (high, np.inf)):
        assert getattr(replace(PLAIN, **{name: bound}), name) == bound
        with pytest.raises(ValueError, match=rf"reading {name} = .* must lie in \[{low:g}, {high:g}\]"):
            replace(PLAIN, **{name: float(np.nextafter(bound, beyond))})


def test_centres_given_as_a_list_can_be_compared_and_counted():
    assert {replace(PLAIN, sector_centres=[30.0, 90.0, 150.0])} == {PLAIN}


def test_unknown_preset_lists_the_known_ones():
    with pytest.raises(
        ValueError, match=f"unknown preset of readings 'bold'; there are {', '.join(PRESETS)}"
    ):
        Readings.preset("bold")
