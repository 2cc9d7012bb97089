"""The result of an experiment in three sentences, whatever it is."""

from __future__ import annotations

from arm2d import NON_EXPERIENCED, Condition
from evolution import published
from evolution.analysis import ConditionResults, Results
from evolution.postevaluation import TRIALS
from evolution.report_tables import TITLES, of, p_value, percent, runs_with_generalisers
from evolution.subtasks import AgentClass

# A difference whose p-value is smaller is called one.
LEVEL = 0.05
COMPARED = f"{AgentClass.FULL} agents"


def result_sentences(results: Results) -> list[str]:
    """How far evolution came, who generalises, and whether the conditions differ."""
    shown = {c: each for c, each in results.conditions.items() if len(each.runs)}
    if not shown:
        return ["No run is finished and tested yet, so there is no result."]
    return [_evolution(shown), _generalisation(shown), _difference(results, shown)]


def standing_of_best(each: ConditionResults) -> str:
    """What the best agent of a condition is called, for its heading."""
    return (
        "best generaliser" if each.members[AgentClass.FULL].any() else "agent that comes nearest to all nine"
    )


def _evolution(shown: dict[Condition, ConditionResults]) -> str:
    counts = _and(f"{of(each.at_plateau, len(each.runs))} {TITLES[c]} runs" for c, each in shown.items())
    return (
        f"{counts} end at the largest fitness, 18/7 = {published.LARGEST_FITNESS:.3f}; in the paper all do."
    )


def _generalisation(shown: dict[Condition, ConditionResults]) -> str:
    """Runs with fully compositional agents, and what the best of each condition makes of the two."""
    found = {c: runs_with_generalisers(each) for c, each in shown.items()}
    best = "; ".join(_best(c, each) for c, each in shown.items())
    paper = f"in the paper in {of(published.RUNS_WITH_GENERALISERS, published.RUNS)} With-Indicate runs"
    if not any(found.values()):
        return (
            "No agent is fully compositional, that is above 75 % on the seven experienced instructions and "
            f"on both it never met ({paper} there are some): {best}."
        )
    counts = _and(f"{of(n, len(shown[c].runs))} {TITLES[c]} runs" for c, n in found.items())
    return f"Fully compositional agents arise in {counts} ({paper}): {best}."


def _best(condition: Condition, each: ConditionResults) -> str:
    agent = each.best_agent()
    if agent is None:
        return f"{TITLES[condition]} has no agent"
    order = condition.instructions
    done = _and(
        f"{instruction} in {agent.successes[order.index(instruction)]}" for instruction in NON_EXPERIENCED
    )
    known = min(int(agent.successes[order.index(e)]) for e in condition.experienced)
    return (
        f"the {TITLES[condition]} agent nearest to it carries out {done} of {TRIALS} trials, "
        f"and no experienced instruction in fewer than {known}"
    )


def _difference(results: Results, shown: dict[Condition, ConditionResults]) -> str:
    if COMPARED not in results.comparisons:
        (only,) = shown
        return f"Only {TITLES[only]} runs can be analysed, so the conditions are not compared."
    comparison = results.comparisons[COMPARED]
    means = " and ".join(percent(mean) for mean in comparison.means)
    smallest = min((each.mann_whitney_p, name) for name, each in results.comparisons.items())
    text = (
        f"Fully compositional are {means} of the With-Indicate and With-Ignore agents "
        f"(Mann-Whitney test on runs, p = {p_value(comparison.mann_whitney_p)}"
    )
    if smallest[0] >= LEVEL:
        return f"{text}), and nothing else we compare differs between the conditions either (p at least " + (
            f"{p_value(smallest[0])}), unlike in the paper."
        )
    return f"{text}); the smallest p of all comparisons, {p_value(smallest[0])}, is that of {smallest[1]}."


def _and(parts) -> str:
    """Such as "a, b and c"."""
    *first, last = parts
    return f"{', '.join(first)} and {last}" if first else last
