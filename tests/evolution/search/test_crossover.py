"""Runs with crossover: bred again bit by bit, resumed, verified; and runs without it draw nothing new."""

from dataclasses import replace

import numpy as np
import pytest

from arm2d import Readings
from evolution.agents.lineage import trace_lineage
from evolution.cli import main
from evolution.runs.folder import RunFolder
from evolution.runs.recorded import recorded_history
from evolution.runs.replay import population_at
from evolution.runs.run import Watcher, evolve
from evolution.search.population import first_population, next_population
from evolution.search.scoring import score_population
from tests.evolution.small_runs import SMALL, contents

CROSSED = replace(SMALL, readings=Readings(crossover=0.6))


@pytest.fixture(scope="module")
def crossed_run(tmp_path_factory):
    path = tmp_path_factory.mktemp("crossover") / "run"
    evolve(path, CROSSED)
    return path


def generations_of(config, n):
    """(population, fitness) of the first n generations, scored."""
    population = first_population(config)
    for _ in range(n):
        fitness = score_population(population, config)
        yield population, fitness
        population = next_population(population, fitness, config)


def test_every_population_is_bred_again_from_recorded_fitness(crossed_run):
    folder = RunFolder.open(crossed_run)
    for population, _ in generations_of(CROSSED, 120):
        if population.generation in (1, 2, 57, 119):
            again = population_at(folder, population.generation)
            assert np.array_equal(again.genotypes, population.genotypes)
            assert np.array_equal(again.parents, population.parents)


def test_verify_finds_the_run_the_same_to_the_last_bit(crossed_run, capsys):
    assert main(["verify", str(crossed_run)]) == 0
    assert "agrees to the last bit: 230 of 230 generations scored again" in capsys.readouterr().out


def test_an_interrupted_run_goes_on_with_the_same_bits(crossed_run, tmp_path):
    path, seen = tmp_path / "run", [0]
    for last in (3, 140):
        watcher = Watcher(
            on_generation=lambda progress: seen.append(progress.generation),
            wants_stop=lambda last=last: seen[-1] == last,
        )
        evolve(path, CROSSED, watcher)
        assert seen[-1] == last
    evolve(path, CROSSED)
    assert contents(path) == contents(crossed_run)


def test_without_mutation_every_child_is_its_recorded_parent_up_to_a_cut_and_another_candidate_after_it():
    config = replace(CROSSED, readings=replace(CROSSED.readings, crossover=1.0, mutation_sd=0.0))
    (before, _), (after, _) = generations_of(config, 2)
    for child, parent in zip(after.genotypes[2:], after.parents[2:], strict=True):
        own = child == before.genotypes[parent]
        assert own[0]
        cut = int(own.argmin()) or len(own)
        assert any(np.array_equal(child[cut:], other[cut:]) for other in before.genotypes)
    # Of eight children with five candidates most are other than both parents.
    new = [not (child == before.genotypes).all(axis=1).any() for child in after.genotypes[2:]]
    assert sum(new) >= 4


def test_a_lineage_follows_first_parents(crossed_run):
    folder = RunFolder.open(crossed_run)
    line, history = trace_lineage(folder), recorded_history(folder)
    for row in range(1, len(line)):
        assert history.parents[row, line.indices[row]] == line.indices[row - 1]
    first = [population_at(folder, row).genotypes[line.indices[row]] for row in (0, 1, 100)]
    assert np.array_equal(line.genotypes[[0, 1, 100]], first)


def test_a_crossover_of_nothing_breeds_what_a_run_without_crossover_breeds(finished_run):
    """Its draws come from a stream of their own: parents and mutations are the same with and without them."""
    never = replace(SMALL, readings=Readings(crossover=1e-12))
    history = recorded_history(RunFolder.open(finished_run))
    for population, fitness in generations_of(never, 20):
        assert np.array_equal(population.parents, history.parents[population.generation])
        assert np.array_equal(fitness, history.fitness[population.generation])


def test_parents_of_a_crossed_generation_are_those_of_the_same_fitness_without_crossover():
    (population, fitness), *_ = generations_of(SMALL, 1)
    plain, crossed = (next_population(population, fitness, config) for config in (SMALL, CROSSED))
    assert np.array_equal(plain.parents, crossed.parents)
    assert not np.array_equal(plain.genotypes, crossed.genotypes)
