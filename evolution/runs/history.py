"""What is kept of scored generations, and its arrays in files.

Axes: G generations in a row, P genotypes, the 5 best of each generation, N genes (three
inter-neurons: 84).
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, fields
from operator import index
from pathlib import Path
from typing import SupportsIndex

import numpy as np
from numpy.typing import NDArray

from arm2d.records import alike, brief
from evolution.runs.storage import DamagedFileError
from evolution.search.algorithm import mean_in_order, rank
from evolution.search.config import RunConfig
from evolution.search.population import Population
from evolution.search.settings import LARGEST_TRIAL_FITNESS, N_BEST


@dataclass(frozen=True)
class History:
    """Scored generations in a row.

    Attributes:
        generations: [G], their numbers.
        fitness: [G, P], of each genotype.
        parents: [G, P], each genotype's parent as an index into the generation before; -1 in generation 0.
        best_genotypes: [G, 5, N], from the best on; equals as the reading `ties` ranks them.
        best: [G], highest fitness,
        mean: [G],
        median: [G],
        worst: [G], lowest.
    """

    generations: NDArray[np.int32]
    fitness: NDArray[np.float64]
    parents: NDArray[np.int16]
    best_genotypes: NDArray[np.float64]
    best: NDArray[np.float64]
    mean: NDArray[np.float64]
    median: NDArray[np.float64]
    worst: NDArray[np.float64]

    __repr__ = brief
    __eq__ = alike

    @classmethod
    def join(cls, histories: Iterable[History]) -> History:
        """Histories that follow each other, as one."""
        parts = list(histories)
        return cls(*(np.concatenate([getattr(each, f.name) for each in parts]) for f in fields(cls)))

    def __len__(self) -> int:
        return len(self.generations)

    def __getitem__(self, rows: slice | SupportsIndex) -> History:
        """The generations of a slice; of a number, which may count from the end, a history of one."""
        if not isinstance(rows, slice):
            row = index(rows)
            if not -len(self) <= row < len(self):
                raise IndexError(f"there is no generation {row} in a history of {len(self)}, counted from 0")
            rows = slice(row % len(self), row % len(self) + 1)
        return History(*(getattr(self, each.name)[rows] for each in fields(self)))

    def arrays(self) -> dict[str, NDArray]:
        """Its arrays by name, as they stand in a part."""
        return {each.name: getattr(self, each.name) for each in fields(self)}


class HistoryBuilder:
    """Collects generations of a run while they are scored."""

    def __init__(self, config: RunConfig) -> None:
        self._generations: list[int] = []
        self._fitness: list[NDArray] = []
        self._parents: list[NDArray] = []
        self._best_genotypes: list[NDArray] = []
        self._readings = config.readings
        self._n_genotypes, self._n_genes = config.settings.population, config.settings.n_genes

    def append(self, population: Population, fitness: NDArray[np.float64]) -> None:
        """Add a generation with the fitness [P] it scored."""
        self._generations.append(population.generation)
        self._fitness.append(fitness)
        self._parents.append(population.parents)
        self._best_genotypes.append(population.genotypes[rank(fitness, self._readings)[:N_BEST]])

    def extend(self, history: History) -> None:
        """Add what was collected before."""
        self._generations.extend(history.generations.tolist())
        self._fitness.extend(history.fitness)
        self._parents.extend(history.parents)
        self._best_genotypes.extend(history.best_genotypes)

    def build(self) -> History:
        """All that was added."""
        n = len(self._generations)
        fitness = np.array(self._fitness, dtype=np.float64).reshape(n, self._n_genotypes)
        best_genotypes = np.array(self._best_genotypes, dtype=np.float64)
        return History(
            generations=np.array(self._generations, dtype=np.int32),
            fitness=fitness,
            parents=np.array(self._parents, dtype=np.int16).reshape(n, self._n_genotypes),
            best_genotypes=best_genotypes.reshape(n, N_BEST, self._n_genes),
            best=fitness.max(axis=1),
            mean=mean_in_order(fitness),
            median=np.median(fitness, axis=1),
            worst=fitness.min(axis=1),
        )


def history_from_arrays(path: Path, arrays: Mapping[str, NDArray], span: range, config: RunConfig) -> History:
    """A history read from a file, held against what it should be.

    Args:
        path: Where the arrays come from, for the message.
        arrays: By name.
        span: The generations they should be of.
        config: The run.

    Raises:
        DamagedFileError: If an array is missing or of another kind, or the generations are others.
    """
    expected = HistoryBuilder(config).build().arrays()
    for name, example in expected.items():
        check_array(path, arrays, name, (len(span), *example.shape[1:]), example.dtype)
    history = History(*(arrays[name] for name in expected))
    if history.generations.tolist() != list(span):
        raise DamagedFileError(path, f"its generations are not {span.start} to {span.stop - 1}")
    for name in ("fitness", "best", "mean", "median", "worst"):
        check_range(path, arrays, name, 0.0, LARGEST_TRIAL_FITNESS)
    check_range(path, arrays, "parents", -1, config.settings.population - 1)
    check_range(path, arrays, "best_genotypes", 0.0, 1.0)
    return history


def check_array(
    path: Path, arrays: Mapping[str, NDArray], name: str, shape: tuple[int, ...], dtype: np.dtype
) -> None:
    """Refuse a file whose array `name` is missing, or of another shape or kind."""
    if name not in arrays:
        raise DamagedFileError(path, f"it has no array {name}")
    array = arrays[name]
    if array.shape != shape or array.dtype != dtype:
        raise DamagedFileError(path, f"its {name} is {array.dtype} {array.shape}, not {dtype} {shape}")


def check_range(path: Path, arrays: Mapping[str, NDArray], name: str, low: float, high: float) -> None:
    """Refuse a file with a number in array `name` that lies outside [low, high], or is none."""
    array = arrays[name]
    if not ((array >= low) & (array <= high)).all():  # False for NaN
        raise DamagedFileError(path, f"its {name} are not all in [{low:g}, {high:g}]")
