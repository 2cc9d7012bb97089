"""Fully compositional agents over time: where they stand among the five best, and how long they last.

Agents are post-evaluated anew in every generation, so one genotype may count as fully compositional in
one generation and not in the next. Three measures of duration are kept apart:

    spell     generations in a row in which the run holds at least one fully compositional agent
    stay      generations in which one genotype is among the five best (an elite is copied unchanged)
    line      generations in a row through which the property goes from parent to child

Axes: L late generations, 5 ranks, N fully compositional agents, D distinct genotypes of them.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from arm2d.records import alike, brief
from evolution.agents.parts import late_history
from evolution.results.statistics import sign_flip_test
from evolution.runs.folder import AnyRun, RunFolder
from evolution.search.algorithm import rank as ranking
from evolution.search.settings import N_BEST

# Mean rank of an agent drawn at random from the five best, 0 for the best.
CHANCE_RANK: Final = (N_BEST - 1) / 2


@dataclass(frozen=True)
class Generalisers:
    """The fully compositional agents of one run.

    Attributes:
        counts: [L], how many of the five best.
        generations: [N] and
        ranks: [N], which agents; rank 0 is the generation's best.
        spells: Lengths of the spells, in order.
        first: [D], generation in which each genotype was first among the five best,
        stays: [D], its stay,
        verdicts: [D], in how many generations of its stay it was found fully compositional.
        longest_line: Length of the longest line.
    """

    counts: NDArray[np.int64]
    generations: NDArray[np.int64]
    ranks: NDArray[np.int64]
    spells: NDArray[np.int64]
    first: NDArray[np.int64]
    stays: NDArray[np.int64]
    verdicts: NDArray[np.int64]
    longest_line: int

    __repr__ = brief
    __eq__ = alike

    def __len__(self) -> int:
        return len(self.ranks)

    @property
    def by_rank(self) -> NDArray[np.int64]:
        """How many at each rank, [5]."""
        return np.bincount(self.ranks, minlength=N_BEST)


def generalisers_of(
    run: AnyRun, generations: NDArray[np.integer], members: NDArray[np.bool_]
) -> Generalisers:
    """The fully compositional agents of a run.

    Args:
        run: The run, or the path of its folder; its parts are read only if there are such agents.
        generations: [L], the late generations.
        members: [L, 5], which agents are fully compositional.

    Raises:
        ValueError: If there is no such run.
        DamagedFileError: If a part of the run is damaged.
    """
    run = RunFolder.open(run)
    rows, ranks = np.nonzero(members)
    counts = members.sum(axis=1)
    first = stays = verdicts = np.empty(0, np.int64)
    longest = 0
    if len(rows):
        history = late_history(run)
        first, stays, verdicts = _stays(history.best_genotypes, members)
        indices = np.stack([ranking(fitness, run.config.readings)[:N_BEST] for fitness in history.fitness])
        longest = longest_line(indices, history.parents, members)
    return Generalisers(
        counts=counts,
        generations=generations[rows].astype(np.int64),
        ranks=ranks,
        spells=spell_lengths(counts > 0),
        first=generations[first].astype(np.int64),
        stays=stays,
        verdicts=verdicts,
        longest_line=longest,
    )


def spell_lengths(held: NDArray[np.bool_]) -> NDArray[np.int64]:
    """Lengths of the stretches of True, in order."""
    bounds = np.flatnonzero(np.diff(np.concatenate([[False], held, [False]])))
    return bounds[1::2] - bounds[::2]


def longest_line(
    indices: NDArray[np.integer], parents: NDArray[np.integer], members: NDArray[np.bool_]
) -> int:
    """The most generations in a row through which an unbroken line of parent and child consists of members.

    Args:
        indices: [L, 5], where the five best stand in their generations.
        parents: [L, P], indices into the generation before.
        members: [L, 5], who counts.
    """
    lengths: dict[int, int] = {}  # of the lines that end in the generation before, by index
    longest = 0
    for row, who in enumerate(members):
        own = indices[row, who]
        lengths = {int(index): 1 + lengths.get(int(parents[row, index]), 0) for index in own}
        longest = max([longest, *lengths.values()])
    return longest


def mean_rank_against_chance(runs: Sequence[Generalisers]) -> tuple[float, float]:
    """(mean over runs of their agents' mean rank, two-sided p against chance); NaN without such an agent.

    The run is the unit: within one, agents are relatives. Chance is `CHANCE_RANK`; an exact sign-flip test
    over runs cannot reach 0.05 with fewer than six runs.
    """
    means = np.array([run.ranks.mean() for run in runs if len(run)])
    if not len(means):
        return float("nan"), float("nan")
    return float(means.mean()), sign_flip_test(means - CHANCE_RANK)


def _stays(
    genotypes: NDArray[np.float64], members: NDArray[np.bool_]
) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.int64]]:
    """First row, stay and verdicts of each genotype that was ever a member, each [D], by first row.

    Args:
        genotypes: [L, 5, G].
        members: [L, 5].
    """
    flat = genotypes.reshape(-1, genotypes.shape[-1])
    _, versions = np.unique(flat, axis=0, return_inverse=True)
    versions = versions.reshape(members.shape)
    found = np.unique(versions[members])
    present = (versions[np.newaxis] == found[:, np.newaxis, np.newaxis]).any(axis=2)  # [D, L]
    verdicts = ((versions[np.newaxis] == found[:, np.newaxis, np.newaxis]) & members).sum(axis=(1, 2))
    first, stays = present.argmax(axis=1), present.sum(axis=1)
    order = np.lexsort([found, first])
    return first[order], stays[order], verdicts[order]
