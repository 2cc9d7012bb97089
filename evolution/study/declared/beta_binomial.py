"""Counts within runs: agents of one run are relatives, so their number scatters far more than a binomial one.

The share of a run is drawn from a beta distribution with mean m and precision s, its count from a binomial:

    k ~ BetaBinomial(n, m s, (1 - m) s),    correlation of two agents of a run 1 / (1 + s)
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

# Log odds of the mean, logarithm of the precision: bounds, and where the search begins.
BOUNDS: Final = ((-14.0, 14.0), (-7.0, 12.0))
STARTS: Final = (-3.0, 0.0, 3.0)
Counts = tuple[NDArray[np.int64], NDArray[np.int64]]  # of k and of n, run by run


@dataclass(frozen=True)
class CountTest:
    """Two groups of runs compared by a count within each.

    Attributes:
        means: Of the first and the second group, as the model has it.
        correlations: Of two agents of one run, likewise.
        p: Likelihood ratio test of equal means, each group with its own precision.
    """

    means: tuple[float, float]
    correlations: tuple[float, float]
    p: float


def compare_counts(first: Counts, second: Counts) -> CountTest:
    """Compare two groups of runs; of runs whose n is 0 nothing can be told, and they are left out.

    Raises:
        ValueError: If a group has no run that tells something.
    """
    groups = [_telling(each) for each in (first, second)]
    own = [_fit([group]) for group in groups]
    together, _ = _fit(groups)
    from scipy.stats import chi2

    gain = max(sum(likelihood for likelihood, _ in own) - together, 0.0)
    means = [_logistic(found[0]) for _, found in own]
    correlations = [1 / (1 + np.exp(found[1])) for _, found in own]
    return CountTest(
        (float(means[0]), float(means[1])),
        (float(correlations[0]), float(correlations[1])),
        float(chi2.sf(2 * gain, 1)),
    )


def _telling(counts: Counts) -> Counts:
    k, n = counts
    if not (n > 0).any():
        raise ValueError("a group of runs has no agents to count in; evolve more runs")
    return k[n > 0], n[n > 0]


def _fit(groups: Sequence[Counts]) -> tuple[float, NDArray[np.float64]]:
    """Largest log-likelihood of groups with one mean, and its parameters: log odds, then log precisions."""
    from scipy.optimize import minimize

    bounds = [BOUNDS[0], *[BOUNDS[1]] * len(groups)]
    found = [
        minimize(_loss, np.array([start, *[0.0] * len(groups)]), args=(groups,), bounds=bounds)
        for start in (*STARTS, _log_odds(groups))
    ]
    best = min(found, key=lambda each: each.fun)
    return -float(best.fun), best.x


def _loss(parameters: NDArray[np.float64], groups: Sequence[Counts]) -> float:
    """Minus the log-likelihood, but for the binomial coefficients, which do not depend on the parameters."""
    from scipy.special import betaln

    mean = _logistic(parameters[0])
    loss = 0.0
    for (k, n), precision in zip(groups, np.exp(parameters[1:]), strict=True):
        a, b = mean * precision, (1 - mean) * precision
        loss -= float((betaln(k + a, n - k + b) - betaln(a, b)).sum())
    return loss


def _log_odds(groups: Sequence[Counts]) -> float:
    """Of the mean share of runs, kept off 0 and 1."""
    share = np.concatenate([k / n for k, n in groups]).mean().clip(1e-4, 1 - 1e-4)
    return float(np.log(share / (1 - share)))


def _logistic(x: float) -> float:
    return float(1 / (1 + np.exp(-x)))
