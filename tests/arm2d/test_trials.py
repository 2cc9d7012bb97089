"""Drawing trials (spec section 2) and the record that holds them."""

from dataclasses import replace

import numpy as np
import pytest

from arm2d import Condition, LabelChanges, Task, Trials, draw_trials
from arm2d.readings import PLAIN
from arm2d.trials import _chord_ends

INSTRUCTIONS = Condition.WITH_INDICATE.instructions


def draw(readings=None, per_area=50, seed=0):
    return draw_trials(INSTRUCTIONS, per_area, readings or PLAIN, np.random.default_rng(seed))


@pytest.mark.parametrize("readings", [PLAIN, replace(PLAIN, start_areas="bounds")])
def test_half_of_each_instructions_trials_start_in_each_area(readings):
    (right, left), trials = readings.start_intervals, draw(readings)
    alpha = trials.alpha.reshape(9, 2, 50)
    assert right[0] <= alpha[:, 0].min() < alpha[:, 0].max() <= right[1]
    assert left[0] <= alpha[:, 1].min() < alpha[:, 1].max() <= left[1]
    assert trials.instructions == [each for each in INSTRUCTIONS for _ in range(100)]


@pytest.mark.parametrize("half_width", [3.0, 10.0])
def test_discs_lie_on_the_chords_of_their_sectors(half_width):
    readings = replace(PLAIN, sector_half_width=half_width)
    discs = draw(readings).discs
    for disc, centre in enumerate(readings.sector_centres):
        axis = np.radians(centre)
        along = discs[:, disc] @ [np.cos(axis), np.sin(axis)]
        across = discs[:, disc] @ [-np.sin(axis), np.cos(axis)]
        np.testing.assert_allclose(along, 150 * np.cos(np.radians(half_width)), rtol=1e-12)
        half_chord = 150 * np.sin(np.radians(half_width))
        assert np.abs(across).max() <= half_chord + 1e-9
        assert across.min() < -0.95 * half_chord
        assert across.max() > 0.95 * half_chord


def test_the_three_discs_are_drawn_independently():
    discs = draw(per_area=500).discs
    across = [(discs[:, k] - discs[:, k].mean(axis=0)) @ (discs[0, k] - discs[1, k]) for k in range(3)]
    correlations = np.corrcoef(across)[np.triu_indices(3, 1)]
    assert np.abs(correlations).max() < 0.05


def test_no_object_is_in_view_at_the_start():
    trials = draw(per_area=200)
    bearings = np.degrees(np.arctan2(trials.discs[..., 1], trials.discs[..., 0]))
    assert np.abs(bearings - trials.alpha[:, np.newaxis]).min() > 15


def test_same_generator_state_draws_the_same_trials():
    np.testing.assert_array_equal(draw(seed=4).discs, draw(seed=4).discs)
    assert not np.array_equal(draw(seed=4).discs, draw(seed=5).discs)


def test_indexing_gives_a_batch():
    trials = draw()
    assert len(trials[3]) == 1
    assert len(trials[2:6]) == 4
    assert trials[-1].alpha[0] == trials.alpha[-1]
    with pytest.raises(IndexError, match="trial 900 does not exist; there are 900"):
        trials[900]


def test_trials_are_read_only():
    with pytest.raises(ValueError, match="read-only"):
        draw().alpha[0] = 0.0


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"actions": [4]}, "actions holds 4 to 4; the codes are 0 to 3"),
        ({"objects": [0.5]}, "objects must be a row of whole numbers"),
        ({"alpha": [300.0]}, r"alpha must lie in \[-30, 210\] degrees"),
        ({"alpha": [np.nan]}, r"alpha must lie in \[-30, 210\] degrees"),
        ({"alpha": [np.inf]}, r"alpha must lie in \[-30, 210\] degrees"),
        ({"alpha": [-np.inf]}, r"alpha must lie in \[-30, 210\] degrees"),
        ({"discs": np.zeros((1, 3, 2))}, "a disc's centre lies within 100 cm of J1"),
        ({"discs": np.full((1, 3, 2), np.inf)}, "a disc's centre is not a number"),
        ({"discs": np.zeros((2, 3, 2))}, r"1 actions need objects \[1\], alpha \[1\] and discs \[1, 3, 2\]"),
    ],
)
def test_unsound_trials_are_refused(change, message):
    trial = draw()[0]
    values = {"actions": trial.actions, "objects": trial.objects, "alpha": trial.alpha, "discs": trial.discs}
    with pytest.raises(ValueError, match=message):
        Trials(**{**values, **{name: np.array(value) for name, value in change.items()}})


def test_no_trials_at_all_is_refused():
    with pytest.raises(ValueError, match="asked for 0 trials per area of 9 instructions"):
        draw(per_area=0)


def changes(**values):
    """Words of one trial that change, one array being another."""
    sound = dict.fromkeys(("first_actions", "first_objects", "later_actions", "later_objects", "delays"), 0)
    return LabelChanges(**{name: np.array([value]) for name, value in {**sound, **values}.items()})


@pytest.mark.parametrize(
    ("name", "numbers", "highest"),
    [
        ("first_actions", "codes", 3),
        ("first_objects", "codes", 2),
        ("later_actions", "codes", 3),
        ("later_objects", "codes", 2),
        ("delays", "numbers of steps", 250),
    ],
)
def test_changes_of_words_are_taken_up_to_their_bounds_and_not_beyond(name, numbers, highest):
    for value in (0, highest):
        assert getattr(changes(**{name: value}), name).tolist() == [value]
    for value in (-1, highest + 1):
        with pytest.raises(
            ValueError, match=f"{name} holds {value} to {value}; the {numbers} are 0 to {highest}"
        ):
            changes(**{name: value})


def start(**values):
    """A trial that starts in the middle with discs far away, one array being another."""
    far = np.array([[[120.0, 0.0], [0.0, 120.0], [-120.0, 0.0]]])
    sound = {"actions": np.array([0]), "objects": np.array([0]), "alpha": np.array([90.0]), "discs": far}
    return Trials(**{**sound, **values})


@pytest.mark.parametrize(("name", "highest"), [("actions", 3), ("objects", 2)])
def test_instructions_are_taken_up_to_their_bounds_and_not_beyond(name, highest):
    for value in (0, highest):
        assert getattr(start(**{name: np.array([value])}), name).tolist() == [value]
    for value in (-1, highest + 1):
        with pytest.raises(ValueError, match=f"{name} holds {value} to {value}"):
            start(**{name: np.array([value])})


def test_start_angles_are_taken_up_to_their_bounds_and_not_beyond():
    for alpha in (-30.0, 210.0):
        assert start(alpha=np.array([alpha])).alpha.tolist() == [alpha]
    for alpha in (np.nextafter(-30.0, -90.0), np.nextafter(210.0, 270.0)):
        with pytest.raises(ValueError, match="alpha must lie in"):
            start(alpha=np.array([alpha]))


@pytest.mark.parametrize("disc", range(3))
@pytest.mark.parametrize("bearing", [0.0, 37.0, 180.0, 270.0])
def test_discs_are_taken_from_where_s2_can_be_and_not_nearer(disc, bearing):
    direction = np.array([np.cos(np.radians(bearing)), np.sin(np.radians(bearing))])
    discs = start().discs.copy()
    discs[0, disc] = 100.001 * direction
    assert len(start(discs=discs)) == 1
    for distance in (99.999, 75.0, 51.0, 1.0):
        discs[0, disc] = distance * direction
        with pytest.raises(ValueError, match="a disc's centre lies within 100 cm of J1"):
            start(discs=discs)


def test_number_of_changes_is_that_of_the_trials():
    with pytest.raises(ValueError, match="1 trials need as many label changes, not 2"):
        start(changes=LabelChanges(*(np.zeros(2, np.int64) for _ in range(5))))


def test_rows_of_changes_are_equally_long():
    one, two = np.zeros(1, np.int64), np.zeros(2, np.int64)
    with pytest.raises(ValueError, match=r"have the lengths 2, 2, 2, 2, 1; they must be equally long"):
        LabelChanges(two, two, two, two, one)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (
            {"readings": "plain"},
            r"readings = 'plain' must be a record, such as .*Readings.preset\('plain'\)$",
        ),
        ({"readings": None}, "readings = None must be a record"),
        ({"rng": 1}, r"rng = 1 must be a generator, such as numpy.random.default_rng\(1\)"),
        ({"per_area": 2.5}, "per_area = 2.5 must be a whole number of trials"),
        ({"per_area": "2"}, "per_area = '2' must be a whole number of trials"),
        ({"instructions": 5}, "5 is no instruction; give text such as 'touch green'"),
        ({"instructions": ["touch red", None]}, "None is no instruction"),
        ({"task": 5}, "5 is no task; give an arm2d.Task, or with-indicate, with-ignore or with-both"),
        (
            {"task": "with-grasp"},
            "unknown condition 'with-grasp'; there are with-indicate, with-ignore, with-b",
        ),
    ],
)
def test_what_trials_cannot_be_drawn_from_is_named_with_what_would_be_right(change, message):
    sound = {"instructions": INSTRUCTIONS, "per_area": 2, "readings": PLAIN, "rng": np.random.default_rng(1)}
    assert len(draw_trials(**sound)) == 36
    with pytest.raises(ValueError, match=message):
        draw_trials(**{**sound, **change})


def test_a_whole_number_of_numpy_is_a_number_of_trials():
    assert len(draw(per_area=np.int64(2))) == 36


def test_instructions_are_those_of_the_task_that_is_given_and_any_where_none_is():
    rng = np.random.default_rng(1)
    assert len(draw_trials("ignore red", 1, PLAIN, rng)) == 2
    for task in (Task(), Condition.WITH_INDICATE, "with-indicate"):
        with pytest.raises(
            ValueError,
            match=r"^with-indicate has no instruction IGNORE Red; it has MOVE Blue, .* INDICATE Red$",
        ):
            draw_trials(["touch red", "ignore red"], 1, PLAIN, rng, task)
    for task in (Task(third="both"), Condition.WITH_IGNORE, "with-both"):
        assert len(draw_trials("ignore red", 1, PLAIN, rng, task)) == 2


def test_trials_keep_a_task_of_ones_own_and_none_of_the_papers():
    for papers in (None, Task(), Condition.WITH_IGNORE, "with-ignore"):
        assert start(task=papers).task is None
    for own in (Task(third="both"), "with-both"):
        assert start(task=own).task == Task(third="both")
    with pytest.raises(ValueError, match="5 is no task"):
        start(task=5)


def test_so_many_trials_that_no_memory_holds_them_are_refused():
    with pytest.raises(ValueError, match="asked for 100001 trials per area; at most 100000 fit"):
        draw(per_area=100_001)


def test_what_is_kept_for_the_next_draw_cannot_be_changed():
    with pytest.raises(ValueError, match="read-only"):
        _chord_ends(PLAIN)[:] = 0.0
