import numpy as np
import pytest

from arm2d import ActionWord, Condition, Instruction, ObjectWord, Readings, reference, run_trials
from evolution.agents.behaviour import draw_behaviour_trials, record_behaviour
from evolution.agents.lesions import LESIONS, Lesion, lesion_scores, lesioned_trials
from evolution.figures.behaviour import lesions_figure

INDICATE = Condition.WITH_INDICATE
READINGS = Readings()


@pytest.mark.parametrize("condition", Condition)
@pytest.mark.parametrize("lesion", LESIONS, ids=lambda each: f"{each.word}-{each.manner}-{each.time}")
def test_lesions_are_those_of_the_plain_reference(lesion, condition, evolved, monkeypatch):
    genotype = evolved[7]
    trials = draw_behaviour_trials(condition, READINGS, 1, 5)
    for target in ObjectWord:
        own = trials[np.flatnonzero(trials.objects == target)]
        for heard, codes in lesioned_trials(own, target, lesion, condition):
            with monkeypatch.context() as patch:
                patch.setitem(vars(reference.PAPERS), "code_lists", codes.tolist())
                compare_with_reference(genotype, heard, codes)


def compare_with_reference(genotype, heard, codes):
    scores, changes = run_trials(genotype, heard, READINGS, word_codes=codes), heard.changes
    for i, instruction in enumerate(heard.instructions):
        first = Instruction(ActionWord(changes.first_actions[i]), ObjectWord(changes.first_objects[i]))
        later = Instruction(ActionWord(changes.later_actions[i]), ObjectWord(changes.later_objects[i]))
        expected = reference.run_trial(
            genotype, instruction, heard.alpha[i], heard.discs[i], READINGS, (first, later, 0)
        )
        assert scores.steps[0, i] == expected.steps
        assert scores.success[0, i] == expected.success
        assert scores.fitness[0, i] == pytest.approx(expected.f1 + expected.f2 + expected.f3, abs=1e-9)


def test_a_conditions_name_is_as_good_as_the_condition_and_another_task_is_refused(evolved_agent):
    named, meant = (
        lesion_scores(evolved_agent, condition, READINGS, per_area=1)
        for condition in ("with-indicate", INDICATE)
    )
    np.testing.assert_array_equal(named.lesioned, meant.lesioned)
    watched = record_behaviour(evolved_agent, "with-indicate", READINGS, per_area=1)
    assert watched.condition is INDICATE
    for analysis in (lesion_scores, record_behaviour):
        with pytest.raises(ValueError, match=r"this .* is made for the paper's two conditions"):
            analysis(evolved_agent, "with-both", READINGS, per_area=1)


def test_exactly_the_lesioned_word_is_replaced_at_its_time():
    trials = draw_behaviour_trials(INDICATE, READINGS, 1, 0)
    own = trials[np.flatnonzero(trials.objects == ObjectWord.GREEN)]
    ((silent, codes),) = lesioned_trials(
        own, ObjectWord.GREEN, Lesion("action", "before sight", "silenced"), INDICATE
    )
    changes = silent.changes
    assert codes[3 + changes.first_actions].tolist() == [[0, 0, 0]] * len(own)
    assert np.array_equal(changes.later_actions, own.actions)
    assert np.array_equal(changes.first_objects, own.objects)
    for heard, _ in lesioned_trials(
        own, ObjectWord.GREEN, Lesion("object", "after sight", "exchanged"), INDICATE
    ):
        assert np.array_equal(heard.changes.first_objects, own.objects)
        assert not np.any(heard.changes.later_objects == own.objects)
        assert np.array_equal(heard.changes.later_actions, own.actions)


def test_intact_agents_score_as_in_the_trials_that_are_watched(evolved_agent):
    behaviour = record_behaviour(evolved_agent, INDICATE, READINGS, per_area=5)
    scores = lesion_scores([evolved_agent, np.full(84, 0.5)], INDICATE, READINGS, per_area=5)
    assert scores.lesioned.shape == (2, 8, 9)
    assert np.array_equal(scores.intact[0], behaviour.success.reshape(9, -1).mean(axis=1))


def test_an_agent_deaf_to_words_does_not_mind_lesions(evolved_agent):
    deaf = evolved_agent.copy()
    deaf[36:54] = 0.5  # weights of I13 to I18 become 0
    scores = lesion_scores(deaf, INDICATE, READINGS, per_area=2)
    assert np.array_equal(scores.lesioned[0], np.repeat(scores.intact, 8, axis=0))


def test_lesions_figure_shows_the_mean_over_agents(evolved):
    scores = lesion_scores(evolved[:2], INDICATE, READINGS, per_area=1)
    figure = lesions_figure(scores, "two agents")
    shown = [text.get_text() for text in figure.axes[0].texts][:9]
    expected = np.concatenate([scores.intact.mean(axis=0)[:1], scores.lesioned.mean(axis=0)[:, 0]])
    assert shown == [f"{100 * each:.0f}" for each in expected]


def test_an_exchanged_word_counts_as_the_mean_over_both_others(evolved):
    """Both substitutes alone, by instruction; agents for which they differ."""
    agents = evolved[[7, 15]]
    trials = draw_behaviour_trials(INDICATE, READINGS, 2, 0)
    scores = lesion_scores(agents, INDICATE, READINGS, per_area=2)
    differ = 0
    for place, lesion in enumerate(LESIONS):
        if lesion.manner != "exchanged":
            continue
        alone = np.full((2, *scores.intact.shape), np.nan)  # [substitutes, P, 9]
        for number in range(9):
            own = trials[np.arange(4 * number, 4 * number + 4)]
            both = lesioned_trials(own, ObjectWord(number % 3), lesion, INDICATE)
            for substitute, (heard, codes) in enumerate(both):
                success = run_trials(agents, heard, READINGS, word_codes=codes).success
                alone[substitute, :, number] = success.mean(axis=1)
        differ += (alone[0] != alone[1]).sum()
        np.testing.assert_allclose(scores.lesioned[:, place], alone.mean(axis=0), rtol=0, atol=1e-15)
    assert differ > 10
