from dataclasses import replace

import numpy as np
import pytest

from arm2d import ActionWord, Condition, Instruction, ObjectWord, Readings
from evolution.agents.behaviour import record_behaviour
from evolution.agents.variance import AFTER, BEFORE, align, mean_by_instruction, variance_shares

INDICATE = Condition.WITH_INDICATE


@pytest.fixture(scope="module")
def behaviour(evolved_agent):
    return record_behaviour(evolved_agent, INDICATE, Readings(), per_area=5)


def made_up(behaviour, activity, rows=None):
    """The same trials with other activity, all seen in row 40."""
    sight = np.full(len(behaviour), 40) if rows is None else rows
    return replace(behaviour, activity=activity, first_sight=sight)


def constant_activity(values):
    """Values [T, 3] in every row."""
    return np.repeat(values[:, np.newaxis], 251, axis=1)


def test_aligned_activity_has_the_event_in_the_same_bin():
    activity = np.arange(251.0)[np.newaxis, :, np.newaxis].repeat(2, axis=0)
    aligned = align(activity, np.array([40, -1]))[..., 0]
    assert aligned[0, BEFORE] == 40
    assert aligned[0, 0] == 40 - BEFORE
    assert aligned[0, -1] == 40 + AFTER
    assert np.isnan(aligned[1]).all()


def test_alignment_ends_with_the_trial():
    activity = np.zeros((1, 251, 1))
    early, late = align(activity, np.array([3]))[0, :, 0], align(activity, np.array([250]))[0, :, 0]
    assert np.isnan(early[: BEFORE - 3]).all()
    assert np.isfinite(early[BEFORE - 3 :]).all()
    assert np.isnan(late[BEFORE + 1 :]).all()


def test_activity_that_follows_one_word_is_explained_by_it_alone(behaviour):
    for word, expected in (("object", (1, 0, 0)), ("action", (0, 1, 0))):
        values = getattr(behaviour, f"{word}s")[:, np.newaxis] * np.array([0.1, 0.2, 0.4])
        shares = variance_shares(made_up(behaviour, constant_activity(values)), np.full(90, 40))
        assert shares.mean(-1, 1) == pytest.approx(expected, abs=1e-12)


def test_activity_that_needs_both_words_is_crossed(behaviour):
    # The action word's effect is the opposite for another object: no main effect is left.
    sign = np.array([[1, -1, 0], [-1, 1, 0], [0, 0, 0]])[behaviour.actions, behaviour.objects]
    values = 0.5 + 0.1 * sign[:, np.newaxis] * np.ones(3)
    shares = variance_shares(made_up(behaviour, constant_activity(values)), np.full(90, 40))
    assert shares.mean(0, 0) == pytest.approx((0, 0, 1), abs=1e-12)


def test_noise_is_explained_by_no_word_but_for_chance(behaviour):
    noise = np.random.default_rng(1).random((90, 251, 3))
    shares = variance_shares(made_up(behaviour, noise), np.full(90, 40))
    # 2, 2 and 4 degrees of freedom of 89, with room for chance in 61 bins of three neurons.
    for mean, degrees in zip(shares.mean(-3, 6), (2, 2, 4), strict=True):
        assert mean == pytest.approx(degrees / 89, abs=0.01)


def test_shares_add_up_to_one_and_ignore_how_many_trials_are_left(behaviour):
    values = behaviour.objects[:, np.newaxis] * np.full(3, 0.2) + 0.05 * behaviour.areas[:, np.newaxis]
    activity = constant_activity(values)
    activity[behaviour.of(Instruction(ActionWord.MOVE, ObjectWord.RED))[::3], 60:] = np.nan
    shares = variance_shares(made_up(behaviour, activity), np.full(90, 40))
    total = shares.object + shares.action + shares.crossed + shares.rest
    assert total[np.isfinite(total)] == pytest.approx(1, abs=1e-12)
    assert np.isfinite(total[BEFORE + 20])


def test_bins_with_too_few_trials_are_not_counted(behaviour):
    activity = constant_activity(np.random.default_rng(2).random((90, 3)))
    own = behaviour.of(Instruction(ActionWord.MOVE, ObjectWord.RED))
    activity[own[:6], 61:] = np.nan  # four of ten left
    shares = variance_shares(made_up(behaviour, activity), np.full(90, 40))
    assert np.isfinite(shares.object[BEFORE + 20])
    assert np.isnan(shares.object[BEFORE + 21 :]).all()


def test_action_words_that_never_come_to_an_event_take_no_part(behaviour):
    activity = constant_activity(np.random.default_rng(3).random((90, 3)))
    rows = np.where(behaviour.actions == 2, -1, 40)
    assert variance_shares(made_up(behaviour, activity), rows).actions.tolist() == [0, 1]
    nobody = variance_shares(made_up(behaviour, activity), np.full(90, -1))
    assert np.isnan(nobody.object).all()
    assert np.isnan(nobody.mean(-1, 1)).all()


def test_still_neurons_have_no_shares(behaviour):
    shares = variance_shares(made_up(behaviour, np.full((90, 251, 3), 0.5)), np.full(90, 40))
    assert np.isnan(shares.object).all()


def test_mean_activity_is_that_of_the_instructions_trials(behaviour):
    means = mean_by_instruction(behaviour, np.zeros(90, np.int64))
    own = behaviour.activity[behaviour.instructions == 4, 7]
    assert means[4, BEFORE + 7] == pytest.approx(own.mean(axis=0), rel=1e-12)
