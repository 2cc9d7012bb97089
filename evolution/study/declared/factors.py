"""The factors of the factorial study: every reading of the ledger, and a balanced draw of their levels.

A factor is a reading, or readings that only make sense together: the two of mutations, centres and width of
sectors, start areas and their width. Axes: F factors, L levels of all factors together.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from math import prod
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from arm2d import Readings
from arm2d.readings import PLAIN

RESTARTS: Final = 8


@dataclass(frozen=True)
class Factor:
    """Something that is varied.

    Attributes:
        name: For people and tables.
        levels: Readings by the level's name; the first is the default of the time of the declaration.
    """

    name: str
    levels: Mapping[str, Mapping[str, Any]]


def _of_reading(name: str, *values: Any) -> Factor:
    """A factor that is one reading, its default first."""
    return Factor(name, {f"{v:g}" if isinstance(v, float) else v: {name: v} for v in values})


def _mutation(probability: float, sd: float) -> dict[str, float]:
    return {"mutation_probability": probability, "mutation_sd": sd}


def _sectors(centres: tuple[float, float, float], half_width: float) -> dict[str, Any]:
    return {"sector_centres": centres, "sector_half_width": half_width}


EVEN: Final = (30.0, 90.0, 150.0)
FACTORS: Final = (
    Factor(
        "mutation",
        {
            "0.4 / 0.1": _mutation(0.4, 0.1),
            "0.4 / 0.03": _mutation(0.4, 0.03),
            "0.04 / 0.1": _mutation(0.04, 0.1),
            "0.1 / 0.05": _mutation(0.1, 0.05),
        },
    ),
    _of_reading("parent_scaling", "raw", "cubed", "excess", "rank"),
    _of_reading("ties", "elders", "children"),
    _of_reading("crossover", 0.0, 0.3),
    _of_reading("bias_ranges", "symmetric", "negative"),
    _of_reading("tau_exponent_max", 2.0, 1.0, 0.0),
    _of_reading("object_radius", 5.0, 3.0, 8.0, 10.0, 11.8),
    Factor(
        "sectors",
        {
            "30, 90, 150 +- 10": _sectors(EVEN, 10.0),
            "30, 90, 150 +- 5": _sectors(EVEN, 5.0),
            "30, 90, 150 +- 8": _sectors(EVEN, 8.0),
            "45, 90, 135 +- 3": _sectors((45.0, 90.0, 135.0), 3.0),
        },
    ),
    Factor(
        "start_areas",
        {
            "between +- 4": {"start_areas": "between", "start_half_width": 4.0},
            "between +- 0": {"start_areas": "between", "start_half_width": 0.0},
            "between +- 8": {"start_areas": "between", "start_half_width": 8.0},
            "bounds": {"start_areas": "bounds", "start_half_width": 4.0},
        },
    ),
    _of_reading("bound_vision", "at", "near"),
    _of_reading("object_vision", "centre", "any_part"),
    _of_reading("camera_origin", "J1", "end"),
    _of_reading("turn", "degrees", "radians"),
    _of_reading("success", "f1_f2", "f1_f2_f3"),
    _of_reading("run_counting", "uninterrupted", "cumulative"),
    _of_reading("indicate_angle", "narrow", "wide"),
    _of_reading("f3_time", "end", "best"),
    _of_reading("ignore_stops", "early", "never"),
    _of_reading("starts_shared", "generation", "genotype"),
    _of_reading("collision_penalty", "ratio", "whole"),
)  # fmt: skip


def world_of(levels: Sequence[str], factors: Sequence[Factor] = FACTORS) -> Readings:
    """The readings of one level for each factor; refuses with ValueError what `Readings` refuses."""
    values: dict[str, Any] = {}
    for factor, level in zip(factors, levels, strict=True):
        values |= factor.levels[level]
    return PLAIN.with_values(values)


# The default at the time of the declaration, whatever becomes of it.
DECLARED_DEFAULT: Final = world_of([next(iter(factor.levels)) for factor in FACTORS])


@cache  # asked for row by row and column by column
def levels_of(world: Readings) -> tuple[str, ...]:
    """The level of every factor in a world.

    Raises:
        ValueError: If the world has another value of some reading.
    """
    found = []
    for factor in FACTORS:
        fitting = [
            level
            for level, values in factor.levels.items()
            if all(getattr(world, name) == value for name, value in values.items())
        ]
        if not fitting:
            raise ValueError(f"no level of the factor {factor.name} fits these readings: {world}")
        found.append(fitting[0])
    return tuple(found)


def balanced_worlds(n: int, seed: int, factors: Sequence[Factor] = FACTORS) -> tuple[Readings, ...]:
    """Worlds in which all levels and all pairs of levels meet about equally often, also in the first few.

    World after world takes the levels that have met least: from several random draws each factor in turn
    goes to the level that adds least to the sum, over all pairs of levels, of their squared count times the
    number of pairs that two such factors have, until no factor moves; the cheapest is taken. What `Readings`
    refuses, and a world that is there already, is passed over.

    Raises:
        ValueError: If the factors do not make so many worlds.
    """
    if n > (most := prod(len(each.levels) for each in factors)):
        raise ValueError(f"asked for {n} worlds; these factors make {most}")
    rng = np.random.default_rng(seed)
    sizes = [len(each.levels) for each in factors]
    starts = np.cumsum([0, *sizes[:-1]])
    share = np.repeat(sizes, sizes)
    weights = np.outer(share, share)  # [L, L]
    met = np.zeros_like(weights)
    names = [list(each.levels) for each in factors]
    worlds: dict[Readings, None] = {}
    while len(worlds) < n:
        price = weights * (2 * met + 1)
        for row in _cheapest_first(price, starts, sizes, rng):
            try:
                world = world_of([own[i] for own, i in zip(names, row - starts, strict=True)], factors)
            except ValueError:
                continue
            if world not in worlds:
                worlds[world] = None
                met[np.ix_(row, row)] += 1
                break
    return tuple(worlds)


def _cheapest_first(
    price: NDArray[np.int64], starts: NDArray[np.int64], sizes: Sequence[int], rng: np.random.Generator
) -> list[NDArray[np.int64]]:
    """Rows [F] of levels: the ends of descents from random draws, the cheapest first, then these draws."""
    drawn = [starts + rng.integers(0, sizes) for _ in range(RESTARTS)]
    ranges = [range(start, start + size) for start, size in zip(starts.tolist(), sizes, strict=True)]
    prices = price.tolist()  # Python's own numbers: as exact, and quicker one by one
    ends = [np.array(_descend(row.tolist(), prices, ranges)) for row in drawn]
    return sorted(ends, key=lambda row: int(price[np.ix_(row, row)].sum())) + drawn


def _descend(row: list[int], prices: Sequence[Sequence[int]], ranges: Sequence[range]) -> list[int]:
    """Move factor after factor to its cheapest level, beside those of the others, until none moves."""
    beside = [
        sum(of_level[other] for other in row) for of_level in prices
    ]  # [L], of each beside all in the row
    moved = True
    while moved:
        moved = False
        for factor, levels in enumerate(ranges):
            now = row[factor]
            # A pair stands twice in the price, a level by itself once.
            costs = {
                level: 2 * (beside[level] - prices[level][now]) + prices[level][level] for level in levels
            }
            best = min(levels, key=costs.__getitem__)
            if costs[best] < costs[now]:
                beside = [sum_ + of[best] - of[now] for sum_, of in zip(beside, prices, strict=True)]
                row[factor], moved = best, True
    return row
