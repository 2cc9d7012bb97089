from dataclasses import replace

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
)
from arm2d.arithmetic import sigmoid
from arm2d.readings import PLAIN
from evolution.agents.behaviour import draw_behaviour_trials, record_behaviour
from evolution.agents.lineage_scores import offsets
from evolution.agents.variance import events_of, shares_by_event
from evolution.cli import main
from evolution.figures.behaviour import trajectories_figure
from evolution.figures.neurons import activity_figure, variance_figure
from evolution.figures.page import LARGEST_DRAWING
from evolution.figures.states import principal_plane, state_space_figure
from evolution.runs.storage import read_arrays

INDICATE = Condition.WITH_INDICATE
READINGS = Readings()


@pytest.fixture(scope="module")
def behaviour(evolved_agent):
    return record_behaviour(evolved_agent, INDICATE, READINGS, per_area=5)


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
    assert right.min() >= 60 - READINGS.start_half_width
    assert right.max() <= 60 + READINGS.start_half_width
    touch_red = behaviour.of(Instruction(ActionWord.TOUCH, ObjectWord.RED))
    assert set(behaviour.actions[touch_red]) == {1}
    assert set(behaviour.objects[touch_red]) == {2}


def test_trials_of_an_instruction_are_found_by_its_text(behaviour):
    touch_green = Instruction(ActionWord.TOUCH, ObjectWord.GREEN)
    assert behaviour.of("touch green").tolist() == behaviour.of(touch_green).tolist() != []
    with pytest.raises(ValueError, match="with-indicate has no instruction IGNORE Green; it has MOVE Blue, "):
        behaviour.of("ignore green")


def test_first_sight_is_that_of_a_camera_at_the_end_of_s1(evolved_agent):
    end = replace(PLAIN, camera_origin="end")
    behaviour = record_behaviour(evolved_agent, INDICATE, end, per_area=1)
    trials, n_seen, n_later = draw_behaviour_trials(INDICATE, end, 1, 0), 0, 0
    for trial, first in enumerate(behaviour.first_sight):
        record = record_trial(evolved_agent, trials[trial], end)
        target = record.instruction.object
        seen = np.flatnonzero(record.inputs[:, [2 + target, 5 + target, 8 + target]].any(axis=1))
        # White is in the way at the bounds only.
        if len(seen) and np.abs(record.alpha[: seen[0] + 1] - 90.0).max() < 120.0:
            assert first == seen[0]
            n_seen += 1
            n_later += offsets(record.alpha, record.discs[:, target])[first - 1] <= 15.0
    assert n_later == n_seen > 5  # a camera in J1 would have seen the target before


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


def test_principal_plane_finds_the_plane_of_the_points():
    points = np.random.default_rng(4).random((2, 251, 2)) @ np.array([[1.0, 0.0, 1.0], [0.0, 0.5, 0.0]])
    points[1, 100:] = np.nan
    mean, plane, shares = principal_plane(points)
    assert plane.T @ plane == pytest.approx(np.eye(2), abs=1e-12)
    assert shares.sum() == pytest.approx(1)
    assert mean == pytest.approx(np.nanmean(points, axis=(0, 1)))


def test_figures_are_drawn_for_agents_that_do_nothing():
    still = record_behaviour(np.full(84, 0.5), INDICATE, READINGS, per_area=1)
    assert not still.success.any()
    figures = [
        trajectories_figure(still, READINGS, "agent"),
        activity_figure(still, "agent"),
        variance_figure(shares_by_event(still), "agent"),
        state_space_figure(still, "agent"),
    ]
    assert all(figure.axes for figure in figures)


def test_trajectories_name_every_instruction_and_the_never_met(behaviour):
    figure = trajectories_figure(behaviour, READINGS, "agent")
    titles = [axes.get_title(loc="left") for axes in figure.axes if axes.get_title(loc="left")]
    assert titles == [str(each) for each in INDICATE.instructions]
    never_met = [
        axes.get_title(loc="left") for axes in figure.axes if "never met" in axes.get_title(loc="right")
    ]
    assert never_met == ["MOVE Blue", "TOUCH Green"]


def test_events_are_start_sight_and_touch(behaviour):
    start, sight, touch = events_of(behaviour).values()
    assert not start.any()
    assert sight is behaviour.first_sight
    assert touch is behaviour.first_touch


def test_command_writes_figures_and_arrays(finished_run, tmp_path, capsys):
    flags = ["--generation=229", "--trials-per-area=5", f"--output={tmp_path}"]
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
    assert arrays["activity"].shape == (90, 251, 3)
    assert arrays["lesioned"].shape == (1, 8, 9)
    assert max(path.stat().st_size for path in tmp_path.glob("*.svg")) <= LARGEST_DRAWING


def test_command_answers_bad_input_with_one_sentence(finished_run, capsys):
    assert main(["behaviour", str(finished_run), "--trials-per-area=0"]) == 2
    assert main(["behaviour", "nobody"]) == 2
    errors = capsys.readouterr().err.splitlines()
    assert len(errors) == 2
    assert "asked for 0 trials per area" in errors[0]
    assert "there is no 'nobody'" in errors[1]
