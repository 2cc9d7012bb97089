"""Which worlds the regressions put nearest to the published figures: the rule of docs/declaration.md.

Axes: N worlds, F factors.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import islice, product
from math import prod
from typing import Final

import numpy as np
from numpy.typing import NDArray

from arm2d import Condition, Readings
from arm2d.records import alike
from evolution.study.declared.factors import FACTORS, world_of
from evolution.study.declared.outcomes import FIGURES
from evolution.study.declared.regression import SIGNIFICANT, SIZES, Model
from evolution.study.declared.rows import MeasuredRun

MOST_WORLDS: Final = 1_000_000
AT_ONCE: Final = 20_000
# Distances that differ by less are equal.
DIGITS: Final = 9
FEWEST_DIFFERENCES: Final = 2  # between the two that are chosen

Models = Mapping[Condition, Sequence[Model]]


@dataclass(frozen=True)
class Nearest:
    """A world that the rule chose.

    Attributes:
        readings: The world.
        distance: From the published figures.
        predicted: By condition, the five figures.
    """

    readings: Readings
    distance: float
    predicted: Mapping[Condition, NDArray[np.float64]]

    __eq__ = alike


def spreads(runs: Sequence[MeasuredRun]) -> dict[Condition, NDArray[np.float64]]:
    """Standard deviation of each figure over the factorial runs of each condition."""
    own = {condition: [run for run in runs if run.config.condition is condition] for condition in Condition}
    return {c: np.array([figure.values(each).std(ddof=1) for figure in FIGURES]) for c, each in own.items()}


def distance(
    figures: Mapping[Condition, NDArray[np.float64]], spread: Mapping[Condition, NDArray[np.float64]]
) -> NDArray[np.float64]:
    """Distance [N] of worlds from the paper; their figures are [N, 5] in each condition.

    A figure that no run differs in has no spread and does not count.
    """
    squares = []
    for condition, found in figures.items():
        published = np.array([figure.published(condition) for figure in FIGURES])
        known = spread[condition] > 0
        squares.append(((found - published)[:, known] / spread[condition][known]) ** 2)
    return np.sqrt(np.concatenate(squares, axis=1).mean(axis=1))


def active_factors(models: Models) -> list[int]:
    """Places of the factors that matter to some figure in some condition, as few as make a million worlds."""
    smallest = np.min([model.corrected for own in models.values() for model in own], axis=0)  # [F]
    order = [int(i) for i in np.argsort(smallest, kind="stable") if smallest[i] < SIGNIFICANT]
    while prod(SIZES[i] for i in order) > MOST_WORLDS:
        order.pop()
    return sorted(order)


def nearest_worlds(models: Models, spread: Mapping[Condition, NDArray[np.float64]]) -> list[Nearest]:
    """The nearest world, and the nearest of those that differ from it in at least two factors.

    Args:
        models: For each condition, of the five `FIGURES`.
        spread: See `spreads`.

    Returns:
        One world if fewer than two factors matter.
    """
    active = active_factors(models)
    parts = [(levels, _figures(models, levels)) for levels in _worlds(active)]
    levels = np.concatenate([part for part, _ in parts])
    figures = {c: np.concatenate([found[c] for _, found in parts]) for c in models}
    far = distance(figures, spread).round(DIGITS)
    order = np.lexsort([(levels > 0).sum(axis=1), far])
    differing = (levels[order] != levels[order[0]]).sum(axis=1)
    others = order[differing >= FEWEST_DIFFERENCES]
    return [
        Nearest(_readings(levels[i]), float(far[i]), {c: found[i] for c, found in figures.items()})
        for i in (order[0], *others[:1])
    ]


def _worlds(active: Sequence[int]) -> Iterator[NDArray[np.int64]]:
    """All combinations of the active factors' levels, some [N, F] at a time, the others at their defaults."""
    combinations = product(*(range(SIZES[factor]) for factor in active))
    while chosen := list(islice(combinations, AT_ONCE)):
        levels = np.zeros((len(chosen), len(FACTORS)), np.int64)
        levels[:, active] = chosen
        yield levels


def _figures(models: Models, levels: NDArray[np.int64]) -> dict[Condition, NDArray[np.float64]]:
    """What is predicted, [N, 5] in each condition."""
    return {c: np.stack([model.predict(levels) for model in own], axis=1) for c, own in models.items()}


def _readings(levels: NDArray[np.int64]) -> Readings:
    return world_of([list(factor.levels)[i] for factor, i in zip(FACTORS, levels, strict=True)])
