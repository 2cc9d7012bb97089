from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from arm2d import Readings
from arm2d.constants import N_GENES
from arm2d.readings import PLAIN, choices
from evolution.search.algorithm import (
    Crossings,
    breed,
    choose_crossings,
    choose_parents,
    initial_genotypes,
    mean_in_order,
    mutate,
    rank,
)
from evolution.search.settings import Settings

SETTINGS = Settings()
READINGS = PLAIN


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


def shares_of_children(fitness, n_candidates, **readings):
    """The share of 10,000 children that each of a few genotypes has; all others of the population score 0."""
    settings = Settings(population=10_000, elites=0, parents=n_candidates)
    everybody = np.zeros(10_000)
    everybody[: len(fitness)] = fitness
    parents = choose_parents(everybody, settings, replace(READINGS, **readings), rng())
    return np.bincount(parents, minlength=len(fitness))[: len(fitness)] / 10_000


@pytest.mark.parametrize(
    ("fitness", "expected"),
    [
        # The best genotype that is no candidate scores 1.
        ([4.0, 2.0, 1.5, 1.0], [3.0 / 4.5, 1.0 / 4.5, 0.5 / 4.5, 0.0]),
        ([1.0, 2.0, 1.5, 4.0], [0.0, 1.0 / 4.5, 0.5 / 4.5, 3.0 / 4.5]),
        # A tie with it leaves a candidate without children, and a tie above it is shared.
        ([2.0, 2.0, 1.0, 1.0], [0.5, 0.5, 0.0, 0.0]),
        # No excess is positive: uniformly among the candidates.
        ([1.0, 1.0, 1.0, 1.0], [1 / 3, 1 / 3, 1 / 3, 0.0]),
    ],
)
def test_excess_is_what_a_candidate_scores_above_the_best_that_is_none(fitness, expected):
    # Standard deviation of each share is at most 0.005.
    assert shares_of_children(fitness, 3, parent_scaling="excess") == pytest.approx(expected, abs=0.025)


def test_uniform_draws_among_equals_keep_to_the_candidates_of_the_reading_of_ties():
    settings, equal = Settings(population=100, elites=0, parents=50), np.ones(100)
    for ties, candidates in (("elders", range(50)), ("children", range(50, 100))):
        readings = Readings(parent_scaling="excess", ties=ties)
        drawn = np.concatenate([choose_parents(equal, settings, readings, rng(seed)) for seed in range(20)])
        assert set(drawn) == set(candidates)


def test_excess_is_the_fitness_itself_where_all_are_candidates():
    settings, fitness = Settings(population=30, parents=30), rng().random(30)
    one, other = (
        choose_parents(fitness, settings, Readings(parent_scaling=each), rng(1)) for each in ("raw", "excess")
    )
    assert np.array_equal(one, other)


def test_rank_falls_from_two_for_the_best_to_nothing_for_the_last_candidate():
    expected = np.array([2.0, 1.5, 1.0, 0.5, 0.0]) / 5.0
    shares = shares_of_children([9.0, 8.5, 3.0, 2.9, 0.1], 5, parent_scaling="rank")
    assert shares == pytest.approx(expected, abs=0.025)
    # Ranks do not depend on distances, nor on whether anybody scored; of equals, elders rank first.
    again = shares_of_children([0.0] * 5, 5, parent_scaling="rank")
    assert np.array_equal(again, shares)


def test_a_single_candidate_has_all_children_under_every_scaling():
    settings, fitness = Settings(parents=1), rng().random(100)
    for scaling in choices()["parent_scaling"]:
        parents = choose_parents(fitness, settings, Readings(parent_scaling=scaling), rng(1))
        assert set(parents[3:]) == {int(fitness.argmax())}


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
    for scaling in choices()["parent_scaling"]:
        readings = Readings(parent_scaling=scaling)
        parents = choose_parents(np.array(fitness), SETTINGS, readings, rng(seed))
        assert set(parents) <= set(rank(np.array(fitness), readings)[:50])


def test_elites_are_copied_unchanged_and_children_are_not():
    genotypes = rng().random((100, N_GENES))
    parents = choose_parents(rng(1).random(100), SETTINGS, READINGS, rng(2))
    offspring = breed(genotypes, parents, SETTINGS, READINGS, rng(3))
    assert np.array_equal(offspring[:3], genotypes[parents[:3]])
    assert (offspring[3:] != genotypes[parents[3:]]).any(axis=1).all()


def test_crossed_child_has_its_parents_genes_up_to_the_cut_and_a_second_parents_after_it():
    settings, genotypes = Settings(population=5, elites=1, parents=3), rng().random((5, N_GENES))
    parents = np.array([4, 4, 2, 2, 0])
    crossings = Crossings(second_parents=np.array([0, 1, 3, 1]), cuts=np.array([1, 50, 83, 84]))
    offspring = breed(genotypes, parents, settings, Readings(mutation_sd=0.0), rng(), crossings)
    assert np.array_equal(offspring[0], genotypes[4])
    for child, first, second, cut in ((1, 4, 0, 1), (2, 2, 1, 50), (3, 2, 3, 83), (4, 0, 1, 84)):
        expected = np.concatenate([genotypes[first, :cut], genotypes[second, cut:]])
        assert np.array_equal(offspring[child], expected)


def test_mutation_comes_after_crossover():
    genotypes, parents = rng().random((100, N_GENES)), np.arange(100)
    crossings = Crossings(np.arange(97), np.full(97, 42))
    crossed = breed(genotypes, parents, SETTINGS, Readings(mutation_sd=0.0), rng(1), crossings)
    assert np.array_equal(
        breed(genotypes, parents, SETTINGS, READINGS, rng(1), crossings),
        breed(crossed, parents, SETTINGS, READINGS, rng(1)),
    )


def test_crossover_happens_with_the_probability_asked_for_at_any_gene_but_the_first():
    settings, fitness = Settings(population=10_000, elites=0), rng().random(10_000)
    cuts = choose_crossings(fitness, settings, Readings(crossover=0.3), rng(1)).cuts
    # Standard deviation 0.0046.
    assert np.mean(cuts < N_GENES) == pytest.approx(0.3, abs=0.023)
    always = choose_crossings(fitness, settings, Readings(crossover=1.0), rng(1)).cuts
    assert set(always) == set(range(1, N_GENES))
    assert np.array_equal(always[cuts < N_GENES], cuts[cuts < N_GENES])
    # 120 cuts are expected at each gene; the standard deviation is 11.
    assert np.abs(np.bincount(always)[1:] - 10_000 / 83).max() < 55


def test_second_parents_are_drawn_as_the_first_ones_are():
    settings, readings = Settings(population=10_000, elites=0, parents=4), Readings(crossover=1.0)
    fitness = np.zeros(10_000)
    fitness[[5, 6, 7, 8]] = 1.0, 2.0, 3.0, 4.0
    seconds = choose_crossings(fitness, settings, readings, rng()).second_parents
    shares = np.bincount(seconds, minlength=10_000)[[5, 6, 7, 8]] / 10_000
    assert np.abs(shares - [0.1, 0.2, 0.3, 0.4]).max() < 0.025


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
