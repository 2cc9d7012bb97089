"""Tests between the two conditions: the paper's own, and sound ones (spec section 10).

The paper compares numbers of agents with Wilcoxon's test as if they were independent. The agents of
one run are not: elites survive for hundreds of generations, and relatives behave alike. Here the run
is the unit: each contributes one number, the fraction of its agents in question.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import combinations
from math import comb
from typing import Final

import numpy as np
from numpy.typing import NDArray

# Above so many ways of sharing out the runs, permutations are drawn instead of counted.
LARGEST_EXACT: Final = 200_000
BOOTSTRAP_SAMPLES: Final = 10_000


@dataclass(frozen=True)
class Comparison:
    """One number per run, compared between two conditions.

    Attributes:
        means: Of the first and of the second condition.
        difference: First minus second.
        interval: 95 % bootstrap interval of the difference; whole runs are drawn within each condition.
        mann_whitney_p: Exact two-sided Mann-Whitney test on runs.
        permutation_p: Two-sided permutation test of the difference of means, runs exchanged.
        cliffs_delta: P(first > second) - P(first < second) for two runs drawn at random, in [-1, 1].
    """

    means: tuple[float, float]
    difference: float
    interval: tuple[float, float]
    mann_whitney_p: float
    permutation_p: float
    cliffs_delta: float


def compare(first: NDArray[np.float64], second: NDArray[np.float64], rng: np.random.Generator) -> Comparison:
    """Compare two conditions by one number per run.

    Raises:
        ValueError: If a condition has no run.
    """
    if not len(first) or not len(second):
        raise ValueError(
            f"a comparison needs runs of both conditions; there are {len(first)} and {len(second)}"
        )
    delta = np.sign(np.subtract.outer(first, second)).mean()
    return Comparison(
        means=(float(first.mean()), float(second.mean())),
        difference=float(first.mean() - second.mean()),
        interval=bootstrap_interval([first, second], _difference_of_means, rng),
        mann_whitney_p=permutation_test(first, second, rank_statistic, rng),
        permutation_p=permutation_test(first, second, mean_statistic, rng),
        cliffs_delta=float(delta),
    )


def permutation_test(
    first: NDArray[np.float64],
    second: NDArray[np.float64],
    statistic: Callable[[NDArray[np.float64], NDArray[np.bool_]], float],
    rng: np.random.Generator,
) -> float:
    """Two-sided p: the share of all ways to share out the runs that differ at least as much as these do.

    With the rank statistic this is the exact Mann-Whitney test, ties included. Counted in full while
    there are at most `LARGEST_EXACT` ways, otherwise as many are drawn.
    """
    values, n, total = np.concatenate([first, second]), len(first), len(first) + len(second)
    observed = statistic(values, np.arange(total) < n)
    if comb(total, n) <= LARGEST_EXACT:
        chosen = combinations(range(total), n)
        masks = (_mask(indices, total) for indices in chosen)
        extreme = [statistic(values, mask) >= observed - 1e-12 for mask in masks]
        return float(np.mean(extreme))
    masks = (rng.permutation(total) < n for _ in range(LARGEST_EXACT))
    extreme = sum(statistic(values, mask) >= observed - 1e-12 for mask in masks)
    return (extreme + 1) / (LARGEST_EXACT + 1)


def bootstrap_interval(
    groups: list[NDArray[np.float64]],
    statistic: Callable[[list[NDArray[np.float64]]], NDArray[np.float64]],
    rng: np.random.Generator,
    level: float = 0.95,
) -> tuple[float, float]:
    """Percentile interval; runs are drawn with replacement within each group.

    Args:
        groups: One number per run, for each group.
        statistic: From resampled groups, each [samples, runs], to [samples].
        rng: Draws the samples.
        level: Of confidence.
    """
    samples = [each[rng.integers(0, len(each), (BOOTSTRAP_SAMPLES, len(each)))] for each in groups]
    low, high = np.quantile(statistic(samples), [(1 - level) / 2, (1 + level) / 2])
    return float(low), float(high)


def mean_interval(values: NDArray[np.float64], rng: np.random.Generator) -> tuple[float, float]:
    """95 % interval of the mean over runs."""
    return bootstrap_interval([values], lambda groups: groups[0].mean(axis=1), rng)


def wilcoxon_as_published(first: NDArray[np.float64], second: NDArray[np.float64]) -> tuple[float, float]:
    """(statistic, two-sided p) of Wilcoxon's rank sum test on numbers that stand for many agents each.

    Kept only to be shown beside the sound tests. SciPy is imported late: it takes a third of a second.
    """
    from scipy.stats import ranksums

    result = ranksums(first, second)
    return float(result.statistic), float(result.pvalue)


def _mask(indices: tuple[int, ...], total: int) -> NDArray[np.bool_]:
    mask = np.zeros(total, bool)
    mask[list(indices)] = True
    return mask


def mean_statistic(values: NDArray[np.float64], mask: NDArray[np.bool_]) -> float:
    """Distance between the means of the masked values and of the others."""
    return abs(float(values[mask].mean() - values[~mask].mean()))


def rank_statistic(values: NDArray[np.float64], mask: NDArray[np.bool_]) -> float:
    """Distance of Mann-Whitney's U from its expectation, ties counting one half."""
    u = (0.5 * (1.0 + np.sign(np.subtract.outer(values[mask], values[~mask])))).sum()
    return abs(float(u) - 0.5 * mask.sum() * (~mask).sum())


def _difference_of_means(groups: list[NDArray[np.float64]]) -> NDArray[np.float64]:
    return groups[0].mean(axis=1) - groups[1].mean(axis=1)
