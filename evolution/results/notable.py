"""Single agents of an experiment that are worth looking at, and keeping by name as small files.

    best-generaliser   With-Indicate: the agent whose least-mastered instruction of all nine succeeds most
    best-specialist    With-Indicate: masters the experienced instructions best, never a never-met one
    with-ignore        With-Ignore: as best-generaliser

They are the nearest that there is: whether one is what its name says, `described` tells.

`wordarm evaluate`, `wordarm port` and `find_agent` take these names, and `find_agent` takes the records.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from arm2d import NON_EXPERIENCED, Condition
from arm2d.records import alike, brief
from evolution.agents.postevaluation import N_INSTRUCTIONS, TRIALS
from evolution.agents.subtasks import usually
from evolution.results.records import ConditionResults, Results
from evolution.runs.folder import RunFolder
from evolution.runs.recorded import recorded_generation
from evolution.runs.storage import make_folder, write_arrays


@dataclass(frozen=True)
class NotableAgent:
    """One agent of an experiment, and what it made of nine instructions; `find_agent` gives it in hand.

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
    __eq__ = alike


def best_agent(of_condition: ConditionResults) -> NotableAgent | None:
    """The agent whose least-mastered instruction of all nine succeeds most; then the most successes.

    Args:
        of_condition: The results of one condition, such as `analyse(...).conditions["with-indicate"]`.

    Returns:
        The agent, which `find_agent` takes; None if there is none.

    Raises:
        ValueError: If these are results of another kind.
    """
    _check_kind(of_condition)
    return _first_by(of_condition, of_condition.successes.min(axis=-1), of_condition.successes.sum(axis=-1))


def best_specialist(of_condition: ConditionResults) -> NotableAgent | None:
    """The agent that masters the experienced instructions best and never a never-met one; as `best_agent`."""
    _check_kind(of_condition)
    order = [of_condition.condition.instructions.index(word) for word in NON_EXPERIENCED]
    known = [i for i in range(N_INSTRUCTIONS) if i not in order]
    untouched = (of_condition.successes[..., order] == 0).all(axis=-1)
    skills = of_condition.successes[..., known]
    return _first_by(of_condition, untouched, skills.min(axis=-1), skills.sum(axis=-1))


def notable_agents(results: Results) -> dict[str, NotableAgent]:
    """The agents to be kept, by name, as far as there are any."""
    indicate = results.conditions.get(Condition.WITH_INDICATE)
    ignore = results.conditions.get(Condition.WITH_IGNORE)
    found = {
        "best-generaliser": indicate and best_agent(indicate),
        "best-specialist": indicate and best_specialist(indicate),
        "with-ignore": ignore and best_agent(ignore),
    }
    return {name: agent for name, agent in found.items() if agent is not None}


def described(agent: NotableAgent) -> str:
    """How many instructions an agent carries out, met and never met, by the limit of the classes."""
    condition, good = agent.run.config.papers_condition, usually(agent.successes)
    met, never_met = (
        f"{sum(bool(good[condition.instructions.index(word)]) for word in words)} of {len(words)}"
        for words in (condition.experienced, condition.held_out)
    )
    return f"carries out {met} instructions it met and {never_met} it never met"


def ship(agents: Mapping[str, NotableAgent], folder: Path) -> list[Path]:
    """Write agents to files named after them; their paths."""
    make_folder(folder)
    paths = []
    for name, agent in agents.items():
        paths.append(folder / f"{name}.npz")
        _write(agent, paths[-1])
    return paths


def _check_kind(of_condition: object) -> None:
    """Refuse anything but the results of one condition, such as those of a whole experiment."""
    if not isinstance(of_condition, ConditionResults):
        kind = type(of_condition).__name__
        raise ValueError(
            f'the results of one condition are needed, such as conditions["with-ignore"], not {kind}'
        )


def _first_by(results: ConditionResults, *keys: NDArray) -> NotableAgent | None:
    """The agent with the largest keys, the first counting most; the earliest of equals."""
    if not results.successes.size:
        return None
    index = np.lexsort([-key.reshape(-1).astype(np.int64) for key in reversed(keys)])[0]
    run, late, rank = np.unravel_index(index, results.successes.shape[:3])
    successes = results.successes[run, late, rank]
    return NotableAgent(results.runs[run], int(results.generations[late]), int(rank), successes)


def _write(agent: NotableAgent, path: Path) -> None:
    """One agent, with the config of its run and what it made of the nine instructions."""
    config = agent.run.config
    genotypes = recorded_generation(agent.run, agent.generation).best_genotypes[0]
    write_arrays(
        path,
        {
            "genotypes": genotypes[agent.rank : agent.rank + 1],
            "generations": np.array([agent.generation]),
            "ranks": np.array([agent.rank]),
            "instructions": np.array([str(word) for word in config.condition.instructions]),
            "trials_per_instruction": np.array(TRIALS),
            "successes": agent.successes[np.newaxis],
            "config": np.array(config.to_toml()),
        },
    )
