"""Tests between conditions, against SciPy and cases worked out by hand."""

import numpy as np
import pytest
from scipy import stats

from evolution.results.statistics import (
    bootstrap_interval,
    compare,
    drawn_sign_flip_test,
    mean_interval,
    midranks,
    permutation_test,
    sign_flip_test,
)

RNG = np.random.default_rng(0)


def rng():
    return np.random.default_rng(5)


def test_exact_mann_whitney_agrees_with_scipy_without_ties():
    first, second = RNG.normal(size=7), RNG.normal(0.8, size=6)
    ours = permutation_test(midranks(np.concatenate([first, second])), 7, rng())
    theirs = stats.mannwhitneyu(first, second, method="exact").pvalue
    assert ours == pytest.approx(theirs, rel=1e-12)


def test_equal_values_share_their_ranks():
    assert midranks(np.array([3.0, 1.0, 3.0, 0.0])).tolist() == [3.5, 2.0, 3.5, 1.0]


def test_permutation_test_of_means_agrees_with_scipy():
    first, second = RNG.normal(size=5), RNG.normal(1.0, size=6)
    ours = permutation_test(np.concatenate([first, second]), 5, rng())
    theirs = stats.permutation_test(
        (first, second), lambda a, b: abs(a.mean() - b.mean()), n_resamples=np.inf, alternative="greater"
    ).pvalue
    assert ours == pytest.approx(theirs)


def test_two_equal_groups_do_not_differ():
    values = np.array([0.0, 0.1, 0.2])
    result = compare(values, values, rng())
    assert (result.difference, result.cliffs_delta) == (0.0, 0.0)
    assert result.mann_whitney_p == result.permutation_p == 1.0
    assert result.interval[0] < 0 < result.interval[1]


def test_groups_apart_give_the_smallest_p_there_is():
    result = compare(np.array([1.0, 2.0, 3.0]), np.array([-1.0, -2.0, -3.0]), rng())
    assert result.mann_whitney_p == pytest.approx(2 / 20)
    assert result.cliffs_delta == 1.0


def test_many_runs_are_permuted_by_chance_and_p_is_never_zero():
    first, second = np.arange(12.0), np.arange(12.0) + 100
    p = permutation_test(np.concatenate([first, second]), 12, rng())
    assert 0 < p < 1e-4


def test_bootstrap_interval_of_a_constant_is_the_constant():
    assert mean_interval(np.full(8, 0.25), rng()) == (0.25, 0.25)


@pytest.mark.parametrize("level", [0.95, 0.8])
def test_bootstrap_interval_leaves_out_equal_shares_of_ten_thousand_samples(level):
    """Runs drawn group by group, sample by sample; the sorted samples are counted off from both ends."""
    groups, draws = [np.array([1.0, 2.0, 4.0, 8.0]), np.array([3.0, 3.5, 7.0])], rng()
    samples = [group[draws.integers(0, len(group), (10_000, len(group)))] for group in groups]
    differences = np.sort(samples[0].mean(axis=1) - samples[1].mean(axis=1))
    found = bootstrap_interval(groups, lambda g: g[0].mean(axis=1) - g[1].mean(axis=1), rng(), level)
    places = [(1 - level) / 2 * 9999, (1 + level) / 2 * 9999]
    assert found == pytest.approx(np.interp(places, np.arange(10_000), differences), abs=1e-9)


def test_bootstrap_resamples_each_group_apart():
    low, high = bootstrap_interval([np.zeros(4), np.ones(4)], lambda g: g[1].mean(1) - g[0].mean(1), rng())
    assert (low, high) == (1.0, 1.0)


def test_comparison_without_runs_is_refused():
    with pytest.raises(ValueError, match="a comparison needs runs of both conditions; there are 0 and 3"):
        compare(np.empty(0), np.ones(3), rng())


def test_sign_flips_give_the_exact_p():
    assert sign_flip_test(np.array([1.0, 2.0, 3.0])) == pytest.approx(2 / 8)
    assert sign_flip_test(np.array([1.0, -1.0])) == 1


def test_sign_flips_agree_with_scipy_up_to_sixteen_runs_and_are_students_test_beyond():
    differences = RNG.normal(0.3, 1.0, 11)
    theirs = stats.permutation_test(
        (differences,),
        lambda flipped: abs(flipped.sum()),
        permutation_type="samples",
        n_resamples=np.inf,
        alternative="greater",
    ).pvalue
    assert sign_flip_test(differences) == pytest.approx(theirs)
    many = RNG.normal(0.3, 1.0, 17)
    assert sign_flip_test(many) == pytest.approx(stats.ttest_1samp(many, 0.0).pvalue, rel=1e-12)


def test_worlds_alike_in_every_run_do_not_differ_however_many_runs_there_are():
    for n in (4, 16, 17, 40):
        assert sign_flip_test(np.zeros(n)) == 1.0
    assert sign_flip_test(np.full(17, 0.5)) == 0.0


def test_drawn_signs_give_what_counted_ones_do_and_zeros_have_no_sign():
    """SciPy's permutation test of pairs draws signs, too."""
    rng = np.random.default_rng(3)
    few = rng.normal(0.3, 1, 14)
    for zeros in (0, 100):
        found = drawn_sign_flip_test(np.concatenate([few, np.zeros(zeros)]), np.random.default_rng(0))
        assert found == sign_flip_test(few)
    many = rng.exponential(1.0, 40) * rng.choice([-1, 1, 1], 40)
    theirs = stats.permutation_test(
        (many,), np.sum, permutation_type="samples", n_resamples=100_000, rng=np.random.default_rng(1)
    )
    found = drawn_sign_flip_test(many, np.random.default_rng(0))
    assert found == pytest.approx(float(theirs.pvalue), rel=0.1)
    assert drawn_sign_flip_test(np.zeros(30), rng) == 1.0
    assert drawn_sign_flip_test(np.ones(40), rng) == pytest.approx(1 / 200_001)
