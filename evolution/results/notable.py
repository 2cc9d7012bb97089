"""Single agents of an experiment that are worth looking at."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from arm2d import NON_EXPERIENCED
from arm2d.records import brief
from evolution.agents.postevaluation import N_INSTRUCTIONS
from evolution.results.records import ConditionResults
from evolution.runs.folder import RunFolder


@dataclass(frozen=True)
class Agent:
    """One agent of an experiment, and what it made of nine instructions.

    Attributes:
        run: The run's folder.
        generation: The generation,
        rank: the place in it, 0 for the best.
        successes: [9], of 80 trials each.
    """

    run: RunFolder
    generation: int
    rank: int
    successes: NDArray[np.int16]

    __repr__ = brief


def best_agent(results: ConditionResults) -> Agent | None:
    """The agent whose least-mastered instruction of all nine succeeds most; then the most successes."""
    return _first_by(results, results.successes.min(axis=-1), results.successes.sum(axis=-1))


def best_specialist(results: ConditionResults) -> Agent | None:
    """The agent that masters the experienced instructions best and never a never-met one."""
    order = [results.condition.instructions.index(each) for each in NON_EXPERIENCED]
    known = [i for i in range(N_INSTRUCTIONS) if i not in order]
    untouched = (results.successes[..., order] == 0).all(axis=-1)
    skills = results.successes[..., known]
    return _first_by(results, untouched, skills.min(axis=-1), skills.sum(axis=-1))


def _first_by(results: ConditionResults, *keys: NDArray) -> Agent | None:
    """The agent with the largest keys, the first counting most; the earliest of equals."""
    if not results.successes.size:
        return None
    index = np.lexsort([-key.reshape(-1).astype(np.int64) for key in reversed(keys)])[0]
    run, late, rank = np.unravel_index(index, results.successes.shape[:3])
    successes = results.successes[run, late, rank]
    return Agent(results.runs[run], int(results.generations[late]), int(rank), successes)
