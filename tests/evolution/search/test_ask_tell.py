import re
import runpy
import shutil
from dataclasses import replace
from importlib import metadata
from pathlib import Path
from types import SimpleNamespace
from typing import Any, ClassVar

import numpy as np
import pytest

import evolution
from arm2d import Task, draw_trials, run_trials
from evolution.cli import main
from evolution.runs.checkpoint import load_checkpoint, save_checkpoint
from evolution.runs.folder import RunFolder
from evolution.runs.recorded import recorded_generation, recorded_history
from evolution.runs.replay import population_at
from evolution.runs.run import Watcher, evolve
from evolution.search import ask_tell
from evolution.search.ask_tell import begin, maker_of, register_algorithm
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


@pytest.mark.parametrize("name", ["My Alg", "", "-alg", "a" * 41, 3, ["own"]])
def test_a_name_that_no_settings_can_have_is_refused(name):
    with pytest.raises(ValueError, match=re.escape(f"the algorithm cannot be called {name!r}; give at most")):
        register_algorithm(name, GeneticAlgorithm)


@pytest.mark.parametrize("maker", [3, lambda: None, lambda config: None, lambda config, *, state: None])
def test_a_maker_that_takes_other_arguments_is_refused(maker, monkeypatch, tmp_path):
    """When it is registered; one that a package names, before a folder is made."""
    with pytest.raises(ValueError, match="the algorithm own cannot be made by "):
        register_algorithm("own", maker)
    entry = SimpleNamespace(name="offered", load=lambda: maker)
    monkeypatch.setattr(ask_tell, "entry_points", lambda group: [entry])
    config = RunConfig(settings=Settings(algorithm="offered"))
    with pytest.raises(ValueError, match="the algorithm offered cannot be made by "):
        evolve(tmp_path / "run", config)
    assert not (tmp_path / "run").exists()


class Own:
    """A sound one of a user's own: random genotypes, and all that NumPy can make arrays of in its state."""

    kinds: ClassVar = {"genotypes": np.float64, "parents": np.int64}
    changes: ClassVar = {}  # of its state

    def __init__(self, config, generation=0, state=None):
        self.config, self.generation = config, generation
        self.best = 0.0 if state is None else state["best"]

    def genotypes(self):
        rng = np.random.default_rng([self.config.seed, self.generation])
        drawn = rng.random((self.config.settings.population, self.config.settings.n_genes))
        return drawn.astype(self.kinds["genotypes"])

    def ask(self):
        return self.genotypes()

    def tell(self, fitness):
        self.best = max(float(self.best), float(fitness.max()))
        self.generation += 1

    def state(self):
        parents = np.full(self.config.settings.population, -1, self.kinds["parents"])
        own = {"best": self.best, "list": [[1, 2], [3, 4]], "flag": True, "columns": np.eye(3)[:, ::2]}
        return {"genotypes": self.genotypes(), "parents": parents, **own, **self.changes}


@pytest.fixture
def own(monkeypatch):
    """Registers a class, with other things in its state, and gives the run that it searches for."""

    def registered(base=Own, **changes):
        monkeypatch.setitem(ask_tell._registered, "own", type("Changed", (base,), {"changes": changes}))
        return RunConfig(seed=5, settings=Settings(population=10, generations=6, algorithm="own"))

    return registered


@pytest.mark.parametrize(
    "kinds",
    [{}, {"genotypes": np.float32}, {"parents": np.int32}, {"genotypes": ">f8", "parents": np.int8}],
    ids=["usual", "float32", "int32", "foreign"],
)
def test_a_state_of_other_kinds_of_numbers_is_gone_on_with(kinds, own, tmp_path):
    """A stopped run goes on from its checkpoint, and has the bytes of one that was never stopped."""
    config = own(type("Kinds", (Own,), {"kinds": Own.kinds | kinds}))
    evolve(tmp_path / "whole", config)
    seen, notes = [], []
    evolve(tmp_path / "run", config, stopping_at(3))
    evolve(tmp_path / "run", config, Watcher(on_start=seen.append, on_note=notes.append))
    assert (seen, notes) == ([4], [])
    assert contents(tmp_path / "run") == contents(tmp_path / "whole")
    population = first_population(config)
    assert (population.genotypes.dtype, population.parents.dtype) == (np.float64, np.int64)
    for array in population.memory.values():  # as one that comes from a checkpoint
        assert (array.flags.c_contiguous, array.flags.writeable) == (True, False)


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        ({"genotypes": np.zeros((6, 84))}, "gave genotypes of shape (6, 84), not (10, 84)"),
        ({"genotypes": np.zeros(84)}, "gave genotypes of shape (84,), not (10, 84)"),
        ({"genotypes": np.zeros((10, 83))}, "a controller of three inter-neurons needs [P, 84]"),
        ({"genotypes": np.full((10, 84), 1.5)}, "gene 0 of genotype 0 is 1.5; genes lie in [0, 1]"),
        ({"genotypes": np.full((10, 84), np.nan)}, "gave genotypes with what is no number, not finite"),
        ({"genotypes": np.zeros((10, 84))}, "gave other genotypes in state() than in ask(), not the same"),
        ({"genotypes": None}, "gave genotypes as NoneType, not as numbers"),
        ({"parents": np.full(10, 50)}, "gave parents from 50 to 50, not from -1 to 9"),
        ({"parents": np.full(10, -2)}, "gave parents from -2 to -2, not from -1 to 9"),
        ({"parents": np.full(10, 2**64 - 1, np.uint64)}, "to 18446744073709551615, not from -1 to 9"),
        ({"parents": np.zeros(6, int)}, "gave parents as int64 of shape (6,), not whole numbers of shape"),
        ({"parents": np.zeros(10)}, "gave parents as float64 of shape (10,), not whole numbers of shape"),
        ({"word": "text"}, "gave word as str, not as numbers"),
        ({"word": None}, "gave word as NoneType, not as numbers"),
        ({"list": [[1], [1, 2]]}, "gave list as list, not as numbers"),
        ({"complex": np.ones(2, complex)}, "gave complex as ndarray of complex128, not as numbers"),
        ({"mean": np.array([0.0, np.inf])}, "gave mean with what is no number, not finite numbers alone"),
        ({"a\0b": 1.0}, "gave 'a\\x00b' as a name in its state, not plain text"),
        ({f"a{i}": i for i in range(60)}, "gave a state of 66 arrays with "),
        ({"large": np.zeros(2**22 + 1)}, "bytes beside the genotypes, not of at most 64 with 33,554,432"),
    ],
    ids=lambda value: value if isinstance(value, str) else "",
)
def test_a_state_that_no_run_can_keep_is_refused_at_once(changes, sentence, own):
    """In generation 0 and after it."""
    sound = own()
    population = first_population(sound)
    config = own(**changes)
    for hand_over in (first_population, lambda run: next_population(population, np.zeros(10), run)):
        with pytest.raises(ValueError, match=re.escape(sentence)) as caught:
            hand_over(config)
        assert str(caught.value).startswith("the algorithm own gave ")


@pytest.mark.parametrize(
    ("state", "sentence"),
    [
        (None, "gave NoneType as its state, not arrays by name"),
        ({}, "gave a state of nothing, not one with genotypes and parents"),
        ({"genotypes": np.zeros((10, 84)), "mean": 1}, "gave a state of genotypes, mean, not one with"),
    ],
)
def test_a_state_that_lacks_what_a_run_needs_is_refused(state, sentence, own):
    config = own(type("Other", (Own,), {"state": lambda self: state}))
    with pytest.raises(ValueError, match=f"the algorithm own {sentence}"):
        first_population(config)


def test_a_run_scores_what_is_asked_for(own):
    """One whose `ask` draws anew in every call would be scored with other genotypes than it knows of."""
    stream = np.random.default_rng(1)
    config = own(type("Fickle", (Own,), {"ask": lambda self: stream.random((10, 84))}))
    with pytest.raises(ValueError, match=r"the algorithm own gave other genotypes in state\(\) than in ask"):
        first_population(config)


@pytest.mark.parametrize(("step", "reached"), [(0, 3), (2, 5), (-1, 2)])
def test_one_that_does_not_go_on_by_one_generation_is_refused(step, reached, own):
    population = replace(first_population(own()), generation=3)

    def tell(self, fitness):
        self.generation += step

    with pytest.raises(ValueError, match=f"the algorithm own is at generation {reached}, not 4; its maker"):
        next_population(population, np.zeros(10), own(type("Stuck", (Own,), {"tell": tell})))


def test_one_that_forgets_the_generation_it_is_made_with_is_refused(own, tmp_path):
    def begin_anew(self, config, generation, state):
        Own.__init__(self, config, 0, state)

    with pytest.raises(ValueError, match="the algorithm own is at generation 1, not 2; its maker must begin"):
        evolve(tmp_path / "run", own(type("Forgetful", (Own,), {"__init__": begin_anew})))


def test_what_is_no_algorithm_is_refused(own, monkeypatch):
    config = own()
    monkeypatch.setitem(ask_tell._registered, "own", lambda config, generation, state: None)
    with pytest.raises(
        ValueError, match="the algorithm own has no generation; give it generation, ask, tell"
    ):
        first_population(config)


def test_the_record_keeps_the_fitness_that_was_scored(own, tmp_path):
    """Also where `tell` sorts or scales what it is told in place."""

    def tell(self, fitness):
        Own.tell(self, fitness)
        fitness[:] = 7.0

    evolve(tmp_path / "plain", own())
    evolve(tmp_path / "changed", own(type("InPlace", (Own,), {"tell": tell})))
    assert contents(tmp_path / "changed") == contents(tmp_path / "plain")


@pytest.mark.parametrize("task", [Task(words="object-first"), Task(places="dealt")], ids=str)
def test_the_example_looks_at_behaviour_in_the_world_of_its_task(task, map_elites):
    """What it finds out is what run_trials makes of that task's trials, not of the paper's."""
    config = replace(map_elites, condition=task)
    genotypes = np.random.default_rng(2).random((10, 84))
    example: Any = maker_of(config)(config, 0, None)
    found = example.behaviour_of(genotypes)
    trials = draw_trials(task.experienced, 1, config.readings, np.random.default_rng(0), task)[::2]
    scores = run_trials(genotypes, trials, config.readings)
    expected = np.stack([scores.f3.mean(axis=1), scores.steps.mean(axis=1) / 250], axis=1)
    np.testing.assert_array_equal(found, expected)


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
