from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from arm2d import Readings
from arm2d.constants import N_GENES
from evolution.search.algorithm import breed, choose_parents, initial_genotypes, mean_in_order, mutate, rank
from evolution.search.settings import Settings

SETTINGS = Settings()
READINGS = Readings()


def rng(seed=0):
    return np.random.default_rng(seed)


def test_initial_genes_fill_the_unit_interval():
    genes = initial_genotypes(SETTINGS, rng())
    assert genes.shape == (100, N_GENES)
    assert genes.min() >= 0.0
    assert genes.max() < 1.0
    # 8400 uniform numbers: the standard error of their mean is 0.003.
    assert abs(genes.mean() - 0.5) < 0.015


def test_ranking_goes_from_best_to_worst_and_breaks_ties_by_index():
    assert rank(np.array([1.0, 2.0, 1.0, 3.0, 2.0]), READINGS).tolist() == [3, 1, 4, 0, 2]


def test_children_that_are_as_good_replace_elites_where_they_rank_first():
    readings, fitness = replace(READINGS, ties="children"), np.array([1.0, 2.0, 1.0, 3.0, 2.0])
    assert rank(fitness, readings).tolist() == [3, 4, 1, 2, 0]
    equal = np.ones(100)
    assert choose_parents(equal, SETTINGS, readings, rng())[:3].tolist() == [99, 98, 97]
    assert choose_parents(equal, SETTINGS, READINGS, rng())[:3].tolist() == [0, 1, 2]


def test_mean_is_summed_from_first_to_last():
    values = rng().random((3, 1000))
    expected = [0.0] * 3
    for i in range(1000):
        expected = [total + value for total, value in zip(expected, values[:, i], strict=True)]
    assert mean_in_order(values).tolist() == [total / 1000 for total in expected]


def test_elites_come_first_as_their_own_parents():
    fitness = rng().random(100)
    parents = choose_parents(fitness, SETTINGS, READINGS, rng(1))
    assert parents.shape == (100,)
    assert parents[:3].tolist() == rank(fitness, READINGS)[:3].tolist()


def test_children_descend_from_the_fifty_best_only():
    fitness = rng().random(100)
    for seed in range(20):
        parents = choose_parents(fitness, SETTINGS, READINGS, rng(seed))
        assert set(parents) <= set(rank(fitness, READINGS)[:50])


@pytest.mark.parametrize(("scaling", "power"), [("raw", 1), ("cubed", 3)])
def test_chances_are_proportional_to_scaled_fitness(scaling, power):
    settings = Settings(population=10_000, elites=0, parents=4)
    fitness = np.zeros(10_000)
    fitness[[5, 6, 7, 8]] = 1.0, 2.0, 3.0, 4.0
    parents = choose_parents(fitness, settings, Readings(parent_scaling=scaling), rng())
    expected = fitness[[5, 6, 7, 8]] ** power / (fitness**power).sum()
    shares = np.bincount(parents, minlength=10_000)[[5, 6, 7, 8]] / 10_000
    # Standard deviation of each share is at most 0.005.
    assert np.abs(shares - expected).max() < 0.025


def test_parents_are_drawn_uniformly_when_nobody_scored():
    settings = Settings(population=10_000, elites=0, parents=4)
    parents = choose_parents(np.zeros(10_000), settings, READINGS, rng())
    counts = np.bincount(parents)
    assert counts.shape == (4,)
    assert np.abs(counts / 10_000 - 0.25).max() < 0.025


def test_a_candidate_without_fitness_has_no_children_while_others_score():
    fitness = np.zeros(100)
    fitness[42] = 1e-3
    parents = choose_parents(fitness, SETTINGS, READINGS, rng())
    assert set(parents[3:]) == {42}


@given(st.lists(st.floats(0.0, 3.0), min_size=100, max_size=100), st.integers(0, 2**32))
def test_any_fitness_gives_parents_within_the_population(fitness, seed):
    for scaling in ("raw", "cubed"):
        parents = choose_parents(np.array(fitness), SETTINGS, Readings(parent_scaling=scaling), rng(seed))
        assert parents.min() >= 0
        assert parents.max() < 100


def test_elites_are_copied_unchanged_and_children_are_not():
    genotypes = rng().random((100, N_GENES))
    parents = choose_parents(rng(1).random(100), SETTINGS, READINGS, rng(2))
    offspring = breed(genotypes, parents, SETTINGS, READINGS, rng(3))
    assert np.array_equal(offspring[:3], genotypes[parents[:3]])
    assert (offspring[3:] != genotypes[parents[3:]]).any(axis=1).all()


def test_breeding_leaves_the_parents_as_they_are():
    genotypes = rng().random((100, N_GENES))
    before = genotypes.copy()
    breed(genotypes, np.arange(100), SETTINGS, READINGS, rng(3))
    assert np.array_equal(genotypes, before)


def test_zero_mutation_returns_copies():
    genotypes = rng().random((97, N_GENES))
    assert np.array_equal(mutate(genotypes, 0.0, 0.1, rng()), genotypes)
    assert np.array_equal(mutate(genotypes, 1.0, 0.0, rng()), genotypes)


@pytest.mark.parametrize("probability", [0.04, 0.4])
def test_each_gene_is_moved_with_the_probability_asked_for(probability):
    genotypes = np.full((1000, N_GENES), 0.5)
    moved = mutate(genotypes, probability, 0.01, rng()) != genotypes
    # 84,000 genes: the standard deviation of their share is at most 0.0017; of a column's, 0.016.
    assert abs(moved.mean() - probability) < 0.008
    assert np.abs(moved.mean(axis=0) - probability).max() < 0.08


def test_offsets_are_gaussian_with_the_standard_deviation_asked_for():
    genotypes = np.full((1000, N_GENES), 0.5)
    offsets = np.sort((mutate(genotypes, 1.0, 0.05, rng()) - 0.5).ravel() / 0.05)
    # 84,000 numbers: standard errors are 0.0035 and 0.0025.
    assert abs(offsets.mean()) < 0.017
    assert abs(offsets.std() - 1.0) < 0.012
    # Quantiles of the normal distribution at 15.87, 50 and 97.72 per cent.
    quantiles = offsets[[int(0.1587 * 84_000), 42_000, int(0.9772 * 84_000)]]
    assert np.abs(quantiles - [-1.0, 0.0, 2.0]).max() < 0.04


def test_mutated_genes_stay_within_the_unit_interval():
    genotypes = np.tile([0.0, 1.0], (1000, N_GENES // 2))
    mutated = mutate(genotypes, 1.0, 0.5, rng())
    assert mutated.min() == 0.0
    assert mutated.max() == 1.0


def test_a_child_does_not_depend_on_the_genes_of_its_siblings():
    one, other = rng(1).random((97, N_GENES)), rng(2).random((97, N_GENES))
    other[40] = one[40]
    assert np.array_equal(mutate(one, 0.4, 0.1, rng(3))[40], mutate(other, 0.4, 0.1, rng(3))[40])
