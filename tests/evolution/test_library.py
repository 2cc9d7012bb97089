"""What `import evolution` offers: runs and agents as a user of the library holds them."""

import re
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import evolution
from arm2d import Task
from evolution.agents.parts import late_spans
from evolution.agents.postevaluation import POST_EVALUATION
from evolution.runs.folder import CHAMPIONS, RunFolder
from evolution.runs.run import Watcher
from evolution.runs.storage import make_folder
from evolution.search.config import RunConfig
from evolution.search.settings import Settings
from tests.evolution.made_up import condition_results
from tests.evolution.small_runs import SMALL

API = Path(__file__).parents[2] / "docs" / "api.md"


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


TAKE_A_RUN = (
    evolution.post_evaluate,
    evolution.run_transition_test,
    evolution.observe,
    evolution.verify,
    evolution.trace_lineage,
    evolution.repair,
    evolution.load,
    evolution.find_agent,
)


@pytest.fixture(scope="module")
def planted(run, tmp_path_factory):
    """A copy of the run in which one late agent counts as partially compositional, whatever it can do."""
    copy = evolution.load(shutil.copytree(run.path, tmp_path_factory.mktemp("planted") / "run"))
    make_folder(copy.path / POST_EVALUATION.folder)
    never_met = [copy.condition.instructions.index(word) for word in copy.condition.held_out]
    for span in late_spans(copy):
        successes = np.zeros((len(span), 5, 9), np.int16)
        if 200 in span:
            successes[200 - span.start, 3] = 80
            successes[200 - span.start, 3, never_met[0]] = 0
        arrays = {"generations": np.array(span, np.int32), "successes": successes}
        copy.write_arrays(POST_EVALUATION.path(copy, span), arrays)
    return copy


@pytest.mark.parametrize("take", TAKE_A_RUN, ids=lambda take: take.__name__)
def test_whatever_takes_a_run_takes_its_path(planted, take):
    taken = [take(each) for each in (planted, RunFolder.open(planted.path), planted.path, str(planted.path))]
    assert all(each == taken[0] for each in taken)
    with pytest.raises(ValueError, match=r"no run; give a run, or|names no agent; give a run, its folder"):
        take(3)
    with pytest.raises(ValueError, match=r"nowhere.* is not a folder; give|there is no '.*nowhere'; give"):
        take(str(planted.path / "nowhere"))


def test_the_runs_of_an_experiment_are_runs(run):
    experiment = evolution.open_experiment(run.path)
    assert experiment.all_runs == (run,)
    assert experiment.runs[run.condition] == (run,)
    assert experiment.all_runs[0].history == run.history
    assert experiment.readings == run.readings
    assert not experiment.absent


def test_the_recipe_of_the_page_finds_a_compositional_agent(planted, monkeypatch):
    (recipe,) = re.findall(r"```python\n((?:(?!```).)*evolution\.classify.*?)```", API.read_text(), re.DOTALL)
    assert recipe.count("\n") <= 8
    monkeypatch.chdir(planted.path.parent)
    found = {"np": np, "evolution": evolution}
    exec(recipe, found)
    np.testing.assert_array_equal(found["compositional"].genotype, planted.agent(200, 3).genotype)
    assert str(found["record"].instruction) == "MOVE Blue"


def test_the_best_agent_of_a_condition_can_be_had(run):
    successes = np.zeros((1, 2, 5, 9), np.int16)
    successes[0, 1, 2] = 70
    results = condition_results(run.condition, successes)
    vars(results)["runs"] = (run,)
    best = evolution.best_agent(results)
    assert isinstance(best, evolution.NotableAgent)
    assert evolution.find_agent(best) == run.agent(101, 2)
    with pytest.raises(ValueError, match="agent's place are known; leave generation and rank out"):
        evolution.find_agent(best, generation=3)
    with pytest.raises(ValueError, match="the results of one condition are needed, such as"):
        evolution.best_agent({run.condition: results})  # pyright: ignore[reportArgumentType]


def test_agents_are_compared_by_what_they_are():
    agent, again = evolution.find_agent("best-generaliser"), evolution.find_agent("best-generaliser")
    assert agent == again
    assert {agent: 1}[again] == 1
    assert agent not in (evolution.find_agent("best-specialist"), "best-generaliser")


def test_genes_name_no_agent():
    genes = evolution.find_agent("best-generaliser").genotype
    with pytest.raises(
        ValueError, match="names no agent; give a run, its folder, a genotype file or a shipped"
    ):
        evolution.find_agent(genes)  # pyright: ignore[reportArgumentType]


def test_a_config_of_another_kind_is_refused_before_anything_is_written(tmp_path):
    for config in (Settings(), {}):
        with pytest.raises(ValueError, match=r"config = .* must be a record, such as RunConfig\(settings="):
            evolution.evolve(tmp_path / "run", config)  # pyright: ignore[reportArgumentType]
    assert not (tmp_path / "run").exists()


def test_classes_of_another_task_are_not_observed_nor_is_another_command_advised(tmp_path):
    task = Task(third="both")
    config = RunConfig(task, settings=Settings(population=8, elites=1, parents=4, generations=3))
    run = evolution.evolve(tmp_path / "run", config)
    with pytest.raises(ValueError, match="this analysis is made for the paper's two conditions"):
        evolution.observe(run)


def test_importing_loads_nothing_that_is_not_used():
    code = (
        "import sys, evolution, mujoco_port, models, arm2d; evolution.Settings; models.Robot\n"
        "print(*{'numba', 'mujoco', 'pinocchio', 'matplotlib', 'scipy', 'rich'} & set(sys.modules))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.split() == []
