"""The two conditions compared: what is compared, with the run as the unit, and in the paper's way."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from arm2d import Condition
from evolution.agents.postevaluation import N_INSTRUCTIONS
from evolution.agents.subtasks import SUBTASKS, AgentClass, categories, classify
from evolution.results.records import ConditionResults
from evolution.results.statistics import Comparison, compare, wilcoxon_as_published
from evolution.search.randomness import Purpose, generator


def compare_conditions(
    conditions: Mapping[Condition, ConditionResults],
) -> tuple[dict[str, Comparison], dict[str, tuple[float, float]]]:
    """Sound comparisons, and (statistic, p) of the paper's kind of test, by what is compared.

    Both are empty unless there are runs of both conditions.
    """
    comparisons: dict[str, Comparison] = {}
    published: dict[str, tuple[float, float]] = {}
    if all(len(found.runs) for found in conditions.values()) and len(conditions) == len(Condition):
        rng = generator(0, Purpose.STATISTICS)
        for name, (first, second) in _compared(conditions).items():
            comparisons[name] = compare(first, second, rng)
            published[name] = wilcoxon_as_published(*_per_generation(conditions, name))
    return comparisons, published


def _compared(conditions: Mapping[Condition, ConditionResults]) -> dict[str, list[NDArray[np.float64]]]:
    """One number per run, by what is compared; With-Indicate first."""
    ordered = [conditions[condition] for condition in Condition]
    shares = {
        f"sub-task {name}, category 10": [results.share_in_top(name) for results in ordered]
        for name in SUBTASKS
    }
    classes = {f"{kind} agents": [results.share_of_class(kind) for results in ordered] for kind in AgentClass}
    return {**shares, **classes}


def _per_generation(
    conditions: Mapping[Condition, ConditionResults], name: str
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """What the paper's kind of test takes: the same share, but of each late generation of all runs."""

    def shares(results: ConditionResults) -> NDArray[np.float64]:
        agents = results.successes.swapaxes(0, 1).reshape(len(results.generations), -1, N_INSTRUCTIONS)
        return np.array([_share(generation, name, results.condition) for generation in agents])

    return shares(conditions[Condition.WITH_INDICATE]), shares(conditions[Condition.WITH_IGNORE])


def _share(successes: NDArray[np.int16], name: str, condition: Condition) -> float:
    """Share of agents [A, 9] that count for one of the names of `_compared`."""
    for index, subtask in enumerate(SUBTASKS):
        if name == f"sub-task {subtask}, category 10":
            return float((categories(successes, condition)[:, index] == 10).mean())
    kind = next(kind for kind in AgentClass if name == f"{kind} agents")
    return float(classify(successes, condition)[kind].mean())
