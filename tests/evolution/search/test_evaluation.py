import csv
import io
import json
from dataclasses import fields

import numpy as np
import pytest

from arm2d import Condition, Readings, Task, VectorWorld
from evolution.report.evaluation import instruction_table, terminal_table, to_json
from evolution.runs.sources import Agent
from evolution.search.config import RunConfig
from evolution.search.evaluation import Evaluation, evaluate, evaluation_trials
from tests.arm2d.controllers import steady_controller
from tests.evolution.small_runs import SMALL

GENOTYPES = np.random.default_rng(4).random((3, 84))


def test_all_nine_instructions_are_carried_out_80_times():
    result = evaluate(GENOTYPES, Condition.WITH_INDICATE, Readings())
    assert result.trials == 80
    assert result.successes.shape == (3, 9, 2)
    assert result.fitness.shape == (3, 9)
    assert result.successes.min() >= 0
    assert result.successes.max() <= 40


def test_success_is_the_share_of_both_areas_together(evolved_agent):
    result = evaluate(evolved_agent, Condition.WITH_INDICATE, Readings(), per_area=5)
    right, left = result.successes[0, :, 0], result.successes[0, :, 1]
    np.testing.assert_allclose(result.success[0], (right + left) / 10)
    assert 0.0 < result.success.mean() <= 1.0
    assert repr(result).endswith(f"{100 * result.success.mean():.0f} % carried out>")


def test_exactly_the_two_never_met_instructions_are_not_experienced():
    for condition in Condition:
        result = evaluate(GENOTYPES[0], condition, Readings(), per_area=1)
        names = [
            str(each)
            for each, known in zip(condition.instructions, result.experienced, strict=True)
            if not known
        ]
        assert names == ["MOVE Blue", "TOUCH Green"]


def test_the_same_trial_seed_gives_the_same_result_and_another_one_another():
    def run(seed):
        return evaluate(GENOTYPES, Condition.WITH_IGNORE, Readings(), trial_seed=seed).fitness

    assert np.array_equal(run(0), run(0))
    assert not np.array_equal(run(0), run(1))


def test_an_agent_is_judged_alike_alone_and_in_company():
    together = evaluate(GENOTYPES, Condition.WITH_INDICATE, Readings())
    alone = evaluate(GENOTYPES[1], Condition.WITH_INDICATE, Readings())
    assert np.array_equal(together.successes[1], alone.successes[0])
    assert np.array_equal(together.fitness[1], alone.fitness[0])


def test_fitness_is_the_sum_of_its_parts():
    result = evaluate(GENOTYPES, Condition.WITH_INDICATE, Readings())
    np.testing.assert_allclose(result.fitness, result.f1 + result.f2 + result.f3, rtol=1e-12)


def test_csv_and_json_tell_what_the_evaluation_does():
    result = evaluate(GENOTYPES[0], SMALL.condition, SMALL.readings, per_area=2)
    source = Agent(GENOTYPES[0], SMALL.condition, SMALL.readings, "somewhere", "agent")
    from_csv = list(csv.DictReader(io.StringIO(instruction_table(result).to_csv())))
    content = json.loads(to_json(result, source))
    assert content["instructions"] == instruction_table(result).rows()
    assert [each["instruction"] for each in from_csv] == [
        each["instruction"] for each in instruction_table(result).rows()
    ]
    assert [int(each["successes"]) for each in from_csv] == result.successes[0].sum(axis=-1).tolist()
    assert Readings.from_mapping(content["readings"]) == SMALL.readings


def test_the_terminal_table_marks_the_never_met_ones():
    result = evaluate(GENOTYPES[0], Condition.WITH_INDICATE, RunConfig().readings, per_area=1)
    names = list(terminal_table(result, "agent").columns[0].cells)
    assert [name for name in names if name.endswith("*")] == ["MOVE Blue *", "TOUCH Green *"]


def test_no_trials_are_refused():
    with pytest.raises(ValueError, match="0 trials per area"):
        evaluate(GENOTYPES, Condition.WITH_INDICATE, Readings(), per_area=0)


@pytest.mark.parametrize(
    "task", [*Condition, Task(words="object-first", word_steps=5, held_out=["move red"])]
)
def test_a_controller_that_steps_the_same_trials_is_judged_as_a_network_is(task):
    """One that always turns likewise, as a network and as turns from outside."""
    turns = (1, -1)
    worlds = VectorWorld(evaluation_trials(task, per_area=3, trial_seed=5))
    while not worlds.ended.all():
        worlds.step(np.tile(turns, (len(worlds), 1)))
    stepped = Evaluation.of(worlds.scores(), task, per_area=3, trial_seed=5)
    network = evaluate(steady_controller(*turns), task, per_area=3, trial_seed=5)
    assert stepped.fitness.any()
    for field in fields(Evaluation):
        np.testing.assert_array_equal(getattr(stepped, field.name), getattr(network, field.name))
    with pytest.raises(
        ValueError, match=r"54 trials are not 80 of each of 9 instructions; give the per_area"
    ):
        Evaluation.of(worlds.scores(), task)
