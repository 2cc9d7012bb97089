"""Transition tests (spec section 10)."""

import shutil

import numpy as np
import pytest

from arm2d import NON_EXPERIENCED, Condition, Readings, draw_trials, record_trial, run_trials
from arm2d.readings import PLAIN
from evolution.agents.parts import late_history, late_spans
from evolution.agents.postevaluation import POST_EVALUATION
from evolution.agents.subtasks import AgentClass
from evolution.agents.transitions import (
    CLASSES,
    action_transitions,
    draw_transition_trials,
    object_transitions,
    passes,
    run_transition_test,
    transition_successes,
)
from evolution.runs.folder import RunFolder
from evolution.runs.storage import make_folder
from evolution.search.randomness import Purpose, generator


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


def test_words_change_once_within_ten_steps_of_first_sight(evolved_plain):
    transitions = action_transitions(Condition.WITH_INDICATE)
    trials = draw_transition_trials(transitions, PLAIN, np.random.default_rng(0))
    seen = 0
    for t in range(0, len(trials), 40):
        record = record_trial(evolved_plain[15], trials[t], PLAIN)
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


@pytest.fixture(scope="module")
def tested(finished_run, tmp_path_factory):
    """A run all of whose late agents count as fully compositional, whatever they can do, tested."""
    run = RunFolder.open(shutil.copytree(finished_run, tmp_path_factory.mktemp("tested") / "run"))
    make_folder(run.path / POST_EVALUATION.folder)
    for span in late_spans(run):
        successes = np.full((len(span), 5, 9), 80, np.int16)
        arrays = {"generations": np.array(span, np.int32), "successes": successes}
        run.write_arrays(POST_EVALUATION.path(run, span), arrays)
    return run, run_transition_test(run)


def test_the_two_tests_draw_from_different_streams(tested):
    """A classed agent does in the test what it does in trials of the stream for transitions."""
    run, found = tested
    late, condition, readings = late_history(run), run.config.condition, run.config.readings
    tests = (action_transitions(condition), object_transitions(condition))
    assert len(found.generations) == 5 * len(late)
    by_purpose = {}
    for purpose in (Purpose.TRANSITIONS, Purpose.POST_EVALUATION):
        rows = []
        for generation, genotypes in zip(late.generations[:12], late.best_genotypes[:12], strict=True):
            rng = generator(run.config.seed, purpose, int(generation))
            rows.append(np.hstack([transition_successes(genotypes, each, readings, rng) for each in tests]))
        by_purpose[purpose] = np.concatenate(rows)
    recorded = np.concatenate([found.action, found.object], axis=1)[:60]
    assert recorded.any()
    np.testing.assert_array_equal(recorded, by_purpose[Purpose.TRANSITIONS])
    assert not np.array_equal(recorded, by_purpose[Purpose.POST_EVALUATION])


def test_starts_of_the_two_tests_differ_in_every_generation():
    condition, readings = Condition.WITH_INDICATE, Readings()
    for generation in (4000, 4001, 5999):
        starts = [
            draw_trials([condition.instructions[1]], 40, readings, generator(1, purpose, generation)).alpha
            for purpose in (Purpose.TRANSITIONS, Purpose.POST_EVALUATION, Purpose.TRIALS)
        ]
        assert len({start.tobytes() for start in starts}) == 3


def test_a_classed_agent_is_named_by_generation_rank_and_class(tested):
    run, found = tested
    generations = late_history(run).generations
    np.testing.assert_array_equal(found.generations, np.repeat(generations, 5))
    np.testing.assert_array_equal(found.ranks, np.tile(np.arange(5), len(generations)))
    assert {CLASSES[each] for each in found.classes} == {AgentClass.FULL}
