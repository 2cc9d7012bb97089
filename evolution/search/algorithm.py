"""One generation to the next: rank, keep the elites, choose parents, cross, mutate (section V).

Pure functions on arrays; each draw comes from a generator passed in. Axes: P genotypes of a
generation, C children, G genes (84 for three inter-neurons). Sums are taken one term after the other, so
that no bit depends on the machine.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from arm2d import Readings
from evolution.search.randomness import draw_gaussian
from evolution.search.settings import Settings


class Crossings(NamedTuple):
    """Which genes of each child come from a second parent.

    Attributes:
        second_parents: [C], indices into the generation before.
        cuts: [C], the first gene that is the second parent's; G in a child of one parent.
    """

    second_parents: NDArray[np.int64]
    cuts: NDArray[np.int64]


def initial_genotypes(settings: Settings, rng: np.random.Generator) -> NDArray[np.float64]:
    """Generation 0: genes uniform in [0, 1), [P, G]."""
    return rng.random((settings.population, settings.n_genes))


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

    The parent of an elite is itself. A child's is drawn among the best `settings.parents`, with
    probability proportional to what the reading `parent_scaling` makes of their fitness.
    """
    elites = rank(fitness, readings)[: settings.elites]
    draws = rng.random(settings.population - settings.elites)  # [C]
    return np.concatenate([elites, _drawn_parents(draws, fitness, settings, readings)])


def choose_crossings(
    fitness: NDArray[np.float64], settings: Settings, readings: Readings, rng: np.random.Generator
) -> Crossings:
    """Second parents, chosen as the first ones are, and where their genes begin: 1 to G - 1, if at all.

    Numbers are drawn for every child, crossed or not, so that none depends on its siblings.
    """
    chances, draws, places = rng.random((3, settings.population - settings.elites))
    cuts = 1 + (places * (settings.n_genes - 1)).astype(np.int64)
    cuts[chances >= readings.crossover] = settings.n_genes
    return Crossings(_drawn_parents(draws, fitness, settings, readings), cuts)


def breed(
    genotypes: NDArray[np.float64],
    parents: NDArray[np.integer],
    settings: Settings,
    readings: Readings,
    rng: np.random.Generator,
    crossings: Crossings | None = None,
) -> NDArray[np.float64]:
    """The next generation [P, G]: the elites unchanged, then the children.

    A child is a mutated copy of its parent, or of the parent's genes up to a cut and a second one's after it.
    """
    offspring = genotypes[parents]
    children = offspring[settings.elites :]
    if crossings is not None:
        after = np.arange(children.shape[1]) >= crossings.cuts[:, np.newaxis]  # [C, G]
        children[:] = np.where(after, genotypes[crossings.second_parents], children)
    children[:] = mutate(children, readings.mutation_probability, readings.mutation_sd, rng)
    return offspring


def mutate(
    genotypes: NDArray[np.float64], probability: float, sd: float, rng: np.random.Generator
) -> NDArray[np.float64]:
    """Copies in which some genes are moved; results are clipped to [0, 1].

    Args:
        genotypes: [C, G].
        probability: Of each gene, independently, to be moved.
        sd: Standard deviation of the Gaussian offset.
        rng: Draws first which genes are moved, then by how much, gene after gene.
    """
    mutated = genotypes.copy()
    moved = rng.random(genotypes.shape) < probability
    offsets = sd * draw_gaussian(int(np.count_nonzero(moved)), rng)
    mutated[moved] = np.clip(mutated[moved] + offsets, 0.0, 1.0)
    return mutated


def _drawn_parents(
    draws: NDArray[np.float64], fitness: NDArray[np.float64], settings: Settings, readings: Readings
) -> NDArray[np.int64]:
    """The candidates that numbers in [0, 1) fall to, each with the share of its weight."""
    order = rank(fitness, readings)
    candidates = order[: settings.parents]
    bounds = np.add.accumulate(_weights(fitness[order], settings.parents, readings))
    return candidates[np.searchsorted(bounds, draws * bounds[-1], side="right")]


def _weights(fitness: NDArray[np.float64], n_candidates: int, readings: Readings) -> NDArray[np.float64]:
    """What the chances of the candidates are proportional to; `fitness` [P] falls. Uniform if all are 0."""
    weights = candidates = fitness[:n_candidates]
    if readings.parent_scaling == "cubed":
        weights = candidates * candidates * candidates
    elif readings.parent_scaling == "excess":
        # Where all are candidates, nobody is left to exceed, and the fitness itself counts.
        weights = candidates - fitness[n_candidates : n_candidates + 1].max(initial=0.0)
    elif readings.parent_scaling == "rank":
        weights = 2.0 * np.arange(n_candidates - 1, -1, -1) / max(n_candidates - 1, 1)
    # Below the smallest normal number, products round to zero or up to the sum itself.
    return weights if weights.sum() >= np.finfo(np.float64).tiny else np.ones_like(weights)
