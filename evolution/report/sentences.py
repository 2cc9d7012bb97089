"""The result of an experiment in three sentences, whatever it is, and where its size is not the paper's."""

from __future__ import annotations

from collections.abc import Iterable

from arm2d import Condition
from arm2d.constants import N_INTER
from arm2d.network.genes import counted
from evolution.agents.subtasks import AgentClass
from evolution.report.tables import runs_with_generalisers
from evolution.results import published
from evolution.results.records import ConditionResults, Results
from evolution.results.wording import TITLES, of, p_value, percent
from evolution.search.settings import GENETIC, LARGEST_FITNESS, Settings

# A difference whose p-value is smaller is called one.
LEVEL = 0.05
COMPARED = f"{AgentClass.FULL} agents"


def result_sentences(results: Results) -> list[str]:
    """How far evolution came, who generalises, and whether the conditions differ."""
    shown = {c: found for c, found in results.conditions.items() if len(found.runs)}
    if not shown:
        return ["No run is finished and tested yet, so there is no result."]
    return [_evolution(shown), _generalisation(shown), _difference(results, shown)]


def standing_of_best(found: ConditionResults) -> str:
    """What the best agent of a condition is called, for its heading."""
    return (
        "best generaliser" if found.members[AgentClass.FULL].any() else "agent that comes nearest to all nine"
    )


def departures_in_size(results: Results) -> list[str]:
    """Where an experiment is smaller or larger than the paper's, so that numbers cannot be compared."""
    sentences = []
    settings = dict.fromkeys(run.config.settings for run in results.experiment.all_runs)
    paper = Settings().to_mapping()
    for own in settings:
        sentences += [
            f"{name.replace('_', ' ')} {value:,}, not {paper[name]:,}"
            for name, value in own.to_mapping().items()
            if name in paper and value != paper[name]
        ]
        if own.inter_neurons != N_INTER:
            sentences.append(f"networks of {counted(own.inter_neurons)}, not three")
        if own.algorithm != GENETIC:
            sentences.append(f"searched for by {own.algorithm}, not by the paper's genetic algorithm")
    for condition, found in results.conditions.items():
        n = len(found.runs)
        if n != published.RUNS:
            sentences.append(f"{n} {TITLES[condition]} run{'s' if n != 1 else ''}, not {published.RUNS}")
    return sentences


def _evolution(shown: dict[Condition, ConditionResults]) -> str:
    counts = _and(f"{of(own.at_plateau, len(own.runs))} {TITLES[c]} runs" for c, own in shown.items())
    return f"{counts} end at the largest fitness, 18/7 = {LARGEST_FITNESS:.3f}; in the paper all do."


def _generalisation(shown: dict[Condition, ConditionResults]) -> str:
    """Runs with fully compositional agents; what the best of them make of every instruction is in a map."""
    found = {c: runs_with_generalisers(own) for c, own in shown.items()}
    paper = f"in the paper in {of(published.RUNS_WITH_GENERALISERS, published.RUNS)} With-Indicate runs"
    if not any(found.values()):
        return (
            "No agent is fully compositional, that is above 75 % on the seven experienced instructions and "
            f"on both it never met ({paper} some are)."
        )
    counts = _and(f"{of(n, len(shown[c].runs))} {TITLES[c]} runs" for c, n in found.items())
    return f"Fully compositional agents, above 75 % on all nine instructions, arise in {counts} ({paper})."


def _difference(results: Results, shown: dict[Condition, ConditionResults]) -> str:
    """Whether any comparison of the conditions tells them apart, runs being the unit."""
    if COMPARED not in results.comparisons:
        (only,) = shown
        return f"Only {TITLES[only]} runs can be analysed, so the conditions are not compared."
    p, name = min((comparison.mann_whitney_p, name) for name, comparison in results.comparisons.items())
    full = f"Fully compositional are {_shares(results, COMPARED)}"
    if p >= LEVEL:
        return (
            f"No difference between the conditions can be claimed (smallest p of all comparisons, runs being "
            f"the unit: {p_value(p)}), while the paper claims one. {full}."
        )
    told = (
        f"The conditions differ most in {name}: {_shares(results, name)} (p = {p_value(p)}, runs being the "
        f"unit, smallest of {len(results.comparisons)} comparisons)."
    )
    own = p_value(results.comparisons[COMPARED].mann_whitney_p)
    return told if name == COMPARED else f"{told} {full} (p = {own})."


def _shares(results: Results, name: str) -> str:
    """What is compared, in both conditions."""
    first, second = (percent(mean) for mean in results.comparisons[name].means)
    return f"{first} of the With-Indicate agents and {second} of the With-Ignore agents"


def _and(parts: Iterable[str]) -> str:
    """Such as "a, b and c"."""
    *first, last = parts
    return f"{', '.join(first)} and {last}" if first else last
