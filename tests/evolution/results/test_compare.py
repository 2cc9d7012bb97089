"""Experiments side by side: numbers are those of each analysis, and the published ones stand beside them."""

import csv
import shutil

import numpy as np
import pytest

from arm2d import Condition, Readings
from evolution.agents.postevaluation import post_evaluate
from evolution.agents.transitions import run_transition_test
from evolution.cli import main
from evolution.experiments.experiment import open_experiment
from evolution.results import published
from evolution.results.analysis import analyse
from evolution.results.key_numbers import AT_LIMIT, PLATEAU, by_condition, departures, key_numbers, top_name
from evolution.runs.folder import RunFolder
from evolution.runs.run import evolve
from evolution.search.config import RunConfig
from evolution.search.settings import Settings

SETTINGS = Settings(population=10, elites=2, parents=5, generations=6)
LARGER = Readings(object_radius=10.0)


@pytest.fixture(scope="module")
def experiments(tmp_path_factory):
    """Two experiments of one short run each, under different readings; one has both conditions."""
    home = tmp_path_factory.mktemp("experiments")
    for name, condition, readings in (
        ("default", Condition.WITH_INDICATE, Readings()),
        ("default", Condition.WITH_IGNORE, Readings()),
        ("larger", Condition.WITH_INDICATE, LARGER),
    ):
        path = home / name / condition / "seed-0001"
        evolve(path, RunConfig(condition, 1, SETTINGS, readings))
        run = RunFolder.open(path)
        post_evaluate(run)
        run_transition_test(run)
    return home


@pytest.fixture(scope="module")
def results(experiments):
    return {name: analyse(open_experiment(experiments / name)) for name in ("default", "larger")}


def test_numbers_are_those_of_the_analysis_and_of_the_paper(results):
    each = results["default"].conditions[Condition.WITH_IGNORE]
    numbers = {number.name: number for number in key_numbers(each)}
    assert numbers[PLATEAU].ours == each.plateau[0]
    assert (numbers[AT_LIMIT].ours, numbers[AT_LIMIT].of) == (each.at_plateau, 1)
    assert numbers[AT_LIMIT].published == published.RUNS
    assert numbers[top_name("I")].published == pytest.approx(0.66293)
    assert numbers[top_name("IV")].ours == each.share_in_top("IV").mean()


def test_no_agent_of_a_class_is_no_share_rather_than_nought(results):
    numbers = key_numbers(results["default"].conditions[Condition.WITH_INDICATE])
    passed = [each for each in numbers if "pass the" in each.name]
    assert len(passed) == 6
    assert all(np.isnan(each.ours) for each in passed if not each.of)


def test_command_writes_a_table_and_a_figure(experiments, tmp_path, capsys):
    folders = [str(experiments / name) for name in ("default", "larger")]
    assert main(["analyse", *folders, f"--output={tmp_path}"]) == 0
    assert {each.name for each in tmp_path.iterdir()} == {
        "comparison.csv", "comparison.png", "comparison.svg",
    }  # fmt: skip
    with (tmp_path / "comparison.csv").open() as file:
        rows = list(csv.DictReader(file))
    plateau = [row for row in rows if row["number"] == PLATEAU]
    assert [row["condition"] for row in plateau] == [str(each) for each in Condition]
    assert plateau[0]["published"] == "2.57"
    assert float(plateau[0]["larger"]) > 0
    assert plateau[1]["larger"] == ""  # it has no With-Ignore run
    assert "larger: object radius 10.0" in capsys.readouterr().out


def test_readings_are_told_where_they_differ():
    assert departures(Readings()) == "default readings"
    assert departures(LARGER) == "object radius 10.0"


def test_bad_input_gets_one_sentence(experiments, tmp_path, capsys):
    one = str(experiments / "default")
    for arguments, words in (
        ([], "no experiment is named; give its folder, such as runs/default"),
        ([one, one], "is given twice; give different experiments"),
        ([one, str(tmp_path)], "holds no runs"),
        ([one, str(tmp_path), "--ship=x"], "--ship takes the agents of one experiment; name one"),
    ):
        assert main(["analyse", *arguments, f"--output={tmp_path / 'new'}"]) == 2
        captured = capsys.readouterr()
        assert words in captured.err
        assert captured.err.count("\n") == 1
        assert not (tmp_path / "new").exists()


def test_an_experiment_without_results_stands_empty_and_is_named(experiments, tmp_path, capsys):
    bare = shutil.copytree(experiments / "larger", tmp_path / "bare")
    shutil.rmtree(bare / "with-indicate" / "seed-0001" / "postevaluation")
    flags = [str(experiments / "larger"), str(bare), f"--output={tmp_path / 'out'}"]
    assert main(["analyse", *flags]) == 0
    assert "bare: with-indicate, seed 1: left out, not post-evaluated" in capsys.readouterr().out
    (by_name,) = by_condition({"bare": analyse(open_experiment(bare))}).values()
    assert np.isnan(by_name["bare"][0].ours)
