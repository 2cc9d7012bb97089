"""Tests between the two conditions: the paper's own, and sound ones (spec section 10).

The paper compares numbers of agents with Wilcoxon's test as if they were independent. The agents of
one run are not: elites survive for hundreds of generations, and relatives behave alike. Here the run
is the unit: each contributes one number, the fraction of its agents in question.

Ranks and Student's t are SciPy's, imported late: that takes a third of a second. Its permutation test gives
the same p only as a one-sided test of how far off a sum is, and takes twenty times as long.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from itertools import chain, combinations
from math import comb
from typing import Final

import numpy as np
from numpy.typing import NDArray

from arm2d.records import alike, brief
from evolution.search.randomness import Purpose, generator

# Above so many ways of sharing out the runs, permutations are drawn instead of counted.
LARGEST_EXACT: Final = 200_000
BOOTSTRAP_SAMPLES: Final = 10_000
# Up to so many runs, all choices of signs are counted.
MOST_FLIPPED: Final = 16
FLIPPED_AT_ONCE: Final = 10_000  # for the memory
NORMAL_95: Final = 1.959964  # two-sided 95 % of a normal distribution


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
    values = np.concatenate([first, second])
    delta = np.sign(np.subtract.outer(first, second)).mean()
    return Comparison(
        means=(float(first.mean()), float(second.mean())),
        difference=float(first.mean() - second.mean()),
        interval=bootstrap_interval([first, second], difference_of_means, rng),
        mann_whitney_p=permutation_test(midranks(values), len(first), rng),
        permutation_p=permutation_test(values, len(first), rng),
        cliffs_delta=float(delta),
    )


def permutation_test(scores: NDArray[np.float64], n: int, rng: np.random.Generator) -> float:
    """Two-sided p: the share of all ways to choose n runs whose scores sum up at least as far off as these.

    Of the values themselves it compares means; of their midranks it is the exact Mann-Whitney test, ties
    included. Counted in full while there are at most `LARGEST_EXACT` ways, otherwise as many are drawn.

    Args:
        scores: One per run; those of the first group come first.
        n: Runs in the first group.
        rng: Draws, where it comes to that.
    """
    return permutation_p(scores, ways_to_choose(len(scores), n, rng))


@dataclass(frozen=True)
class Ways:
    """Ways to choose runs for the first of two groups.

    Attributes:
        chosen: [W, n], numbers of runs.
        complete: Whether these are all the ways, or drawn ones.
    """

    chosen: NDArray[np.int64]
    complete: bool

    __repr__ = brief
    __eq__ = alike


def ways_to_choose(total: int, n: int, rng: np.random.Generator) -> Ways:
    """All ways to choose n of so many runs while there are at most `LARGEST_EXACT`, else as many drawn."""
    if comb(total, n) <= LARGEST_EXACT:
        return Ways(_all_ways(total, n), complete=True)
    return Ways(rng.permuted(np.tile(np.arange(total), (LARGEST_EXACT, 1)), axis=1)[:, :n], complete=False)


@lru_cache(maxsize=2)  # asked for again and again with the same numbers of runs
def _all_ways(total: int, n: int) -> NDArray[np.int64]:
    ways = np.fromiter(chain.from_iterable(combinations(range(total), n)), np.int64).reshape(-1, n)
    ways.setflags(write=False)
    return ways


@lru_cache(maxsize=2)
def declared_ways(total: int, n: int) -> Ways:
    """The same ways for all comparisons of so many runs in a study that was declared beforehand."""
    return ways_to_choose(total, n, generator(0, Purpose.STATISTICS))


def permutation_p(scores: NDArray[np.float64], ways: Ways) -> float:
    """The share of these ways whose scores sum up at least as far off as those of the first runs."""
    n = ways.chosen.shape[1]
    off = np.abs(scores[ways.chosen].sum(axis=1) - n * scores.mean())
    observed = abs(scores[:n].sum() - n * scores.mean())
    extreme = np.count_nonzero(off >= observed - 1e-12 * max(1.0, np.abs(scores).max()))
    return float(extreme / len(off) if ways.complete else (extreme + 1) / (len(off) + 1))


def sign_flip_test(differences: NDArray[np.float64]) -> float:
    """Two-sided p that numbers, one per run, lie around 0.

    It is the share of all choices of their signs whose sum is at least as far off, counted in full up to
    16 runs; beyond, Student's t stands in for it.
    """
    n = len(differences)
    if n > MOST_FLIPPED:
        from scipy.stats import ttest_1samp

        if np.ptp(differences) == 0:
            return 0.0 if differences.any() else 1.0
        return float(ttest_1samp(differences, 0.0)[1])  # type: ignore[arg-type] - typed as object
    signs = 1 - 2 * ((np.arange(2**n)[:, np.newaxis] >> np.arange(n)) & 1)  # [2^n, n]
    off = np.abs(signs @ differences)
    return float((off >= abs(differences.sum()) - 1e-12).mean())


def drawn_sign_flip_test(differences: NDArray[np.float64], rng: np.random.Generator) -> float:
    """The same without Student's t: where there are too many choices of signs to count, as many are drawn.

    For numbers that are mostly 0, as of rare agents. What is 0 has no sign to choose.
    """
    own = differences[differences != 0.0]
    complete = 2 ** len(own) <= LARGEST_EXACT
    observed, extreme, n = abs(own.sum()) - 1e-12, 0, 2 ** len(own) if complete else LARGEST_EXACT
    for first in range(0, n, FLIPPED_AT_ONCE):
        choices = np.arange(first, min(n, first + FLIPPED_AT_ONCE))[:, np.newaxis]
        flipped = (
            choices >> np.arange(len(own)) & 1 if complete else rng.integers(0, 2, (len(choices), len(own)))
        )
        extreme += np.count_nonzero(np.abs((1 - 2 * flipped) @ own) >= observed)
    return float(extreme / n if complete else (extreme + 1) / (n + 1))


def midranks(values: NDArray[np.float64]) -> NDArray[np.float64]:
    """Ranks from 1, equals sharing the mean of theirs."""
    from scipy.stats import rankdata

    return rankdata(values)


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
    samples = [group[rng.integers(0, len(group), (BOOTSTRAP_SAMPLES, len(group)))] for group in groups]
    low, high = np.quantile(statistic(samples), [(1 - level) / 2, (1 + level) / 2])
    return float(low), float(high)


def mean_interval(values: NDArray[np.float64], rng: np.random.Generator) -> tuple[float, float]:
    """95 % interval of the mean over runs."""
    return bootstrap_interval([values], lambda groups: groups[0].mean(axis=1), rng)


def proportion_interval(k: int, n: int) -> tuple[float, float]:
    """95 % interval of k / n: Wilson's."""
    _, low, high = _wilson(k, n)
    return low, high


def proportions_interval(first: tuple[int, int], second: tuple[int, int]) -> tuple[float, float]:
    """95 % interval of k1 / n1 - k2 / n2, each given as (k, n): Newcombe's, made of Wilson's two."""
    (p1, low1, high1), (p2, low2, high2) = _wilson(*first), _wilson(*second)
    difference = p1 - p2
    down, up = np.hypot(p1 - low1, high2 - p2), np.hypot(high1 - p1, p2 - low2)
    return float(difference - down), float(difference + up)


def wilcoxon_as_published(first: NDArray[np.float64], second: NDArray[np.float64]) -> tuple[float, float]:
    """(statistic, two-sided p) of Wilcoxon's rank sum test on numbers that stand for many agents each.

    Kept only to be shown beside the sound tests.
    """
    from scipy.stats import ranksums

    result = ranksums(first, second)
    return float(result.statistic), float(result.pvalue)


def difference_of_means(groups: list[NDArray[np.float64]]) -> NDArray[np.float64]:
    """First less second, for each pair of resampled groups, [samples, runs] each: [samples]."""
    return groups[0].mean(axis=1) - groups[1].mean(axis=1)


def ratio_of_means(groups: list[NDArray[np.float64]]) -> NDArray[np.float64]:
    """First by second, for each pair of resampled groups, [samples, runs] each: [samples]; inf for by 0."""
    first, second = (group.mean(axis=1) for group in groups)
    return np.divide(first, second, out=np.full_like(first, np.inf), where=second > 0)


def _wilson(k: int, n: int) -> tuple[float, float, float]:
    """A proportion with Wilson's 95 % interval."""
    p, z2 = k / n, NORMAL_95**2
    middle, half = p + z2 / (2 * n), NORMAL_95 * (p * (1 - p) / n + z2 / (4 * n**2)) ** 0.5
    return p, (middle - half) / (1 + z2 / n), (middle + half) / (1 + z2 / n)
