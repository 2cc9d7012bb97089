"""Post-evaluation, transition tests and analysis of a short experiment."""

import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from arm2d import NON_EXPERIENCED, Condition
from evolution.agents import solving
from evolution.agents.parts import late_spans
from evolution.agents.postevaluation import POST_EVALUATION, post_evaluate, successes_by_area
from evolution.agents.solving import solved_trials
from evolution.agents.transitions import (
    TRANSITION_TEST,
    action_transitions,
    object_transitions,
    run_transition_test,
)
from evolution.cli import main, parse
from evolution.experiments.experiment import open_experiment
from evolution.results.analysis import analyse
from evolution.results.notable import described, notable_agents, ship
from evolution.runs.folder import RunFolder
from evolution.runs.run import evolve
from evolution.runs.sources import find_agent
from evolution.runs.storage import DamagedFileError
from evolution.search.config import RunConfig
from evolution.search.settings import Settings
from evolution.trust.repair import repair

SETTINGS = Settings(population=12, elites=2, parents=6, generations=9)


@pytest.fixture(scope="module")
def experiment(tmp_path_factory):
    """Two short runs of each condition, post-evaluated and tested."""
    path = tmp_path_factory.mktemp("experiment")
    for condition in Condition:
        for seed in (1, 2):
            folder = path / condition / f"seed-{seed:04d}"
            evolve(folder, RunConfig(condition, seed, SETTINGS))
            run = RunFolder.open(folder)
            post_evaluate(run)
            run_transition_test(run)
    return path


def test_last_third_of_the_generations_is_post_evaluated(experiment):
    run = open_experiment(experiment).all_runs[0]
    assert POST_EVALUATION.read(run).generations.tolist() == [6, 7, 8]


def test_every_agent_is_given_trials_of_its_own(experiment, evolved):
    run = open_experiment(experiment).all_runs[0]
    unsure = evolved[20]  # carries some instructions out in some trials only
    twins = successes_by_area(run.config, 8, np.stack([unsure] * 5))
    assert len(np.unique(twins, axis=0)) > 1


def test_post_evaluation_recomputed_gives_the_same_numbers(experiment, tmp_path):
    run = open_experiment(experiment).all_runs[0]
    copy = RunFolder.open(shutil.copytree(run.path, tmp_path / "copy"))
    POST_EVALUATION.path(copy, late_spans(copy)[0]).unlink()
    np.testing.assert_array_equal(post_evaluate(copy).successes, POST_EVALUATION.read(run).successes)


def test_damaged_part_is_named_with_the_command_that_recomputes_it(experiment, tmp_path):
    run = open_experiment(experiment).all_runs[0]
    copy = RunFolder.open(shutil.copytree(run.path, tmp_path / "copy"))
    path = POST_EVALUATION.path(copy, late_spans(copy)[0])
    path.write_bytes(path.read_bytes()[:-100])
    with pytest.raises(
        DamagedFileError, match=r"is damaged .* put it right with: wordarm verify .* --repair"
    ):
        POST_EVALUATION.read(copy)


def test_unfinished_run_is_not_post_evaluated(tmp_path):
    run = RunFolder.create(tmp_path / "run", RunConfig(settings=SETTINGS))
    with pytest.raises(ValueError, match="is not finished; go on with: wordarm evolve"):
        post_evaluate(run)


def test_solved_trials_are_counted_for_every_generation(experiment):
    solved = solved_trials(open_experiment(experiment).all_runs[0])
    assert len(solved) == 9
    assert 0 <= solved.min() <= solved.max() <= 28


def test_analysis_counts_every_agent_of_every_run(experiment):
    results = analyse(open_experiment(experiment))
    assert list(results.conditions) == list(Condition)
    for each in results.conditions.values():
        assert each.n_agents == 2 * 3 * 5
        assert each.counts.sum(axis=0).tolist() == [30] * 4
        assert not each.missing
    assert set(results.comparisons) == set(results.published_tests)


def test_analysis_names_what_is_missing_and_goes_on(experiment, tmp_path):
    copy = shutil.copytree(experiment, tmp_path / "copy")
    shutil.rmtree(copy / "with-indicate" / "seed-0002" / "postevaluation")
    results = analyse(open_experiment(copy))
    assert len(results.conditions[Condition.WITH_INDICATE].runs) == 1
    (sentence,) = results.missing
    assert sentence.startswith("with-indicate, seed 2: left out, not post-evaluated")


def test_a_damaged_part_costs_its_run_only_and_is_named(experiment, tmp_path):
    copy = shutil.copytree(experiment, tmp_path / "copy")
    run = RunFolder.open(copy / "with-ignore" / "seed-0001")
    path = POST_EVALUATION.path(run, late_spans(run)[0])
    path.write_bytes(path.read_bytes()[:-100])
    results = analyse(open_experiment(copy))
    assert results.conditions[Condition.WITH_IGNORE].seeds.tolist() == [2]
    (sentence,) = results.missing
    assert sentence.startswith("with-ignore, seed 1: left out, ")
    assert f"with: wordarm verify {run.path} --repair" in sentence


def test_an_unreadable_run_and_a_missing_seed_are_named(experiment, tmp_path):
    copy = shutil.copytree(experiment, tmp_path / "copy")
    config = copy / "with-indicate" / "seed-0001" / "config.toml"
    config.write_text("seed = [", encoding="utf-8")
    results = analyse(open_experiment(copy))
    unreadable, absent = results.missing
    assert unreadable.startswith(f"{config} cannot be read")
    assert absent.startswith("with-indicate has no run of seed 1, which the other condition has")
    assert results.conditions[Condition.WITH_INDICATE].seeds.tolist() == [2]


def test_a_run_copied_inside_its_experiment_is_counted_once_and_named(experiment, tmp_path):
    copy = shutil.copytree(experiment, tmp_path / "copy")
    original = copy / "with-indicate" / "seed-0002"
    for name in ("seed-0002 (copy)", "backup", "seed-0001.old"):
        shutil.copytree(original, copy / "with-indicate" / name)
    results = analyse(open_experiment(copy))
    assert results.conditions[Condition.WITH_INDICATE].seeds.tolist() == [1, 2]
    assert results.conditions[Condition.WITH_INDICATE].runs[1].path == original
    assert sorted(results.missing) == sorted(
        f"{copy / 'with-indicate' / name} holds the same run as {original} (configuration and seed), "
        "which is counted once; move the copy elsewhere"
        for name in ("seed-0002 (copy)", "backup", "seed-0001.old")
    )


def test_runs_that_differ_in_anything_but_their_folder_are_no_copies(experiment):
    runs = open_experiment(experiment)
    assert len(runs.all_runs) == 4
    assert runs.copies == ()


def test_an_unfinished_run_is_told_how_to_go_on(tmp_path):
    config = RunConfig(Condition.WITH_IGNORE, 3)
    run = RunFolder.create(tmp_path / "with-ignore" / "seed-0003", config)
    (sentence,) = analyse(open_experiment(tmp_path)).missing
    command = f"wordarm evolve --condition=with-ignore --seed=3 --output={run.path}"
    assert sentence == f"with-ignore, seed 3: left out, 0 generations so far; go on with: {command}"
    assert parse(command.split()[1:]).config == config


def test_an_experiment_without_a_tested_run_is_not_analysed_and_nothing_is_written(
    finished_run, tmp_path, capsys
):
    run = shutil.copytree(finished_run, tmp_path / "an experiment" / "with-indicate" / "seed-0011")
    before = sorted(tmp_path.rglob("*"))
    assert main(["analyse", str(tmp_path / "an experiment")]) == 2
    error = capsys.readouterr().err
    assert "an experiment has no run that can be analysed: with-indicate, seed 11: left out, not " in error
    assert error.endswith(f"post-evaluated; go on with: wordarm postevaluate '{run}'\n")
    assert sorted(tmp_path.rglob("*")) == before


def test_tests_go_on_past_a_damaged_run_and_end_with_its_name(experiment, tmp_path, capsys):
    copy = shutil.copytree(experiment, tmp_path / "copy")
    damaged = RunFolder.open(copy / "with-indicate" / "seed-0001")
    path = POST_EVALUATION.path(damaged, late_spans(damaged)[0])
    path.write_bytes(b"nothing")
    later = RunFolder.open(copy / "with-ignore" / "seed-0002")
    POST_EVALUATION.path(later, late_spans(later)[0]).unlink()
    assert main(["postevaluate", str(copy)]) == 2
    error = capsys.readouterr().err
    assert error.count("\n") == 1
    assert str(path) in error
    assert POST_EVALUATION.path(later, late_spans(later)[0]).exists()


def test_tests_go_on_past_a_run_that_cannot_be_locked(experiment, tmp_path, capsys):
    """Something lies where its lock is to be, so that not even root can write there."""
    copy = shutil.copytree(experiment, tmp_path / "copy")
    closed, later = (copy / name for name in ("with-indicate/seed-0001", "with-ignore/seed-0002"))
    (closed / "lock").unlink(missing_ok=True)
    (closed / "lock").mkdir()
    missing = POST_EVALUATION.path(RunFolder.open(later), late_spans(RunFolder.open(later))[0])
    missing.unlink()
    assert main(["postevaluate", str(copy)]) == 2
    assert str(closed) in capsys.readouterr().err
    assert missing.exists()


def test_folder_without_runs_is_refused(tmp_path):
    with pytest.raises(ValueError, match="holds no runs"):
        open_experiment(tmp_path)


def test_shipped_agents_are_found_again_with_their_world_and_scores(experiment, tmp_path):
    results = analyse(open_experiment(experiment))
    agents = notable_agents(results)
    paths = ship(agents, tmp_path)
    assert {each.stem for each in paths} <= {"best-generaliser", "best-specialist", "with-ignore"}
    for path in paths:
        source, agent = find_agent(str(path)), agents[path.stem]
        assert source.condition is agent.run.config.condition
        assert source.readings == agent.run.config.readings
        rank = find_agent(str(agent.run.path), generation=agent.generation, rank=agent.rank)
        np.testing.assert_array_equal(source.genotype, rank.genotype)


def test_what_a_shipped_agent_can_do_is_told_whatever_its_name(experiment):
    results = analyse(open_experiment(experiment))
    agent = notable_agents(results)["best-generaliser"]
    made = np.where([word in NON_EXPERIENCED for word in agent.run.config.task.instructions], 61, 60)
    made[2] = 80
    told = described(replace(agent, successes=made.astype(np.int16)))
    assert told == "carries out 1 of 7 instructions it met and 2 of 2 it never met"


@pytest.mark.slow
def test_damaged_tests_are_repaired_with_the_bits_they_had(experiment, tmp_path):
    run = open_experiment(experiment).all_runs[0]
    copy = RunFolder.open(shutil.copytree(run.path, tmp_path / "copy"))
    run_transition_test(copy)
    solved_trials(copy)
    span = late_spans(copy)[0]
    paths = [POST_EVALUATION.path(copy, span), TRANSITION_TEST.path(copy, span), solving.file_path(copy)]
    before = [path.read_bytes() for path in paths]
    for path in paths:
        path.write_bytes(path.read_bytes()[:-100])
    notes = []
    assert repair(copy.path, notes.append) == 3
    assert [path.read_bytes() for path in paths] == before
    assert [note.split(": ")[0] for note in notes] == [
        f"postevaluation/{paths[0].name}", f"transitions/{paths[1].name}", "solved.npz",
    ]  # fmt: skip


def with_last(arrays, name, value):
    """The arrays with another last number in one of them."""
    changed = arrays[name].copy()
    changed.reshape(-1)[-1] = value
    return {**arrays, name: changed}


def test_numbers_no_test_can_give_are_damage_even_with_a_fitting_checksum(experiment, tmp_path):
    run = open_experiment(experiment).all_runs[0]
    copy = RunFolder.open(shutil.copytree(run.path, tmp_path / "copy"))
    span = late_spans(copy)[0]
    path = POST_EVALUATION.path(copy, span)
    arrays = copy.read_arrays(path)
    beyond = {"generations": (span.start - 1, span.stop), "successes": (-1, 81)}
    for name, values in beyond.items():
        for value in values:
            copy.write_arrays(path, with_last(arrays, name, value))
            with pytest.raises(DamagedFileError, match=rf"its {name} are not all in \["):
                POST_EVALUATION.read(copy)


def test_transitions_no_agent_can_pass_are_damage(experiment):
    """One made-up agent: at each bound, and just beyond."""
    run, path = open_experiment(experiment).all_runs[0], Path("transitions.npz")
    span, condition = late_spans(run)[0], run.config.condition
    sound = {
        "generations": np.array([span.start], np.int32),
        "ranks": np.zeros(1, np.int8),
        "classes": np.zeros(1, np.int8),
        "action": np.zeros((1, len(action_transitions(condition))), np.int16),
        "object": np.zeros((1, len(object_transitions(condition))), np.int16),
    }
    bounds = {"generations": (span.start, span.stop - 1), "ranks": (0, 4), "classes": (0, 2)}
    for name, (low, high) in {**bounds, "action": (0, 80), "object": (0, 80)}.items():
        for value in (low, high):
            TRANSITION_TEST.check(path, with_last(sound, name, value), run, span)
        for value in (low - 1, high + 1):
            with pytest.raises(DamagedFileError, match=rf"its {name} are not all in \["):
                TRANSITION_TEST.check(path, with_last(sound, name, value), run, span)
