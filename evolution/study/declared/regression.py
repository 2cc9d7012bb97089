"""What each level does to an outcome, all others being mixed: the regressions of the factorial study.

As declared in docs/declaration.md: least squares for the plateau, (fractional) logistic regression for
shares, robust errors, and the interactions that the rule stated there admits. Axes: R runs, F factors, P
parameters.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import combinations
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from arm2d.records import alike, brief
from evolution.results.statistics import NORMAL_95
from evolution.study.declared.factors import FACTORS, levels_of
from evolution.study.declared.outcomes import Outcome
from evolution.study.declared.rows import MeasuredRun
from evolution.study.effects import holm

SIGNIFICANT: Final = 0.05
RUNS_PER_PARAMETER: Final = 5
FEWEST_RUNS_PER_PARAMETER: Final = 2
TINY: Final = 1e-12  # a share of 0, as log odds
SIZES: Final = tuple(len(each.levels) for each in FACTORS)
N_MAIN: Final = 1 + sum(size - 1 for size in SIZES)
Pair = tuple[int, int]  # of factors, by their place in FACTORS


@dataclass(frozen=True)
class Estimate:
    """A number with its 95 % interval."""

    value: float
    low: float
    high: float


def estimate_columns(
    *names: str, of: Callable[[Any], Estimate], form: str = ".4f"
) -> dict[str, Callable[[Any], str]]:
    """Three columns of a table: an estimate's value, low and high end.

    Args:
        names: Of the columns.
        of: The estimate of what a row is about.
        form: How the numbers are written.
    """
    ends = ("value", "low", "high")
    return {
        name: lambda row, end=end: format(getattr(of(row), end), form)
        for name, end in zip(names, ends, strict=True)
    }


@dataclass(frozen=True)
class Model:
    """A fitted regression of one outcome.

    Attributes:
        outcome: The outcome.
        levels: [R, F], of the runs it was fitted to, as numbers of levels.
        interactions: Pairs of factors that have parameters of their own.
        coefficients: [P], of `design`,
        covariance: [P, P], robust.
        p: By factor, of the Wald test that a factor does nothing, without interactions,
        corrected: and after Holm's correction over the factors.
        tried: Interactions tried, with their p after Holm's correction.
    """

    outcome: Outcome
    levels: NDArray[np.int64]
    interactions: tuple[Pair, ...]
    coefficients: NDArray[np.float64]
    covariance: NDArray[np.float64]
    p: NDArray[np.float64]
    tried: Mapping[Pair, float]

    __repr__ = brief
    __eq__ = alike

    @cached_property
    def corrected(self) -> NDArray[np.float64]:
        """[F]."""
        return holm(self.p)

    def predict(self, levels: NDArray[np.int64]) -> NDArray[np.float64]:
        """What is expected of runs with these levels [R, F], [R]."""
        return self._mean_of(design(levels, self.interactions) @ self.coefficients)

    def level_mean(self, factor: int, level: int) -> Estimate:
        """What is expected on average if all runs had this level."""
        return self._estimate(*self._average(factor, level))

    def effect(self, factor: int, level: int) -> Estimate:
        """What is expected on average with this level, less what is with the factor's default."""
        mean, gradient = self._average(factor, level)
        default_mean, default_gradient = self._average(factor, 0)
        return self._estimate(mean - default_mean, gradient - default_gradient)

    def _average(self, factor: int, level: int) -> tuple[float, NDArray[np.float64]]:
        """Mean prediction if all runs had this level, and its gradient [P]."""
        levels = self.levels.copy()
        levels[:, factor] = level
        x = design(levels, self.interactions)
        mean = self._mean_of(x @ self.coefficients)
        slope = mean * (1 - mean) if self.outcome.is_share else np.ones_like(mean)
        return float(mean.mean()), (slope[:, np.newaxis] * x).mean(axis=0)

    def _estimate(self, value: float, gradient: NDArray[np.float64]) -> Estimate:
        """A number and its interval by the delta method."""
        error = float(np.sqrt(max(gradient @ self.covariance @ gradient, 0.0)))
        return Estimate(value, value - NORMAL_95 * error, value + NORMAL_95 * error)

    def _mean_of(self, linear: NDArray[np.float64]) -> NDArray[np.float64]:
        return 1 / (1 + np.exp(-linear)) if self.outcome.is_share else linear


def fit(runs: Sequence[MeasuredRun], outcome: Outcome) -> Model:
    """The declared regression of an outcome, interactions chosen by the rule.

    Raises:
        ValueError: If there are too few runs for it, or statsmodels is missing.
    """
    if len(runs) < FEWEST_RUNS_PER_PARAMETER * N_MAIN:
        raise ValueError(
            f"{len(runs)} runs of a condition are measured; the regression has {N_MAIN} parameters without "
            f"interactions and needs {FEWEST_RUNS_PER_PARAMETER * N_MAIN} runs: evolve more of them"
        )
    levels, values = level_numbers(runs), outcome.values(runs)
    if np.ptp(values) == 0:
        return _constant(outcome, levels, values[0])
    values = _mixed(outcome, values)
    main = _fitted(outcome, values, design(levels))
    p = np.array([_wald(main, _columns(factor)) for factor in range(len(FACTORS))])
    tried = _tried(outcome, values, levels, np.flatnonzero(holm(p) < SIGNIFICANT))
    interactions = _admitted(tried, len(runs))
    result = _fitted(outcome, values, design(levels, interactions))
    return Model(
        outcome, levels, interactions, np.asarray(result.params), np.asarray(result.cov_params()), p, tried
    )


def _constant(outcome: Outcome, levels: NDArray[np.int64], value: float) -> Model:
    """The model of an outcome that is the same in all runs: no factor does anything."""
    coefficients = np.zeros(N_MAIN)
    coefficients[0] = np.log(max(value, TINY) / max(1 - value, TINY)) if outcome.is_share else value
    return Model(outcome, levels, (), coefficients, np.zeros((N_MAIN, N_MAIN)), np.ones(len(FACTORS)), {})


def level_numbers(runs: Sequence[MeasuredRun]) -> NDArray[np.int64]:
    """The number of every run's level of each factor, [R, F]; 0 is the default."""
    names = [list(each.levels) for each in FACTORS]
    return np.array(
        [
            [own.index(level) for own, level in zip(names, levels_of(run.config.readings), strict=True)]
            for run in runs
        ]
    )


def design(levels: NDArray[np.int64], interactions: Sequence[Pair] = ()) -> NDArray[np.float64]:
    """The regression's matrix [R, P]: 1, a column for each level but defaults, products of interactions."""
    of_factor = [
        (levels[:, [factor]] == np.arange(1, size)).astype(float) for factor, size in enumerate(SIZES)
    ]
    products = [
        (of_factor[one][:, :, np.newaxis] * of_factor[other][:, np.newaxis, :]).reshape(len(levels), -1)
        for one, other in interactions
    ]
    return np.concatenate([np.ones((len(levels), 1)), *of_factor, *products], axis=1)


def _columns(factor: int) -> slice:
    """Where a factor's levels stand in the matrix."""
    start = 1 + sum(size - 1 for size in SIZES[:factor])
    return slice(start, start + SIZES[factor] - 1)


def _mixed(outcome: Outcome, values: NDArray[np.float64]) -> NDArray[np.float64]:
    """Shares mixed with their mean, so that no level has an infinite effect; others as they are."""
    if not outcome.is_share:
        return values
    weight = N_MAIN / len(values)
    return (values + weight * values.mean()) / (1 + weight)


def _fitted(outcome: Outcome, values: NDArray[np.float64], x: NDArray[np.float64]) -> Any:
    """The regression's result, with robust errors."""
    try:
        import statsmodels.api as sm
    except ImportError:
        raise ValueError(
            "the regression needs statsmodels; install it with: pip install 'wordarm[study]'"
        ) from None
    if outcome.is_share:
        return sm.GLM(values, x, family=sm.families.Binomial()).fit(cov_type="HC1")
    return sm.OLS(values, x).fit(cov_type="HC3")


def _wald(result: Any, columns: slice) -> float:
    """Two-sided p that all these parameters are 0."""
    where = np.eye(len(result.params))[columns]
    return float(result.wald_test(where, use_f=False, scalar=True).pvalue)


def _tried(
    outcome: Outcome, values: NDArray[np.float64], levels: NDArray[np.int64], strong: NDArray[np.int64]
) -> dict[Pair, float]:
    """Pairs of strong factors all of whose levels met, with their corrected p on top of the main effects."""
    pairs = [(int(a), int(b)) for a, b in combinations(strong, 2) if _all_met(levels, int(a), int(b))]
    p = [_wald(_fitted(outcome, values, design(levels, [pair])), slice(N_MAIN, None)) for pair in pairs]
    return dict(zip(pairs, holm(np.array(p)).tolist(), strict=True)) if pairs else {}


def _all_met(levels: NDArray[np.int64], one: int, other: int) -> bool:
    return len(np.unique(levels[:, [one, other]], axis=0)) == SIZES[one] * SIZES[other]


def _admitted(tried: Mapping[Pair, float], n_runs: int) -> tuple[Pair, ...]:
    """Those with a small p, the smallest first, while there are enough runs for so many parameters."""
    admitted, n = [], N_MAIN
    for pair in sorted(tried, key=lambda pair: tried[pair]):
        n += (SIZES[pair[0]] - 1) * (SIZES[pair[1]] - 1)
        if tried[pair] >= SIGNIFICANT or n * RUNS_PER_PARAMETER > n_runs:
            break
        admitted.append(pair)
    return tuple(admitted)
