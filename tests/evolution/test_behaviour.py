import numpy as np
import pytest

from arm2d import (
    ActionWord,
    Condition,
    Instruction,
    ObjectWord,
    Readings,
    decode,
    record_trial,
    reference,
    run_trials,
)
from arm2d.arithmetic import sigmoid
from evolution.behaviour import draw_behaviour_trials, record_behaviour
from evolution.cli import main
from evolution.events import events_of, shares_by_event
from evolution.figures_behaviour import lesions_figure, trajectories_figure
from evolution.figures_neurons import activity_figure, variance_figure
from evolution.figures_states import principal_plane, state_space_figure
from evolution.lesions import LESIONS, Lesion, lesion_scores, lesioned_trials
from evolution.storage import read_arrays
from evolution.variance import AFTER, BEFORE, align, mean_by_instruction, variance_shares

INDICATE = Condition.WITH_INDICATE
READINGS = Readings()


@pytest.fixture(scope="module")
def behaviour(evolved_agent):
    return record_behaviour(evolved_agent, INDICATE, READINGS, per_area=5)


def made_up(behaviour, activity, rows=None):
    """The same trials with other activity, all seen in row 40."""
    from dataclasses import replace

    sight = np.full(len(behaviour), 40) if rows is None else rows
    return replace(behaviour, activity=activity, first_sight=sight)


def constant_activity(values):
    """Values [T, 3] in every row."""
    return np.repeat(values[:, np.newaxis], 251, axis=1)


def test_activity_is_the_output_of_the_recorded_states(behaviour, evolved_agent):
    trials = draw_behaviour_trials(INDICATE, READINGS, 5, 0)
    record = record_trial(evolved_agent, trials[37], READINGS)
    biases = decode(evolved_agent, READINGS).inter_biases[0]
    for row, neuron in ((1, 0), (5, 2), (record.steps, 1)):
        assert behaviour.activity[37, row, neuron] == sigmoid(record.states[row - 1, neuron] + biases[neuron])
    assert behaviour.activity[37, 0].tolist() == [sigmoid(each) for each in biases]
    assert np.isnan(behaviour.alpha[37, record.steps + 1 :]).all()


def test_trials_stand_in_the_order_of_instructions_and_areas(behaviour):
    assert np.bincount(behaviour.instructions).tolist() == [10] * 9
    right = behaviour.alpha[behaviour.areas == 0, 0]
    assert right.min() >= 56
    assert right.max() <= 64
    touch_red = behaviour.of(Instruction(ActionWord.TOUCH, ObjectWord.RED))
    assert set(behaviour.actions[touch_red]) == {1}
    assert set(behaviour.objects[touch_red]) == {2}


def test_events_are_where_the_record_has_them(behaviour, evolved_agent):
    trials = draw_behaviour_trials(INDICATE, READINGS, 5, 0)
    for trial in range(0, 90, 7):
        record = record_trial(evolved_agent, trials[trial], READINGS)
        target = record.instruction.object
        touched = np.flatnonzero(record.contact[:, target])
        assert behaviour.first_touch[trial] == (touched[0] if len(touched) else -1)
        # Seen in the step after the row of first sight, for the first time (no white is in the way here).
        seen = np.flatnonzero(record.inputs[:, [2 + target, 5 + target, 8 + target]].any(axis=1))
        assert behaviour.first_sight[trial] == (seen[0] if len(seen) else -1)


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


@pytest.mark.parametrize("condition", Condition)
@pytest.mark.parametrize("lesion", LESIONS, ids=lambda each: f"{each.word}-{each.manner}-{each.time}")
def test_lesions_are_those_of_the_plain_reference(lesion, condition, evolved, monkeypatch):
    genotype = evolved[7]
    trials = draw_behaviour_trials(condition, READINGS, 1, 5)
    for target in ObjectWord:
        own = trials[np.flatnonzero(trials.objects == target)]
        for heard, codes in lesioned_trials(own, target, lesion, condition):
            with monkeypatch.context() as patch:
                for row, word in enumerate([*ObjectWord, *ActionWord]):
                    table = reference.OBJECT_CODES if row < 3 else reference.ACTION_CODES
                    patch.setitem(table, word, tuple(codes[row].tolist()))
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


def test_intact_agents_score_as_in_the_trials_that_are_watched(behaviour, evolved_agent):
    scores = lesion_scores([evolved_agent, np.full(84, 0.5)], INDICATE, READINGS, per_area=5)
    assert scores.lesioned.shape == (2, 8, 9)
    assert np.array_equal(scores.intact[0], behaviour.success.reshape(9, -1).mean(axis=1))


def test_an_agent_deaf_to_words_does_not_mind_lesions(evolved_agent):
    deaf = evolved_agent.copy()
    deaf[36:54] = 0.5  # weights of I13 to I18 become 0
    scores = lesion_scores(deaf, INDICATE, READINGS, per_area=2)
    assert np.array_equal(scores.lesioned[0], np.repeat(scores.intact, 8, axis=0))


def test_principal_plane_finds_the_plane_of_the_points():
    points = np.random.default_rng(4).random((2, 251, 2)) @ np.array([[1.0, 0.0, 1.0], [0.0, 0.5, 0.0]])
    points[1, 100:] = np.nan
    mean, plane, shares = principal_plane(points)
    assert plane.T @ plane == pytest.approx(np.eye(2), abs=1e-12)
    assert shares.sum() == pytest.approx(1)
    assert mean == pytest.approx(np.nanmean(points, axis=(0, 1)))


def test_figures_are_drawn_for_agents_that_do_nothing():
    still = record_behaviour(np.full(84, 0.5), INDICATE, READINGS, per_area=1)
    trajectories_figure(still, READINGS, "agent")
    activity_figure(still, "agent")
    variance_figure(shares_by_event(still), "agent")
    state_space_figure(still, "agent")


def test_trajectories_name_every_instruction_and_the_never_met(behaviour):
    figure = trajectories_figure(behaviour, READINGS, "agent")
    titles = [axes.get_title(loc="left") for axes in figure.axes if axes.get_title(loc="left")]
    assert titles == [str(each) for each in INDICATE.instructions]
    never_met = [
        axes.get_title(loc="left") for axes in figure.axes if "never met" in axes.get_title(loc="right")
    ]
    assert never_met == ["MOVE Blue", "TOUCH Green"]


def test_lesions_figure_shows_the_mean_over_agents(evolved):
    scores = lesion_scores(evolved[:2], INDICATE, READINGS, per_area=1)
    figure = lesions_figure(scores, "two agents")
    shown = [text.get_text() for text in figure.axes[0].texts][:9]
    expected = np.concatenate([scores.intact.mean(axis=0)[:1], scores.lesioned.mean(axis=0)[:, 0]])
    assert shown == [f"{100 * each:.0f}" for each in expected]


def test_events_are_start_sight_and_touch(behaviour):
    start, sight, touch = events_of(behaviour).values()
    assert not start.any()
    assert sight is behaviour.first_sight
    assert touch is behaviour.first_touch


def test_command_writes_figures_and_arrays(finished_run, tmp_path, capsys):
    flags = ["--generation=229", "--trials-per-area=1", f"--output={tmp_path}"]
    assert main(["behaviour", str(finished_run), *flags]) == 0
    written = sorted(each.name for each in tmp_path.iterdir())
    kinds = ("activity", "lesions", "state-space", "trajectories", "variance")
    assert written == sorted(
        [f"generation-000229-rank-0-{kind}.{suffix}" for kind in kinds for suffix in ("png", "svg")]
        + ["generation-000229-rank-0-behaviour.npz"]
    )
    output = capsys.readouterr().out
    assert all(name in output for name in written)
    arrays = read_arrays(tmp_path / "generation-000229-rank-0-behaviour.npz")
    assert arrays["activity"].shape == (18, 251, 3)
    assert arrays["lesioned"].shape == (1, 8, 9)


def test_command_answers_bad_input_with_one_sentence(finished_run, capsys):
    assert main(["behaviour", str(finished_run), "--trials-per-area=0"]) == 2
    assert main(["behaviour", "nobody"]) == 2
    errors = capsys.readouterr().err.splitlines()
    assert len(errors) == 2
    assert "asked for 0 trials per area" in errors[0]
    assert "there is no 'nobody'" in errors[1]
