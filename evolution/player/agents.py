"""What the page is told of an agent: plain values, genes as the shortest decimals that keep their bits."""

from __future__ import annotations

from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from arm2d.constants import N_GENES
from arm2d.network.genes import SIZES, counted
from arm2d.tasks.task import papers_condition
from evolution.runs.sources import Agent
from evolution.search.evaluation import evaluate

# How the shipped agents are introduced; any other by where it comes from.
INTRODUCTIONS: Final = {
    "best-generaliser": (
        "The generaliser",
        "Practised seven instructions. It carries out the two others as surely, though nothing asked for it.",
    ),
    "best-specialist": (
        "The specialist",
        "Carries out what it practised almost without fail, and the two other instructions never.",
    ),
    "with-ignore": (
        "The one told to ignore",
        "Its third action is IGNORE, not INDICATE. It does all nine too, two of them never practised.",
    ),
}


def agent_for_page(source: Agent) -> dict[str, Any]:
    """An agent with its introduction, tested as `wordarm evaluate` does."""
    name, note = INTRODUCTIONS.get(source.name, (source.name.replace("-", " ").capitalize(), source.origin))
    condition = papers_condition(source.condition, "the page to play with")
    tested = evaluate(source.genotype, condition, source.readings)
    return described(source, name, note, tested.successes[0].sum(axis=-1).tolist())


def is_playable(genotype: NDArray[np.float64]) -> bool:
    """Whether the page can run a genotype [G]: it knows networks of three inter-neurons."""
    return len(genotype) == N_GENES


def described(source: Agent, name: str, note: str, successes: list[int]) -> dict[str, Any]:
    """An agent under a name, with a note, and how many of 80 tries of each instruction it carried out.

    Raises:
        ValueError: If its network has another size than three.
    """
    if not is_playable(source.genotype):
        found = counted(SIZES[len(source.genotype)])
        raise ValueError(f"{source.origin} has {found}; the page to play with runs networks of three")
    return {
        "name": name,
        "note": note,
        "condition": str(source.condition),
        "readings": source.readings.to_mapping(),
        "genotype": source.genotype.tolist(),
        "successes": successes,
    }
