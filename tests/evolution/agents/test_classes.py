"""Behaviour by class: who is chosen, that the run is the unit, and that nothing is observed twice."""

import csv
import shutil

import numpy as np
import pytest

from arm2d import Condition
from evolution.agents import classes as class_observation
from evolution.agents.classes import CLASSES, Observation, Sampling, choose, observation_path, observe
from evolution.agents.lesions import lesion_scores
from evolution.agents.parts import late_history
from evolution.agents.postevaluation import post_evaluate
from evolution.agents.subtasks import AgentClass
from evolution.cli import main
from evolution.report.classes import behaviours_of, class_figures, write_classes
from evolution.results.classes import class_behaviours, measures
from evolution.runs.folder import RunFolder
from evolution.runs.storage import DamagedFileError

INDICATE = Condition.WITH_INDICATE
TINY = Sampling(agents=2, per_area=2)


@pytest.fixture(scope="module")
def tested(finished_run, tmp_path_factory):
    """A post-evaluated run, whose agents are too young for any class."""
    path = shutil.copytree(finished_run, tmp_path_factory.mktemp("tested") / "run")
    post_evaluate(RunFolder.open(path))
    return path


@pytest.fixture
def classed(tested, tmp_path, monkeypatch):
    """A copy of it in which every fifth agent counts as partially compositional."""
    run = RunFolder.open(shutil.copytree(tested, tmp_path / "run"))

    def every_fifth(successes, condition):
        none = np.zeros(len(successes), bool)
        return {**dict.fromkeys(CLASSES, none), AgentClass.PARTIAL: np.arange(len(successes)) % 5 == 0}

    monkeypatch.setattr(class_observation, "classify", every_fifth)
    return run


def observation(kind, successes):
    """Observed agents of one class with these success rates [A] on everything."""
    n = len(successes)
    filled = np.multiply.outer(np.array(successes), np.ones((8, 9)))
    return Observation(
        np.arange(n), np.zeros(n, int), np.full(n, CLASSES.index(kind)), np.array([9, 9, 9]),
        filled[:, 0], filled, np.full((n, 3, 4), 0.25), np.full((n, 3, 4, 91), 0.25),
    )  # fmt: skip


def test_chosen_agents_are_distinct_members_spread_over_the_generations():
    genotypes = np.arange(20)[:, np.newaxis, np.newaxis] + np.zeros((20, 5, 84))
    genotypes[5:15] = 5.0  # an elite that stays
    members = np.zeros((20, 5), bool)
    members[:, 1] = True
    chosen = choose(members, genotypes, 4)
    assert [row for row, _ in chosen] == [0, 3, 16, 19]
    assert {rank for _, rank in chosen} == {1}
    assert len(choose(members, genotypes, 100)) == 11
    assert choose(np.zeros((20, 5), bool), genotypes, 3) == []


def test_an_observed_agent_does_what_it_does_alone(classed):
    found = observe(classed, TINY)
    assert found.members.tolist() == [0, len(late_history(classed)), 0]
    assert len(found.ranks) == 2
    history = late_history(classed)
    genotype = history.best_genotypes[found.generations[-1] - history.generations[0], 0]
    alone = lesion_scores(genotype, INDICATE, classed.config.readings, per_area=2)
    assert found.intact[-1].tolist() == alone.intact[0].tolist()
    assert found.lesioned[-1].tolist() == alone.lesioned[0].tolist()


def test_what_was_observed_is_read_and_not_observed_again(classed, monkeypatch):
    first = observe(classed, TINY)
    monkeypatch.setattr(class_observation, "_measure", None)
    again = observe(classed, TINY)
    for name, array in vars(first).items():
        np.testing.assert_array_equal(array, getattr(again, name))


def test_damaged_observation_is_named_with_the_command_that_repeats_it(classed):
    observe(classed, TINY)
    path = observation_path(classed, TINY)
    path.write_bytes(path.read_bytes()[:-70])
    with pytest.raises(DamagedFileError, match=r"remove it and repeat: wordarm behaviour .* --classes"):
        observe(classed, TINY)


@pytest.mark.parametrize(
    ("name", "values"),
    [
        ("generations", (-1, 230)),
        ("ranks", (-1, 5)),
        ("classes", (-1, 3)),
        ("members", (-1, 1151)),
        ("intact", (-1e-9, 1.0 + 1e-9, np.nan)),
        ("lesioned", (-1e-9, 1.0 + 1e-9, np.nan)),
    ],
)
def test_impossible_observations_are_noticed_whatever_their_checksum_says(classed, name, values):
    observe(classed, TINY)
    path = observation_path(classed, TINY)
    for value in values:
        arrays = classed.read_arrays(path)
        before = arrays[name].copy()
        arrays[name].reshape(-1)[-1] = value
        classed.write_arrays(path, arrays)
        with pytest.raises(DamagedFileError, match=rf"its {name} are not all in \[0, .*remove it and repeat"):
            observe(classed, TINY)
        classed.write_arrays(path, {**arrays, name: before})
    observe(classed, TINY)


def test_the_run_is_the_unit_however_many_agents_it_has(finished_run):
    run = RunFolder.open(finished_run)
    many, one = observation(AgentClass.FULL, [1.0] * 9), observation(AgentClass.FULL, [0.0])
    behaviour = class_behaviours(INDICATE, [(run, many), (run, one)])[AgentClass.FULL]
    assert behaviour.agents.tolist() == [9, 1]
    values = {name: measure(behaviour) for name, measure in measures().items()}
    assert values["success, experienced, intact"].mean() == 0.5
    assert values["share of variance, action, the second before first sight"].tolist() == [0.25, 0.25]


def test_representative_is_nearest_to_the_mean_of_the_class(finished_run):
    run = RunFolder.open(finished_run)
    observed = observation(AgentClass.NONE, [0.1, 0.45, 0.9])
    _, generation, rank = class_behaviours(INDICATE, [(run, observed)])[AgentClass.NONE].representative
    assert (generation, rank) == (1, 0)


def test_files_tell_agents_runs_and_range(classed, tmp_path):
    behaviours = behaviours_of([(classed, observe(classed, TINY))])
    paths = {path.name for path in write_classes(behaviours, TINY, tmp_path)}
    assert {"classes.csv", "classes-runs.csv", "classes.svg"} <= paths
    assert "classes-trajectories-with-indicate.png" in paths
    with (tmp_path / "classes.csv").open() as file:
        rows = list(csv.DictReader(file))
    partial = [row for row in rows if row["class"] == "partially compositional"]
    assert {row["agents observed"] for row in partial} == {"2"}
    intact = next(row for row in partial if row["measure"] == "success, experienced, intact")
    assert intact["lowest run"] == intact["highest run"] == intact["mean over runs"]
    assert intact["95 % low"] == ""  # one run has no interval
    assert all(row["runs"] == "0" for row in rows if row["class"] == "fully compositional")


def test_no_class_no_figure(tested):
    run = RunFolder.open(tested)
    assert class_figures(behaviours_of([(run, observe(run, TINY))]), TINY) == {}


def test_command_names_what_cannot_be_observed(finished_run, capsys):
    assert main(["behaviour", str(finished_run), "--classes"]) == 2
    captured = capsys.readouterr()
    assert "with-indicate, seed 11: left out, not post-evaluated; go on with: wordarm post" in captured.out
    assert captured.err.count("\n") == 1
    assert main(["behaviour", str(finished_run), "--classes", "--agents=0"]) == 2
    assert "asked for 0 agents; there must be at least 1" in capsys.readouterr().err
