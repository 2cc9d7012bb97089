"""Transition tests (spec section 10)."""

import numpy as np
import pytest

from arm2d import NON_EXPERIENCED, Condition, Readings, record_trial, run_trials
from evolution.agents.transitions import (
    action_transitions,
    draw_transition_trials,
    object_transitions,
    passes,
    transition_successes,
)


@pytest.mark.parametrize("condition", Condition)
@pytest.mark.parametrize("transitions_of", [action_transitions, object_transitions])
def test_fourteen_transitions_are_left_when_never_met_instructions_are_not_scored(condition, transitions_of):
    transitions = transitions_of(condition)
    assert len(set(transitions)) == 14
    assert not {each.scored for each in transitions} & set(NON_EXPERIENCED)


def test_action_transition_is_scored_by_the_later_word_and_object_transition_by_the_first():
    for each in action_transitions(Condition.WITH_IGNORE):
        assert each.scored == each.after
        assert each.before.object == each.after.object
        assert each.before.action != each.after.action
    for each in object_transitions(Condition.WITH_IGNORE):
        assert each.scored == each.before
        assert each.before.action == each.after.action
        assert each.before.object != each.after.object


def test_words_change_once_within_ten_steps_of_first_sight(evolved_agent):
    transitions = action_transitions(Condition.WITH_INDICATE)
    trials = draw_transition_trials(transitions, Readings(), np.random.default_rng(0))
    seen = 0
    for t in range(0, len(trials), 40):
        record = record_trial(evolved_agent, trials[t])
        target = record.discs[1:, record.instruction.object]
        bearing = np.degrees(np.arctan2(target[:, 1], target[:, 0]))
        in_view = np.abs(bearing - record.alpha[1:]) <= 15
        changes = np.flatnonzero((np.diff(record.inputs[:, 12:], axis=0) != 0).any(axis=1)) + 1
        if not in_view[:-10].any():
            continue
        seen += 1
        first = int(np.argmax(in_view)) + 1  # the first step that could hear the new word
        assert len(changes) == 1
        assert 0 <= changes[0] - first < 10
    assert seen > 5


def test_all_genotypes_meet_the_same_trials(evolved_agent):
    transitions = object_transitions(Condition.WITH_INDICATE)
    pair = np.stack([evolved_agent, evolved_agent])
    successes = transition_successes(pair, transitions, Readings(), np.random.default_rng(1))
    assert successes.shape == (2, 14)
    np.testing.assert_array_equal(successes[0], successes[1])


def test_transition_to_the_same_words_is_a_plain_trial(evolved_agent):
    transitions = action_transitions(Condition.WITH_INDICATE)
    same = tuple(type(each)(each.scored, each.scored, each.scored) for each in transitions)
    trials = draw_transition_trials(same, Readings(), np.random.default_rng(2))
    plain = type(trials)(trials.actions, trials.objects, trials.alpha, trials.discs)
    changed, unchanged = run_trials(evolved_agent, trials), run_trials(evolved_agent, plain)
    np.testing.assert_array_equal(changed.fitness, unchanged.fitness)


def test_no_agents_make_an_empty_table():
    none = transition_successes(
        np.empty((0, 84)), action_transitions(Condition.WITH_IGNORE), Readings(), np.random.default_rng(0)
    )
    assert none.shape == (0, 14)


def test_passing_takes_more_than_sixty_of_eighty_in_every_transition():
    assert passes(np.array([[61, 61], [60, 80], [80, 80]])).tolist() == [True, False, True]
