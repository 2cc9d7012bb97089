"""What `import evolution` offers: runs and agents as a user of the library holds them."""

import subprocess
import sys

import numpy as np
import pytest

import evolution
from evolution.runs.folder import CHAMPIONS
from evolution.runs.run import Watcher
from tests.evolution.small_runs import SMALL


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    return evolution.evolve(tmp_path_factory.mktemp("library") / "run", SMALL)


def test_a_run_tells_what_it_is_on_one_line(run):
    assert repr(run) == f"<Run: with-indicate, seed {SMALL.seed}, {run.path}>"


def test_a_loaded_run_is_the_one_that_evolved(run):
    loaded = evolution.load(str(run.path))
    assert loaded == run
    assert (loaded.condition, loaded.seed, loaded.settings, loaded.readings) == (
        SMALL.condition,
        SMALL.seed,
        SMALL.settings,
        SMALL.readings,
    )
    assert loaded.finished


def test_fitness_is_summed_up_generation_by_generation(run):
    assert run.generations == SMALL.settings.generations
    assert run.fitness.shape == (SMALL.settings.generations, SMALL.settings.population)
    np.testing.assert_array_equal(run.history.best, run.fitness.max(axis=1))
    np.testing.assert_array_equal(run.history.worst, run.fitness.min(axis=1))
    np.testing.assert_array_equal(run.history.median, np.median(run.fitness, axis=1))


def test_genotypes_of_any_generation_hold_those_that_were_kept(run):
    for generation in (0, 117, -1):
        genotypes = run.genotypes(generation)
        assert genotypes.shape == (SMALL.settings.population, 84)
        best = genotypes[run.fitness[generation].argmax()]
        np.testing.assert_array_equal(best, run.agent(generation).genotype)


@pytest.mark.parametrize("generation", [230, -231])
def test_a_generation_that_is_not_there_is_refused(run, generation):
    with pytest.raises(ValueError, match=f"has no generation {generation}; it has 230, numbered from 0"):
        run.genotypes(generation)


def test_champions_are_those_of_the_file_and_say_where_they_stood(run):
    arrays = run.read_arrays(run.path / CHAMPIONS)
    np.testing.assert_array_equal([each.genotype for each in run.champions], arrays["genotypes"])
    first = run.champions[0]
    assert repr(first) == (
        f"<Agent: with-indicate, seed {SMALL.seed}, generation {arrays['generations'][0]}, "
        f"rank {arrays['ranks'][0]}>"
    )
    successes = first.evaluate().successes.sum(axis=-1)
    np.testing.assert_array_equal(successes[0], arrays["successes"][0])


def test_an_unfinished_run_has_agents_but_no_champions(tmp_path):
    stop = Watcher(wants_stop=iter([False] * 3 + [True]).__next__)
    begun = evolution.evolve(tmp_path / "run", SMALL, stop)
    assert not begun.finished
    assert begun.generations == 3
    assert "generation 2, rank 0" in begun.agent().origin
    with pytest.raises(ValueError, match="is not finished and has no champions yet"):
        _ = begun.champions


def test_an_agent_can_be_tried_and_drawn():
    agent = evolution.find_agent("best-generaliser")
    record = agent.record("move red")
    assert repr(record).startswith("<TrialRecord: MOVE Red, carried out in ")
    assert record.instruction in agent.condition.instructions
    other = agent.record("move red", start_area="left", trial_seed=3)
    assert other.alpha[0] > record.alpha[0] + 30
    result = agent.evaluate(per_area=2)
    assert repr(result).startswith("<Evaluation: 1 x 9 instructions x 4 trials, ")
    assert result.success.shape == (1, 9)
    assert agent.origin in [text.get_text() for text in agent.heat_map(per_area=2).texts]
    with pytest.raises(ValueError, match="with-indicate has no instruction IGNORE Red"):
        agent.record("ignore red")
    with pytest.raises(ValueError, match="unknown start area 'middle'; there are right and left"):
        agent.record("move red", start_area="middle")  # pyright: ignore[reportArgumentType]


def test_a_run_is_taken_wherever_a_run_folder_is(run):
    lineage = run.lineage()
    assert len(lineage) == SMALL.settings.generations
    np.testing.assert_array_equal(lineage.genotypes[-1], run.agent().genotype)
    assert evolution.verify(run, chosen=[0]).agrees
    assert "fitness" in run.fitness_curve().axes[0].get_ylabel()


def test_conditions_may_be_named_in_text(run):
    assert evolution.RunConfig("with-ignore").condition is evolution.find_agent("with-ignore").condition
    by_name = evolution.evaluate(run.agent().genotype, "with-indicate", per_area=1)
    np.testing.assert_array_equal(by_name.success, run.agent().evaluate(per_area=1).success)
    with pytest.raises(ValueError, match="unknown condition 'with-nothing'; there are with-indicate, with"):
        evolution.RunConfig("with-nothing")


def test_a_folder_without_a_run_is_named(tmp_path):
    with pytest.raises(ValueError, match=r"holds no run: config\.toml is missing"):
        evolution.load(str(tmp_path))


def test_importing_loads_nothing_that_is_not_used():
    code = (
        "import sys, evolution, mujoco_port, models, arm2d; evolution.Settings; models.Robot\n"
        "print(*{'numba', 'mujoco', 'pinocchio', 'matplotlib', 'scipy', 'rich'} & set(sys.modules))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.split() == []
