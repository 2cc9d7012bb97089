"""Runs of tasks that are not the paper's: the same folders, and what is made for the paper refused."""

import re
from dataclasses import replace

import numpy as np
import pytest

import evolution
from arm2d import Condition, Task
from evolution.cli import main
from evolution.commands.robot import candidate
from evolution.experiments.grid import experiment_from_mapping
from evolution.experiments.plan_file import read_plan, write_plan
from evolution.player.agents import agent_for_page
from evolution.runs.folder import RunFolder
from evolution.runs.recorded import recorded_history
from evolution.runs.run import Watcher, evolve
from evolution.runs.sources import find_agent
from evolution.search.config import RunConfig
from evolution.search.evaluation import evaluate
from evolution.search.scoring import first_genotypes_trials, trials_of
from evolution.search.settings import Settings
from tests.evolution.small_runs import SMALL, contents

TASK = Task(third="both", words="action-first", word_steps=15, places="dealt", held_out=("ignore red",))
CONFIG = RunConfig(TASK, 7, Settings(population=10, elites=2, parents=5, generations=110))
FLAGS = [
    "--condition=with-both", "--seed=7", "--task.words=action-first", "--task.word-steps=15",
    "--task.places=dealt", "--task.held-out", "ignore red",
]  # fmt: skip
SIZE = ["--population=10", "--elites=2", "--parents=5", "--generations=110"]


@pytest.fixture(scope="module")
def finished(tmp_path_factory):
    path = tmp_path_factory.mktemp("runs") / "finished"
    assert evolve(path, CONFIG) == 110
    return path


def test_a_config_with_a_task_is_written_and_read():
    text = CONFIG.to_toml()
    assert '\ncondition = "with-both"\n' in text
    assert RunConfig.from_toml(text) == CONFIG
    assert "task" not in SMALL.to_mapping()


def test_the_papers_task_is_its_condition():
    assert RunConfig(Task(third="ignore")) == RunConfig(Condition.WITH_IGNORE)
    assert RunConfig("with-both").condition == Task(third="both")


def test_a_resumed_run_equals_an_uninterrupted_one(finished, tmp_path):
    for generation in (40, 101, None):
        seen = []
        stop = Watcher(
            on_generation=lambda progress, seen=seen: seen.append(progress.generation),
            wants_stop=lambda seen=seen, generation=generation: bool(seen) and seen[-1] == generation,
        )
        evolve(tmp_path / "run", CONFIG, stop)
    assert contents(tmp_path / "run") == contents(finished)


def test_the_command_line_evolves_the_same_run(finished, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert main(["evolve", *FLAGS, *SIZE]) == 0
    path = tmp_path / "runs" / "default" / str(TASK) / "seed-0007"
    assert contents(path) == contents(finished)


def test_held_out_instructions_are_not_met_and_all_are_counted(finished):
    champions = RunFolder.open(finished).read_arrays(finished / "champions.npz")
    assert champions["successes"].shape[1] == 12
    assert champions["chosen_by_successes"].shape[1] == 11
    found = evaluate(champions["genotypes"], TASK)
    assert np.array_equal(found.successes.sum(axis=-1), champions["successes"])
    assert found.experienced.tolist() == [True] * 11 + [False]


def test_another_task_is_another_run(finished):
    other = replace(CONFIG, condition=replace(TASK, places="own"))
    with pytest.raises(ValueError, match=r"was started with condition = with-both\+.*dealt, not with-both\+"):
        evolve(finished, other)


def test_evaluate_and_verify_take_it(finished, capsys):
    assert main(["evaluate", str(finished), "--trials-per-area=2"]) == 0
    assert "IGNORE Red" in capsys.readouterr().out
    assert list((finished / "evaluation").glob("*heat-map.png"))
    assert main(["verify", str(finished)]) == 0


def test_an_agent_records_what_its_task_says(finished):
    run = evolution.load(finished)
    record = run.champions[0].record("ignore red")
    assert record.task == TASK
    assert record.inputs[0, 12:].tolist() == [0, 0, 0, 1, 1, 1]


@pytest.mark.parametrize("command", ["postevaluate", "lineage", "behaviour", "analyse"])
def test_what_is_made_for_the_paper_refuses_it_in_one_sentence(command, finished, capsys):
    before = sorted(finished.iterdir())
    assert main([command, str(finished)]) == 2
    error = capsys.readouterr().err
    assert "this analysis is made for the paper's two conditions, with-indicate and with-ignore, not" in error
    assert sorted(finished.iterdir()) == before


def test_robot_counts_page_and_gallery_refuse_it_too(finished, tmp_path, capsys):
    for ask in (lambda: candidate(str(finished)), lambda: agent_for_page(find_agent(str(finished)))):
        with pytest.raises(ValueError, match="is made for the paper's two conditions"):
            ask()
    assert main(["port", str(finished), "all", f"--output={tmp_path / 'all.mp4'}"]) == 2
    assert "the gallery of nine is made for the paper's two conditions" in capsys.readouterr().err
    assert main(["live", str(finished), "--port=1"]) == 2
    assert "the live page is made for the paper's two conditions" in capsys.readouterr().err
    assert not list(tmp_path.iterdir())


def test_the_first_genotypes_trials_are_those_it_was_scored_in_though_places_are_dealt():
    """All genotypes' trials are dealt at once, which changes the colours of the first one's."""
    for starts_shared in ("genotype", "generation"):
        config = replace(CONFIG, readings=replace(CONFIG.readings, starts_shared=starts_shared))
        trials = first_genotypes_trials(config, 3)
        scored, _ = trials_of(config, 3, config.settings.population)
        n = len(TASK.experienced) * 2 * config.settings.trials_per_area
        assert len(trials) == n
        for name in ("alpha", "discs", "actions", "objects"):
            np.testing.assert_array_equal(getattr(trials, name), getattr(scored, name)[:n])


def test_a_fitness_is_a_mean_over_what_is_met(finished):
    history = recorded_history(RunFolder.open(finished))
    assert 0.0 < history.best.max() <= TASK.largest_fitness


EXPERIMENT = {
    "conditions": ["with-indicate", "with-both"],
    "seeds": "1-2",
    "task": {"places": ["own", "dealt"], "held_out": [["move red"], ["touch green", "move blue"]]},
}


def test_an_experiment_makes_a_grid_of_tasks(tmp_path):
    plan = experiment_from_mapping(EXPERIMENT, tmp_path / "x").plan()
    assert len(plan.configs) == 16
    assert len({plan.path(config) for config in plan.configs}) == 16
    assert RunConfig(seed=1) in plan.configs
    write_plan(plan)
    assert set(read_plan(tmp_path / "x").configs) == set(plan.configs)


@pytest.mark.parametrize(
    ("values", "sentence"),
    [
        ({"task": {"places": []}}, "places = [] is an empty grid"),
        ({"task": {"places": "moon"}}, "task places = 'moon'; choose own or dealt"),
        ({"task": {"colour": 1}}, "unknown part of a task 'colour'"),
        ({"task": 3}, "task = 3 must be a table, such as [task]"),
        ({"task": {"places": ["own", "own"]}}, "[task] has with-indicate twice"),
        ({"conditions": "with-both", "post_evaluate": True}, "post_evaluate = true is made for the paper's"),
    ],
)
def test_an_experiment_of_impossible_tasks_is_refused(values, sentence, tmp_path):
    with pytest.raises(ValueError, match=re.escape(sentence)):
        experiment_from_mapping(values, tmp_path)


def test_a_condition_that_does_not_exist_is_answered_with_all_that_do():
    with pytest.raises(ValueError, match=r"there are with-indicate, with-ignore, with-both$"):
        RunConfig("with-shout")


def test_the_command_line_refuses_a_task_that_makes_no_sense(tmp_path, capsys):
    out = f"--output={tmp_path / 'run'}"
    assert main(["evolve", "--task.held-out", "move blue", "move green", "move red", "--seed=1", out]) == 2
    assert "the word move would never be heard" in capsys.readouterr().err
    assert not (tmp_path / "run").exists()
