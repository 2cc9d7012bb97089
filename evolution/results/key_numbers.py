"""The key numbers of an experiment, as numbers, with the published ones where the paper gives them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from arm2d import Condition, Readings
from arm2d.records import alike, brief
from evolution.agents.subtasks import SUBTASKS, AgentClass
from evolution.results import published
from evolution.results.records import ConditionResults, Results

PLATEAU: Final = "plateau"
AT_LIMIT: Final = "runs that end at 18/7"
SOLVED: Final = "runs in which one genotype solved all trials"
WITH_FULL: Final = "runs with fully compositional agents"


@dataclass(frozen=True)
class KeyNumber:
    """One number of one condition.

    Attributes:
        name: What it is.
        published: In the paper; None where it gives none.
        ours: In the experiment; NaN if no run or no agent is there to tell.
        of: Runs or agents that `ours` is a number or share of.
        runs: [R], the same for each run, where that makes sense; else empty.
    """

    name: str
    published: float | None
    ours: float
    of: int
    runs: NDArray[np.float64]

    __repr__ = brief
    __eq__ = alike


def top_name(subtask: str) -> str:
    """Name of the share of agents in category 10 of a sub-task."""
    return f"share of agents in category 10, sub-task {subtask}"


def pass_name(kind: AgentClass, word: str) -> str:
    """Name of the share of a class that passes a transition test."""
    return f"share of {kind} agents that pass the {word} transition"


def class_name(kind: AgentClass) -> str:
    """Name of the share of agents in a class."""
    return f"share of {kind} agents"


def key_numbers(found: ConditionResults) -> list[KeyNumber]:
    """All key numbers of a condition."""
    n, indicate = len(found.runs), found.condition is Condition.WITH_INDICATE
    full = found.members[AgentClass.FULL] > 0
    with_full = float(published.RUNS_WITH_GENERALISERS) if indicate else None
    numbers = [
        KeyNumber(
            PLATEAU, published.PLATEAU, float(np.median(found.plateau)) if n else np.nan, n, found.plateau
        ),
        _count(AT_LIMIT, float(published.RUNS), found.at_plateau, n),
        _count(SOLVED, None, int((found.first_solved >= 0).sum()), n),
        _count(WITH_FULL, with_full, int(full.sum()), n),
    ]
    for column, name in enumerate(SUBTASKS):
        theirs = published.TABLE_II[found.condition][-1, column] / published.AGENTS
        numbers.append(_share(top_name(name), float(theirs), found.share_in_top(name), found.n_agents))
    for kind in AgentClass:
        numbers.append(_share(class_name(kind), None, found.share_of_class(kind), found.n_agents))
    for kind, outcome in found.transitions.items():
        for word, passed in (("action", outcome.action_passed), ("object", outcome.object_passed)):
            ours = passed / outcome.agents if outcome.agents else np.nan
            numbers.append(KeyNumber(pass_name(kind, word), None, ours, outcome.agents, np.empty(0)))
    return numbers


def by_condition(experiments: Mapping[str, Results]) -> dict[Condition, dict[str, list[KeyNumber]]]:
    """Key numbers by condition and experiment; conditions that no experiment has are left out."""
    found: dict[Condition, dict[str, list[KeyNumber]]] = {}
    for condition in Condition:
        own = {
            name: key_numbers(results.conditions[condition])
            for name, results in experiments.items()
            if condition in results.conditions
        }
        if own:
            found[condition] = own
    return found


def departures(readings: Readings) -> str:
    """The readings that are not the default ones, in words."""
    default, values = Readings().to_mapping(), readings.to_mapping()
    other = [f"{name.replace('_', ' ')} {values[name]}" for name in values if values[name] != default[name]]
    return "; ".join(other) or "default readings"


def _count(name: str, theirs: float | None, ours: int, n: int) -> KeyNumber:
    return KeyNumber(name, theirs, float(ours) if n else np.nan, n, np.empty(0))


def _share(name: str, theirs: float | None, runs: NDArray[np.float64], n_agents: int) -> KeyNumber:
    return KeyNumber(name, theirs, float(runs.mean()) if len(runs) else np.nan, n_agents, runs)
