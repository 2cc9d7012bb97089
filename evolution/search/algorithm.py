"""One generation to the next: rank, keep the elites, choose parents, mutate (section V).

Pure functions on arrays; each draw comes from a generator passed in. Axes: P genotypes of a
generation, C children, 84 genes. Sums are taken one term after the other, so that no bit depends on
the machine.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from arm2d import Readings
from arm2d.constants import N_GENES
from evolution.search.gaussian import draw_gaussian
from evolution.search.settings import Settings


def initial_genotypes(settings: Settings, rng: np.random.Generator) -> NDArray[np.float64]:
    """Generation 0: genes uniform in [0, 1), [P, 84]."""
    return rng.random((settings.population, N_GENES))


def rank(fitness: NDArray[np.float64], readings: Readings) -> NDArray[np.int64]:
    """Indices from the best to the worst, [P].

    Equals stand in the order of their indices, elites first, or in the opposite one (reading `ties`).
    """
    if readings.ties == "elders":
        return np.argsort(-fitness, kind="stable")
    return len(fitness) - 1 - np.argsort(-fitness[::-1], kind="stable")


def mean_in_order(values: NDArray[np.float64]) -> NDArray[np.float64]:
    """Mean over the last axis, summed from first to last."""
    return np.add.accumulate(values, axis=-1)[..., -1] / values.shape[-1]


def choose_parents(
    fitness: NDArray[np.float64], settings: Settings, readings: Readings, rng: np.random.Generator
) -> NDArray[np.int64]:
    """Whom each genotype of the next generation descends from, [P]: first the elites, then the children.

    The parent of an elite is itself. A child's is drawn with probability proportional to fitness, or
    to its cube, among the best `settings.parents`; uniformly if none of them scored at all.
    """
    order = rank(fitness, readings)
    candidates = order[: settings.parents]
    bounds = np.add.accumulate(_weights(fitness[candidates], readings))
    draws = rng.random(settings.population - settings.elites) * bounds[-1]  # [C]
    children = candidates[np.searchsorted(bounds, draws, side="right")]
    return np.concatenate([order[: settings.elites], children])


def breed(
    genotypes: NDArray[np.float64],
    parents: NDArray[np.integer],
    settings: Settings,
    readings: Readings,
    rng: np.random.Generator,
) -> NDArray[np.float64]:
    """The next generation [P, 84]: the elites unchanged, then a mutated copy of each other parent."""
    offspring = genotypes[parents]
    children = offspring[settings.elites :]
    children[:] = mutate(children, readings.mutation_probability, readings.mutation_sd, rng)
    return offspring


def mutate(
    genotypes: NDArray[np.float64], probability: float, sd: float, rng: np.random.Generator
) -> NDArray[np.float64]:
    """Copies in which some genes are moved; results are clipped to [0, 1].

    Args:
        genotypes: [C, 84].
        probability: Of each gene, independently, to be moved.
        sd: Standard deviation of the Gaussian offset.
        rng: Draws first which genes are moved, then by how much, gene after gene.
    """
    mutated = genotypes.copy()
    moved = rng.random(genotypes.shape) < probability
    offsets = sd * draw_gaussian(int(np.count_nonzero(moved)), rng)
    mutated[moved] = np.clip(mutated[moved] + offsets, 0.0, 1.0)
    return mutated


def _weights(fitness: NDArray[np.float64], readings: Readings) -> NDArray[np.float64]:
    """What the chances of becoming a parent are proportional to."""
    weights = fitness * fitness * fitness if readings.parent_scaling == "cubed" else fitness
    # Below the smallest normal number, products round to zero or up to the sum itself.
    return weights if weights.sum() >= np.finfo(np.float64).tiny else np.ones_like(weights)
