"""The skills of a line of ancestors in the order of their coming, and as arrays for a file."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from evolution.agents.firsts import NEVER
from evolution.agents.lineage import Lineage
from evolution.agents.lineage_scores import LineageScores


@dataclass(frozen=True)
class Innovation:
    """When one skill came.

    Attributes:
        skill: Its name.
        first: Generation in which it first came, or -1.
        for_good: Generation in which it came for good, or -1.
        agent: Share of trials in which the agent at the end of the line has it.
    """

    skill: str
    first: int
    for_good: int
    agent: float


def innovations(scores: LineageScores) -> list[Innovation]:
    """All skills of a line in the order in which they first came; those that never did come last."""
    instructions = scores.condition.instructions
    actions = [word.action.name for word in instructions[::3]]
    kinds = (
        (scores.success, [str(word) for word in instructions]),
        (scores.reached_bent, [f"on target, S2 bent, hearing {name}" for name in actions]),
        (scores.held_bent, [f"on target for 1 s, S2 bent, hearing {name}" for name in actions]),
    )
    found = [
        Innovation(name, int(first), int(for_good), float(agent))
        for skills, names in kinds
        for name, first, for_good, agent in zip(
            names, skills.first, skills.for_good, skills.shares[-1], strict=True
        )
    ]
    return sorted(found, key=lambda innovation: (innovation.first == NEVER, innovation.first))


def lineage_arrays(lineage: Lineage, scores: LineageScores, origin: str) -> dict[str, NDArray]:
    """A line and its scores as arrays by name, ready for an .npz."""
    arrays = {
        "origin": np.array(origin),
        "instructions": np.array([str(word) for word in scores.condition.instructions]),
        "per_area": np.array(scores.per_area),
        "trial_seed": np.array(scores.trial_seed),
        **{name: getattr(lineage, name) for name in ("generations", "indices", "fitness", "changed")},
        "distinct_genotypes": lineage.distinct,
    }
    for kind in ("success", "reached_bent", "held_bent"):
        arrays.update({f"{kind}_{name}": array for name, array in vars(getattr(scores, kind)).items()})
    return arrays
