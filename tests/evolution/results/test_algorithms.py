"""The table of algorithms: what it counts, from short runs and from outcomes made by hand."""

import csv

import numpy as np
import pytest

from arm2d import Condition
from benchmarks.algorithms import RunOutcome, cpu_of, groups_of, main, outcome_of, table_of
from evolution.agents.subtasks import carries_out
from evolution.answers import BAD_INPUT
from evolution.runs.folder import RunFolder
from evolution.runs.recorded import recorded_history
from evolution.runs.run import evolve
from evolution.search.config import RunConfig
from evolution.search.settings import Settings

GENETIC = Settings(population=10, elites=2, parents=5, generations=40)
CMA_ES = Settings(population=10, generations=40, algorithm="cma-es")


@pytest.fixture(scope="module")
def experiment(tmp_path_factory):
    """Two algorithms with two seeds each, and a run that was never begun."""
    path = tmp_path_factory.mktemp("runs") / "algorithms"
    for variant, settings in (("default", GENETIC), ("cma", CMA_ES)):
        for seed in (1, 2):
            evolve(
                path / variant / "with-indicate" / f"seed-{seed:04d}", RunConfig(seed=seed, settings=settings)
            )
    RunFolder.create(path / "default" / "with-indicate" / "seed-0003", RunConfig(seed=3, settings=GENETIC))
    return path


def outcome(seed, reached, cpu=60.0, understood=(False, False), settings=GENETIC):
    return RunOutcome(
        RunConfig(seed=seed, settings=settings),
        reached,
        stays=reached >= 0,
        cpu=cpu,
        understood=np.array(understood),
        both=all(understood),
    )


def test_runs_of_an_experiment_become_a_row_for_each_algorithm(experiment, tmp_path, capsys):
    assert main(experiment, tmp_path / "table.csv") == 0
    assert "left out, as they are not finished: 1" in capsys.readouterr().err
    with (tmp_path / "table.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert [(row["algorithm"], row["runs"], row["reach 18/7"]) for row in rows] == [
        ("cma-es", "2", "0"),
        ("genetic", "2", "0"),
    ]
    assert all(row["evaluations to get there (median)"] == "" for row in rows)
    assert all(float(row["CPU of a run (mean) [s]"]) > 0 for row in rows)


def test_a_run_is_told_by_its_files(experiment):
    run = RunFolder.open(experiment / "default" / "with-indicate" / "seed-0001")
    found = outcome_of(run)
    assert recorded_history(run).best.max() < 2.5
    assert (found.reached, found.stays, found.both) == (-1, False, False)
    assert 0.0 < found.cpu == cpu_of(run) < 600.0


def test_cost_of_getting_there_is_of_those_that_do(tmp_path):
    runs = [outcome(1, 9, cpu=40.0), outcome(2, -1, cpu=50.0), outcome(3, 29, cpu=80.0)]
    (row,) = table_of(groups_of(runs)).rows()
    assert (row["runs"], row["reach 18/7"], row["end at 18/7"]) == (3, 2, 2)
    # 10 and 30 generations of 10 genotypes; a quarter of 40 s, three quarters of 80 s.
    assert row["evaluations to get there (median)"] == "200"
    assert row["CPU to get there (median) [s]"] == "35"
    low, high = (float(end) for end in row["95 % interval"].split(" to "))
    assert low < 2 / 3 < high


def test_time_that_was_not_noted_is_not_made_up():
    (row,) = table_of(groups_of([outcome(1, 9, cpu=float("nan")), outcome(2, 9)])).rows()
    assert row["CPU to get there (median) [s]"] == ""
    assert row["evaluations to get there (median)"] == "100"


def test_runs_that_understand_are_counted_by_instruction():
    runs = [outcome(1, 9, understood=(True, False)), outcome(2, 9, understood=(True, True))]
    (row,) = table_of(groups_of(runs)).rows()
    assert (row["understand TOUCH Green"], row["understand MOVE Blue"], row["understand both"]) == (2, 1, 1)


def test_understanding_asks_for_the_seven_besides():
    order = Condition.WITH_INDICATE.instructions
    move_blue, move_red = order.index(Condition.WITH_INDICATE.held_out[1]), 2
    agents = np.full((3, 9), 80)
    agents[1, move_blue], agents[2, move_red] = 60, 60  # 75 %, not above it
    found = carries_out(agents, Condition.WITH_INDICATE, order[move_blue])
    assert found.tolist() == [True, False, False]


def test_other_lengths_and_algorithms_are_not_put_together():
    longer = Settings(population=10, elites=2, parents=5, generations=50)
    runs = [outcome(1, 3), outcome(2, 3, settings=CMA_ES), outcome(3, 3, settings=longer), outcome(4, 3)]
    assert sorted(len(group.runs) for group in groups_of(runs)) == [1, 1, 2]


def test_a_folder_without_finished_runs_is_refused_in_a_sentence(tmp_path, capsys):
    RunFolder.create(tmp_path / "with-indicate" / "seed-0001", RunConfig(settings=GENETIC))
    assert main(tmp_path) == BAD_INPUT
    assert "none of the 1 runs" in capsys.readouterr().err
    assert main(tmp_path / "nowhere") == BAD_INPUT
