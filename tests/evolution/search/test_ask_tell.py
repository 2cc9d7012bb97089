import re
import runpy
import shutil
from dataclasses import replace
from importlib import metadata
from pathlib import Path

import numpy as np
import pytest

import evolution
from evolution.cli import main
from evolution.runs.checkpoint import load_checkpoint, save_checkpoint
from evolution.runs.folder import RunFolder
from evolution.runs.recorded import recorded_generation, recorded_history
from evolution.runs.replay import population_at
from evolution.runs.run import Watcher, evolve
from evolution.search import ask_tell
from evolution.search.ask_tell import begin, register_algorithm
from evolution.search.cma_es import CmaEs
from evolution.search.config import RunConfig
from evolution.search.genetic import GeneticAlgorithm
from evolution.search.population import first_population, next_population
from evolution.search.scoring import score_population
from evolution.search.settings import Settings
from evolution.trust.verify import verify
from tests.evolution.small_runs import SMALL, contents

# So impatient that it begins anew several times, with ever more candidates, and ends in mid-iteration.
CMA_ES = RunConfig(
    seed=5, settings=Settings(population=10, generations=130, algorithm="cma-es", cma_patience=3)
)
EXAMPLE = Path(__file__).parents[3] / "docs" / "examples" / "map_elites.py"


@pytest.fixture(scope="module")
def map_elites():
    pytest.importorskip("ribs", reason="the example needs pyribs, which nothing else does: pip install ribs")
    runpy.run_path(str(EXAMPLE))
    return RunConfig(seed=5, settings=Settings(population=10, generations=130, algorithm="map-elites"))


@pytest.fixture(scope="module", params=["cma-es", "map-elites"])
def finished(request, tmp_path_factory):
    """A run of another algorithm than the paper's, and its folder."""
    config = CMA_ES if request.param == "cma-es" else request.getfixturevalue("map_elites")
    path = tmp_path_factory.mktemp("runs") / request.param
    assert evolve(path, config) == 130
    return config, path


def stopping_at(generation):
    seen = []
    return Watcher(
        on_generation=lambda progress: seen.append(progress.generation),
        wants_stop=lambda: bool(seen) and seen[-1] == generation,
    )


def test_a_resumed_run_equals_an_uninterrupted_one(finished, tmp_path):
    config, path = finished
    for generation in (0, 37, 98, 99, 128):
        evolve(tmp_path / "run", config, stopping_at(generation))
    evolve(tmp_path / "run", config)
    assert contents(tmp_path / "run") == contents(path)


def test_without_its_checkpoint_a_run_goes_on_from_its_parts_with_the_same_bits(finished, tmp_path):
    config, path = finished
    evolve(tmp_path / "run", config, stopping_at(111))
    (tmp_path / "run" / "checkpoint.npz").unlink()
    evolve(tmp_path / "run", config)
    assert contents(tmp_path / "run") == contents(path)


def test_any_population_is_asked_for_again_from_the_recorded_fitness(finished):
    config, path = finished
    folder = RunFolder.open(path)
    for generation in (0, 99, 129):
        population, scored = population_at(folder, generation), recorded_generation(folder, generation)
        assert np.array_equal(score_population(population, config), scored.fitness[0])


def test_verification_computes_the_run_again(finished):
    findings = verify(RunFolder.open(finished[1]), chosen=[0, 100])
    assert (findings.walked, findings.scored, findings.champions) == (130, 2, True)
    assert findings.agrees, findings.difference


def test_a_damaged_part_and_checkpoint_are_repaired_with_the_same_bits(finished, tmp_path, capsys):
    path = finished[1]
    copy = shutil.copytree(path, tmp_path / "run")
    for name in ("parts/gen-000000-000099.npz", "checkpoint.npz"):
        (copy / name).write_bytes(b"damaged")
    assert main(["verify", str(copy), "--repair"]) == 0, capsys.readouterr().err
    assert contents(copy) == contents(path)


@pytest.mark.parametrize("config", [SMALL, CMA_ES], ids=["genetic", "cma-es"])
def test_asked_and_told_an_algorithm_goes_the_way_of_the_loop(config):
    algorithm, population = begin(config), first_population(config)
    for _ in range(12):
        assert np.array_equal(algorithm.ask(), population.genotypes)
        fitness = score_population(population, config)
        algorithm.tell(fitness)
        population = next_population(population, fitness, config)


def test_cma_es_finds_the_lowest_point_of_a_bowl():
    """Fitness is the negative squared distance from a point inside; all 84 genes come near it."""
    config = RunConfig(seed=1, settings=Settings(population=60, algorithm="cma-es", cma_patience=1000))
    goal, algorithm = np.linspace(0.2, 0.8, 84), begin(config)
    first = np.abs(algorithm.ask() - goal).mean()
    for _ in range(500):
        algorithm.tell(-((algorithm.ask() - goal) ** 2).sum(axis=1))
    assert np.abs(algorithm.ask() - goal).mean() < 0.05 * first


def test_cma_es_begins_anew_with_twice_as_many_candidates_when_nothing_gets_better():
    algorithm = CmaEs(CMA_ES)
    sizes = []
    for _ in range(60):
        sizes.append(len(algorithm.state()["candidates"]))
        algorithm.tell(np.arange(10.0) / 10)
    # The first iteration is better than none; three more bring nothing. Then two generations an iteration.
    assert sizes[:13] == [10] * 4 + [20] * 8 + [40]


def test_cma_es_stays_with_a_search_that_has_nearly_all_there_is():
    algorithm = CmaEs(CMA_ES)
    for _ in range(20):
        algorithm.tell(np.linspace(0.0, 2.55, 10))
    assert len(algorithm.state()["candidates"]) == 10


def test_candidates_of_one_iteration_are_compared_across_easy_and_hard_generations():
    """Whether the trials of its second generation are harder for all makes no difference."""
    plain, harder = CmaEs(CMA_ES), CmaEs(CMA_ES)
    for algorithm, loss in ((plain, 0.0), (harder, 0.5)):
        while len(algorithm.state()["candidates"]) < 20:
            algorithm.tell(np.zeros(10))
        before = algorithm.state()["mean"]
        algorithm.tell(np.linspace(0.5, 1.0, 10))
        algorithm.tell(np.linspace(0.6, 0.9, 10) - loss)
        assert not np.array_equal(algorithm.state()["mean"], before)
    np.testing.assert_allclose(plain.state()["mean"], harder.state()["mean"], atol=1e-12)


def test_genotypes_lie_within_their_bounds(finished):
    genotypes = recorded_history(RunFolder.open(finished[1])).best_genotypes
    assert genotypes.min() >= 0.0
    assert genotypes.max() <= 1.0


def test_there_are_no_ancestors_where_there_are_no_parents(finished, capsys):
    assert main(["lineage", str(finished[1])]) == 2
    assert "has no lines of ancestors: its algorithm" in capsys.readouterr().err


@pytest.mark.parametrize(("algorithm", "config"), [(GeneticAlgorithm, SMALL), (CmaEs, CMA_ES)])
def test_a_new_one_begins_with_generation_0(algorithm, config):
    """Told the same, it breeds the same as one that is told where it begins."""
    new, told = algorithm(config), algorithm(config, 0)
    assert new.generation == 0
    for generation in (1, 2):
        np.testing.assert_array_equal(new.ask(), told.ask())
        fitness = new.ask().mean(axis=1)
        new.tell(fitness)
        told.tell(fitness)
        assert new.generation == generation
    np.testing.assert_array_equal(new.ask(), told.ask())


def test_a_state_of_another_algorithm_is_refused_in_one_sentence():
    genetic, cma_es = GeneticAlgorithm(SMALL).state(), CmaEs(CMA_ES).state()
    with pytest.raises(ValueError, match="no state of the algorithm cma-es: it holds genotypes, parents, "):
        CmaEs(CMA_ES, 1, genetic)
    with pytest.raises(ValueError, match=r"no state of the algorithm genetic: it holds .*covariance"):
        GeneticAlgorithm(SMALL, 1, cma_es)
    with pytest.raises(ValueError, match=r"its mean cannot be float64 \(83,\)"):
        CmaEs(CMA_ES, 1, {**cma_es, "mean": cma_es["mean"][:83]})
    with pytest.raises(ValueError, match=r"its sigma cannot be float64 .* with what is no number"):
        CmaEs(CMA_ES, 1, {**cma_es, "sigma": np.array(np.nan)})
    with pytest.raises(ValueError, match="of 10 candidates 10 are told"):
        CmaEs(CMA_ES, 1, {**cma_es, "above": np.zeros(10)})


def test_a_checkpoint_of_another_algorithm_is_not_gone_on_with(tmp_path):
    """The parts are; the run ends as it would have."""
    evolve(tmp_path / "run", CMA_ES, stopping_at(110))
    folder = RunFolder.open(tmp_path / "run")
    checkpoint = load_checkpoint(folder)
    assert checkpoint is not None
    foreign = replace(checkpoint, population=replace(checkpoint.population, memory={}))
    save_checkpoint(folder, foreign)
    notes = []
    evolve(tmp_path / "run", CMA_ES, replace(stopping_at(111), on_note=notes.append))
    assert len(notes) == 1
    assert "this is no state of the algorithm cma-es" in notes[0]


def test_an_unknown_algorithm_is_refused_before_anything_is_written(tmp_path, capsys):
    assert main(["evolve", "--algorithm=annealing", f"--output={tmp_path / 'run'}"]) == 2
    error = capsys.readouterr().err
    assert "the algorithm 'annealing' is not known here; there are genetic, cma-es" in error
    assert not (tmp_path / "run").exists()


def test_algorithms_of_installed_packages_are_found(monkeypatch):
    entry = metadata.EntryPoint("twin", "evolution.search.genetic:GeneticAlgorithm", "wordarm.algorithms")
    monkeypatch.setattr(ask_tell, "entry_points", lambda group: [entry] if group == entry.group else [])
    twin = replace(SMALL, settings=replace(Settings(population=50), algorithm="twin"))
    assert isinstance(begin(twin), GeneticAlgorithm)


def test_our_names_cannot_be_taken():
    with pytest.raises(ValueError, match="the algorithm cma-es is one of wordarm's"):
        register_algorithm("cma-es", GeneticAlgorithm)


def test_settings_of_the_paper_are_written_as_before_and_others_only_where_they_are():
    papers = ["population", "elites", "parents", "generations", "trials_per_area"]
    assert list(Settings().to_mapping()) == papers
    written = CMA_ES.settings.to_mapping()
    assert written == {
        "population": 10, "generations": 130, "trials_per_area": 2, "algorithm": "cma-es", "cma_patience": 3,
    }  # fmt: skip
    assert RunConfig.from_toml(CMA_ES.to_toml()) == CMA_ES
    assert "settings.algorithm = cma-es, not genetic" in CMA_ES.differences(SMALL)


@pytest.mark.parametrize(
    ("values", "sentence"),
    [
        ({"algorithm": "cma-es", "elites": 2}, "setting elites belongs to the algorithm genetic, not to"),
        ({"cma_patience": 5}, "setting cma_patience belongs to the algorithm cma-es, not to genetic"),
        ({"algorithm": "cma-es", "cma_sigma": 0}, "setting cma_sigma = 0.0 must lie in [0.001, 1.0]"),
        ({"algorithm": "cma-es", "cma_sigma": "wide"}, "setting cma_sigma = 'wide' must be a number"),
        ({"algorithm": 3}, "setting algorithm = 3 must be text"),
        ({"algorithm": "../x"}, "setting algorithm = '../x' is no name"),
    ],
)
def test_settings_that_do_not_fit_the_algorithm_are_refused(values, sentence):
    with pytest.raises(ValueError, match=re.escape(sentence)):
        Settings.from_mapping(values)


def test_the_public_names_are_there():
    assert evolution.register_algorithm is register_algorithm
