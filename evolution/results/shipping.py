"""Agents of an experiment that are worth keeping by name, each a small file with its provenance.

    best-generaliser   With-Indicate: the agent whose least-mastered instruction of all nine succeeds most
    best-specialist    With-Indicate: masters the experienced instructions best, never a never-met one
    with-ignore        With-Ignore: as best-generaliser

`wordarm evaluate`, `wordarm port` and `find_source` take these names.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from arm2d import Condition
from evolution.agents.postevaluation import TRIALS
from evolution.results.notable import Agent, best_agent, best_specialist
from evolution.results.records import Results
from evolution.runs.recorded import recorded_generation
from evolution.runs.storage import make_folder, write_arrays


def notable_agents(results: Results) -> dict[str, Agent]:
    """The agents to be kept, by name, as far as there are any."""
    indicate = results.conditions.get(Condition.WITH_INDICATE)
    ignore = results.conditions.get(Condition.WITH_IGNORE)
    found = {
        "best-generaliser": indicate and best_agent(indicate),
        "best-specialist": indicate and best_specialist(indicate),
        "with-ignore": ignore and best_agent(ignore),
    }
    return {name: agent for name, agent in found.items() if agent is not None}


def ship(results: Results, folder: Path) -> list[Path]:
    """Write the notable agents of an experiment; their paths."""
    make_folder(folder)
    paths = []
    for name, agent in notable_agents(results).items():
        paths.append(folder / f"{name}.npz")
        _write(agent, paths[-1])
    return paths


def _write(agent: Agent, path: Path) -> None:
    """One agent, with the config of its run and what it made of the nine instructions."""
    config = agent.run.config
    genotypes = recorded_generation(agent.run, agent.generation).best_genotypes[0]
    write_arrays(
        path,
        {
            "genotypes": genotypes[agent.rank : agent.rank + 1],
            "generations": np.array([agent.generation]),
            "ranks": np.array([agent.rank]),
            "instructions": np.array([str(each) for each in config.condition.instructions]),
            "trials_per_instruction": np.array(TRIALS),
            "successes": agent.successes[np.newaxis],
            "config": np.array(config.to_toml()),
        },
    )
