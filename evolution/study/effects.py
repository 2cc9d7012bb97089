"""What one reading changes by itself, seed by seed.

Two worlds that differ in one reading only, one of them with its plain value, make a pair. Runs of one seed
begin with the same genotypes in both, and in every other world: so a seed gives one number, its mean
difference over the pairs, and seeds are what is counted. Looking at many readings at once is paid for by
Holm's method.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields
from itertools import product
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from arm2d import Condition, Readings
from arm2d.readings import PLAIN
from evolution.report.columns import PlainTable
from evolution.results.statistics import sign_flip_test
from evolution.study.measures import RunMeasures
from evolution.study.table import VariantMeasures, interval

Pair = tuple[VariantMeasures, VariantMeasures]


@dataclass(frozen=True)
class Effect:
    """One reading against its plain value.

    Attributes:
        condition: Of the runs.
        reading: Its name.
        value: What it is changed to.
        pairs: Worlds without and with it, alike in all else.
    """

    condition: Condition
    reading: str
    value: object
    pairs: tuple[Pair, ...]

    @property
    def seeds(self) -> list[int]:
        """Seeds that were evolved in all worlds."""
        return sorted(set.intersection(*(set(_by_seed(variant)) for pair in self.pairs for variant in pair)))

    @property
    def differences(self) -> NDArray[np.float64]:
        """Plateau with minus plateau without, mean over the pairs, for each seed."""
        gains = [
            _plateaus(changed, self.seeds) - _plateaus(without, self.seeds) for without, changed in self.pairs
        ]
        return np.array(gains).mean(axis=0)  # of [pairs, seeds]

    @property
    def without(self) -> list[RunMeasures]:
        """All runs of these seeds without the reading."""
        return [_by_seed(without)[seed] for without, _ in self.pairs for seed in self.seeds]

    @property
    def changed(self) -> list[RunMeasures]:
        """All runs of these seeds with it, in the same order."""
        return [_by_seed(changed)[seed] for _, changed in self.pairs for seed in self.seeds]


def effects(variants: Sequence[VariantMeasures]) -> list[Effect]:
    """Every reading that some pair of worlds differs in, in the order in which variants first have it."""
    found: dict[tuple[Condition, str, object], list[Pair]] = {}
    for changed, without in product(variants, variants):
        differing = _differing(_readings(without), _readings(changed))
        alike = (without.condition, without.generations) == (changed.condition, changed.generations)
        if not alike or len(differing) != 1:
            continue
        (name,) = differing
        if getattr(_readings(without), name) == getattr(PLAIN, name):
            key = (changed.condition, name, getattr(_readings(changed), name))
            found.setdefault(key, []).append((without, changed))
    listed = [Effect(*key, tuple(pairs)) for key, pairs in found.items()]
    return [effect for effect in listed if effect.seeds]


def holm(p: NDArray[np.float64]) -> NDArray[np.float64]:
    """P-values after Holm's correction for as many looks as there are."""
    order = np.argsort(p, kind="stable")
    factors = len(p) - np.arange(len(p))
    corrected = np.empty_like(p)
    corrected[order] = np.minimum(1.0, np.maximum.accumulate(factors * p[order]))
    return corrected


class TestedEffect(NamedTuple):
    """An effect with its p-value, as it is and after Holm's correction."""

    effect: Effect
    p: float
    corrected: float


def effect_table(variants: Sequence[VariantMeasures]) -> PlainTable[TestedEffect]:
    """Every condition and reading in a row."""
    return PlainTable(
        {
            "condition": lambda row: row.effect.condition,
            "reading": lambda row: row.effect.reading,
            "value": lambda row: _shown(row.effect.value),
            "worlds": lambda row: len(row.effect.pairs),
            "seeds": lambda row: len(row.effect.seeds),
            "plateau, difference": lambda row: f"{row.effect.differences.mean():.4f}",
            "low": lambda row: f"{interval(row.effect.differences)[0]:.4f}",
            "high": lambda row: f"{interval(row.effect.differences)[1]:.4f}",
            "p": lambda row: f"{row.p:.4f}",
            "p after Holm": lambda row: f"{row.corrected:.4f}",
            "runs": lambda row: len(row.effect.without),
            "at 18/7 without": lambda row: sum(run.at_limit for run in row.effect.without),
            "at 18/7 with": lambda row: sum(run.at_limit for run in row.effect.changed),
            "solve all trials without": lambda row: sum(run.solved for run in row.effect.without),
            "solve all trials with": lambda row: sum(run.solved for run in row.effect.changed),
        },
        [tested for condition in Condition for tested in _tested(variants, condition)],
    )


def _tested(variants: Sequence[VariantMeasures], condition: Condition) -> list[TestedEffect]:
    """The effects in one condition, each with its p-values."""
    found = [effect for effect in effects(variants) if effect.condition is condition]
    p = np.array([sign_flip_test(effect.differences) for effect in found])
    return [TestedEffect(*row) for row in zip(found, p, holm(p), strict=True)]


def _differing(one: Readings, other: Readings) -> list[str]:
    return [
        field.name for field in fields(Readings) if getattr(one, field.name) != getattr(other, field.name)
    ]


def _readings(variant: VariantMeasures) -> Readings:
    return variant.runs[0].config.readings


def _by_seed(variant: VariantMeasures) -> Mapping[int, RunMeasures]:
    return {run.config.seed: run for run in variant.runs}


def _plateaus(variant: VariantMeasures, seeds: Sequence[int]) -> NDArray[np.float64]:
    """[seeds]."""
    runs = _by_seed(variant)
    return np.array([runs[seed].plateau for seed in seeds])


def _shown(value: object) -> object:
    if isinstance(value, float):
        return f"{value:g}"
    return " ".join(f"{number:g}" for number in value) if isinstance(value, tuple) else value
