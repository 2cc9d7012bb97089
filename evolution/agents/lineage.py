"""The line of ancestors of one agent, from generation 0 to itself.

Parents are recorded as indices, so the line is first walked backwards through them; then the run's
populations are bred again from generation 0 on, once, and the ancestor of each is kept. Nothing is
scored. Where a child has two parents (reading `crossover`), the line follows the first, whose genes stand
before the cut; genes after it then come from outside the line. Axes: G generations of the line, N genes
(84 for three inter-neurons).
"""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray

from arm2d.records import alike, brief
from evolution.runs.folder import AnyRun, RunFolder
from evolution.runs.history import History
from evolution.runs.recorded import recorded_history
from evolution.runs.replay import ContradictionError, replay
from evolution.search.algorithm import rank as ranking
from evolution.search.population import first_population


@dataclass(frozen=True)
class Lineage:
    """An agent and its ancestors, one in each generation; the agent itself comes last.

    Attributes:
        generations: [G], 0 to the agent's.
        indices: [G], where the ancestor stands in its generation.
        genotypes: [G, N], bit by bit those that the run bred.
        fitness: [G], what the ancestor scored in the 28 trials of its generation.
        changed: [G], whether its genes are other than its parent's; True in generation 0.
    """

    generations: NDArray[np.int64]
    indices: NDArray[np.int64]
    genotypes: NDArray[np.float64]
    fitness: NDArray[np.float64]
    changed: NDArray[np.bool_]

    __repr__ = brief
    __eq__ = alike

    def __post_init__(self) -> None:
        for field in fields(self):
            getattr(self, field.name).flags.writeable = False

    def __len__(self) -> int:
        return len(self.generations)

    @property
    def distinct(self) -> NDArray[np.float64]:
        """The ancestors without the unchanged copies, [A, N]."""
        return self.genotypes[self.changed]

    @property
    def versions(self) -> NDArray[np.int64]:
        """For each generation the row of `distinct` that lived in it, [G]."""
        return np.cumsum(self.changed) - 1


def trace_lineage(run: AnyRun, generation: int | None = None, rank: int = 0) -> Lineage:
    """Rebuild the line of ancestors of an agent of a run.

    Args:
        run: The run, or the path of its folder; finished or not.
        generation: The agent's; by default the last that was scored.
        rank: 0 for the best of its generation.

    Raises:
        ValueError: If there is no such run, or it has no such generation or rank.
        DamagedFileError: If the recorded parents or genotypes are not those that the run breeds.
    """
    folder = RunFolder.open(run)
    history = recorded_history(folder)
    last = len(history) - 1 if generation is None else generation
    if not 0 <= last < len(history):
        raise ValueError(f"{folder.path} has no generation {last}; it has {len(history)}, numbered from 0")
    n_genotypes = history.fitness.shape[1]
    if not 0 <= rank < n_genotypes:
        raise ValueError(f"rank {rank} does not exist; the generation has ranks 0 to {n_genotypes - 1}")
    history = history[: last + 1]
    order = ranking(history.fitness[-1], folder.config.readings)
    if last > 0 and (history.parents[-1] < 0).all():
        raise ValueError(
            f"{folder.path} has no lines of ancestors: its algorithm, {folder.config.settings.algorithm}, "
            "draws genotypes from what it has learnt, not from parents"
        )
    indices = ancestor_indices(history.parents, int(order[rank]))
    genotypes = _breed_line(folder, history, indices)
    copied = np.all(genotypes[1:] == genotypes[:-1], axis=1)
    rows = np.arange(last + 1)
    return Lineage(rows, indices, genotypes, history.fitness[rows, indices], np.append(True, ~copied))


def ancestor_indices(parents: NDArray[np.integer], last_index: int) -> NDArray[np.int64]:
    """Where the ancestors of genotype `last_index` of the last generation stand in theirs, [G].

    Args:
        parents: [G, P], indices into the generation before.
        last_index: Index into the last generation.
    """
    indices = np.empty(len(parents), np.int64)
    indices[-1] = last_index
    for row in range(len(parents) - 1, 0, -1):
        indices[row - 1] = parents[row, indices[row]]
    return indices


def _breed_line(folder: RunFolder, history: History, indices: NDArray[np.int64]) -> NDArray[np.float64]:
    """The genotype at each index of each generation, [G, N]; every generation is held against the record."""
    genotypes = np.empty((len(indices), folder.config.settings.n_genes))
    population = first_population(folder.config)
    for row, index in enumerate(indices):
        genotypes[row] = population.genotypes[index]
        try:
            population = replay(population, history[row : row + 1], folder.config)
        except ContradictionError as error:
            span = next(part for part in folder.spans if row in part)
            raise folder.damaged(span, str(error)) from None
    return genotypes
