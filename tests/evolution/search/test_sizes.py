"""Runs of networks of another size: the setting, its files, and what is refused."""

import re
import tomllib
from dataclasses import replace

import numpy as np
import pytest

import evolution
from arm2d import Readings
from arm2d.device.errors import DeviceSizeError
from evolution.cli import main
from evolution.experiments.device.jobs import check_device
from evolution.experiments.grid import experiment_from_mapping
from evolution.experiments.plan_file import read_plan, write_plan
from evolution.player.agents import agent_for_page
from evolution.runs.checkpoint import load_checkpoint
from evolution.runs.folder import RunFolder
from evolution.runs.run import Watcher, evolve
from evolution.runs.sources import find_agent
from evolution.runs.storage import DamagedFileError, read_arrays, write_arrays
from evolution.search.ask_tell import begin
from evolution.search.config import RunConfig
from evolution.search.population import first_population
from evolution.search.scoring import score_population
from evolution.search.settings import Settings
from tests.evolution.small_runs import SMALL, SMALL_FLAGS, contents

FIVE = replace(SMALL, settings=replace(SMALL.settings, inter_neurons=5))
N_GENES = 148


@pytest.fixture(scope="module")
def finished(tmp_path_factory):
    path = tmp_path_factory.mktemp("sizes") / "finished"
    assert evolve(path, FIVE) == 230
    return path


def test_three_inter_neurons_are_not_written_and_others_are():
    assert "inter_neurons" not in RunConfig().to_toml()
    assert tomllib.loads(FIVE.to_toml())["settings"]["inter_neurons"] == 5
    for config in (RunConfig(), FIVE):
        assert RunConfig.from_toml(config.to_toml()) == config
    assert Settings.from_mapping({"inter_neurons": 3}) == Settings()


@pytest.mark.parametrize(
    ("value", "sentence"),
    [
        (0, "setting inter_neurons = 0 must lie in [1, 16]"),
        (17, "setting inter_neurons = 17 must lie in [1, 16]"),
        (3.0, "setting inter_neurons = 3.0 must be a whole number"),
    ],
)
def test_an_impossible_number_is_refused(value, sentence):
    with pytest.raises(ValueError, match=re.escape(sentence)):
        Settings.from_mapping({"inter_neurons": value})


def test_all_genotypes_of_such_a_run_have_its_size(finished):
    run = evolution.load(finished)
    assert run.genotypes(100).shape == (10, N_GENES)
    arrays = read_arrays(finished / "champions.npz")
    assert arrays["genotypes"].shape[1] == N_GENES
    assert run.champions[0].record("touch red").states.shape[1] == 5
    assert main(["verify", str(finished)]) == 0


def test_a_resumed_run_equals_an_uninterrupted_one(finished, tmp_path):
    seen = []
    stop = Watcher(on_generation=seen.append, wants_stop=lambda: len(seen) >= 137)
    assert evolve(tmp_path / "run", FIVE, stop) == 137
    evolve(tmp_path / "run", FIVE)
    assert contents(tmp_path / "run") == contents(finished)


def test_the_command_line_evolves_the_same_run(finished, tmp_path):
    path = tmp_path / "run"
    assert main(["evolve", *SMALL_FLAGS, "--inter-neurons=5", f"--output={path}"]) == 0
    assert contents(path) == contents(finished)


def test_a_folder_of_another_size_is_refused_with_both(finished, capsys):
    assert main(["evolve", *SMALL_FLAGS, f"--output={finished}"]) == 2
    assert "settings.inter_neurons = 5, not 3" in capsys.readouterr().err.replace("\n", " ")


@pytest.mark.parametrize(
    ("settings", "crossover"),
    [
        (Settings(population=6, elites=2, parents=4, inter_neurons=2), 0.3),
        (Settings(population=6, algorithm="cma-es", inter_neurons=2), 0.0),
    ],
    ids=["genetic", "cma-es"],
)
def test_every_algorithm_searches_among_such_genotypes(settings, crossover):
    algorithm = begin(RunConfig(settings=settings, readings=Readings(crossover=crossover)))
    for _ in range(3):
        genotypes = algorithm.ask()
        assert genotypes.shape == (6, 55)
        algorithm.tell(np.arange(6.0))


def test_an_algorithm_that_asks_for_another_size_is_refused():
    wrong = first_population(SMALL)
    with pytest.raises(ValueError, match="of three inter-neurons; a controller of five inter-neurons needs"):
        score_population(wrong, FIVE)


def test_a_file_whose_config_tells_another_size_is_refused(finished, tmp_path):
    arrays = read_arrays(finished / "champions.npz")
    write_arrays(tmp_path / "mixed.npz", {**arrays, "config": np.array(SMALL.to_toml())})
    with pytest.raises(
        ValueError, match=r"mixed\.npz: genotypes have shape .* of five inter-neurons; a contr"
    ):
        find_agent(str(tmp_path / "mixed.npz"))
    np.save(tmp_path / "bare.npy", arrays["genotypes"][0])
    assert find_agent(str(tmp_path / "bare.npy")).genotype.shape == (N_GENES,)


def test_a_checkpoint_of_another_size_is_damaged(finished, tmp_path):
    folder, arrays = RunFolder.create(tmp_path / "run", SMALL), read_arrays(finished / "checkpoint.npz")
    del arrays["config_sha256"]
    folder.write_arrays(folder.path / "checkpoint.npz", arrays)
    with pytest.raises(
        DamagedFileError, match=r"next_genotypes is float64 \(10, 148\), not float64 \(10, 84\)"
    ):
        load_checkpoint(folder)


def test_page_and_device_refuse_it_in_one_sentence(finished):
    with pytest.raises(
        ValueError, match="has five inter-neurons; the page to play with runs networks of three"
    ):
        agent_for_page(find_agent(str(finished)))
    with pytest.raises(
        DeviceSizeError, match=r"networks of three inter-neurons, not of 5; leave --device away"
    ):
        check_device("cuda", [SMALL, FIVE])


def test_an_experiment_makes_a_grid_of_sizes(tmp_path):
    values = {"conditions": "with-indicate", "seeds": "1-2", "settings": {"inter_neurons": [3, 5, 8]}}
    plan = experiment_from_mapping(values, tmp_path / "x").plan()
    assert len(plan.configs) == 6
    assert {path.parts[-3] for path in map(plan.path, plan.configs)} == {
        "default", "inter-neurons-5", "inter-neurons-8"
    }  # fmt: skip
    write_plan(plan)
    assert set(read_plan(tmp_path / "x").configs) == set(plan.configs)
