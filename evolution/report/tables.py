"""The tables of the report: the paper's numbers beside ours, Table II, runs, tests between conditions.

The main table has everything the paper gives a number or a word for.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from types import MappingProxyType
from typing import Final

import numpy as np

from arm2d import Condition
from evolution.agents.subtasks import N_CATEGORIES, SUBTASKS, AgentClass
from evolution.figures.classes import SHORT
from evolution.report.columns import PlainTable
from evolution.report.rows import BothTests, both_tests
from evolution.results import published
from evolution.results.records import AnalysedRun, ConditionResults, Results
from evolution.results.statistics import Comparison
from evolution.results.wording import (
    NOT_GIVEN,
    TITLES,
    Line,
    longest_spell,
    of,
    p_value,
    percent,
    points,
    rank_of_generalisers,
)

SUBTASK_WORDS: Final = MappingProxyType(
    {
        "I": "the seven experienced instructions",
        "II": "these and MOVE Blue",
        "III": "these and TOUCH Green",
        "IV": "all nine",
    }
)
# Fig. 4 in the paper's words (section VII): which agents of a class pass the action, the object transition.
PUBLISHED_TRANSITIONS: Final = MappingProxyType(
    {
        Condition.WITH_INDICATE: {
            AgentClass.FULL: ("most", "none"),
            AgentClass.PARTIAL: ("some", "none"),
            AgentClass.NONE: ("some", "none"),
        },
        Condition.WITH_IGNORE: {
            AgentClass.FULL: ("none", NOT_GIVEN),
            AgentClass.PARTIAL: ("none", "some"),
            AgentClass.NONE: ("none", "some"),
        },
    }
)


Pair = Callable[[ConditionResults], tuple[str, str]]


def main_lines(results: Results) -> list[Line]:
    """Everything the paper gives a number or a word for, but Table II's other categories."""
    pairs: dict[str, Pair] = {
        "runs that end at the largest fitness, 18/7": _plateau_runs,
        "best fitness at the end of a run": _plateau,
        "runs in which one genotype solved all 28 trials": _solved,
        "runs with fully compositional agents": _runs_with_generalisers,
        "most of them among the five best of a generation": _most_generalisers,
        "their mean rank among the five best, from 0 to 4": lambda found: (
            NOT_GIVEN,
            rank_of_generalisers(found),
        ),
        "most generations in a row in which a run has one": lambda found: (NOT_GIVEN, longest_spell(found)),
    }
    for subtask, words in SUBTASK_WORDS.items():
        pairs[f"agents in category 10 of sub-task {subtask}: {words}"] = _top_share(subtask)
    for kind in AgentClass:
        pairs[f"{kind} agents that pass the action transition"] = _passed_action(kind)
        pairs[f"{kind} agents that pass the object transition"] = _passed_object(kind)
    return [
        Line(what, tuple(pair(found) for found in results.conditions.values()))
        for what, pair in pairs.items()
    ]


def _plateau_runs(found: ConditionResults) -> tuple[str, str]:
    return of(published.RUNS, published.RUNS), of(found.at_plateau, len(found.runs))


def _plateau(found: ConditionResults) -> tuple[str, str]:
    paper = f"about {published.PLATEAU}"
    if not len(found.runs):
        return paper, "no run"
    low, middle, high = np.quantile(found.plateau, [0, 0.5, 1])
    if len(found.runs) == 1:
        return paper, f"{middle:.2f}"
    return paper, f"{low:.2f} to {high:.2f}, median {middle:.2f}"


def _solved(found: ConditionResults) -> tuple[str, str]:
    solved = int((found.first_solved >= 0).sum())
    return NOT_GIVEN, of(solved, len(found.runs)) + first_seeds(found.seeds, found.first_solved)


def _runs_with_generalisers(found: ConditionResults) -> tuple[str, str]:
    known = found.condition is Condition.WITH_INDICATE
    paper = of(published.RUNS_WITH_GENERALISERS, published.RUNS) if known else NOT_GIVEN
    return paper, of(runs_with_generalisers(found), len(found.runs))


def runs_with_generalisers(found: ConditionResults) -> int:
    """Runs in which some agent is fully compositional."""
    return int((found.members[AgentClass.FULL] > 0).sum())


def _most_generalisers(found: ConditionResults) -> tuple[str, str]:
    paper = "one or two" if found.condition is Condition.WITH_INDICATE else NOT_GIVEN
    most = [int(run.counts.max()) for run in found.generalisers]
    return paper, str(max(most)) if most else "no run"


def _top_share(subtask: str) -> Pair:
    column = SUBTASKS.index(subtask)

    def pair(found: ConditionResults) -> tuple[str, str]:
        theirs, ours = published.TABLE_II[found.condition][-1, column], found.counts[-1, column]
        paper = f"{percent(theirs / published.AGENTS)} ({theirs:,})"
        return paper, f"{percent(ours / found.n_agents)} ({ours:,})" if found.n_agents else "no run"

    return pair


def _passed_action(kind: AgentClass) -> Pair:
    def pair(found: ConditionResults) -> tuple[str, str]:
        paper, _ = PUBLISHED_TRANSITIONS[found.condition][kind]
        outcome = found.transitions[kind]
        return paper, _passed(outcome.agents, outcome.action_passed, outcome.runs_action)

    return pair


def _passed_object(kind: AgentClass) -> Pair:
    def pair(found: ConditionResults) -> tuple[str, str]:
        _, paper = PUBLISHED_TRANSITIONS[found.condition][kind]
        outcome = found.transitions[kind]
        return paper, _passed(outcome.agents, outcome.object_passed, outcome.runs_object)

    return pair


def _passed(agents: int, passed: int, runs: int) -> str:
    """How many agents of a class pass, and in how many runs."""
    in_runs = f", in {runs} run{'s' if runs != 1 else ''}" if passed else ""
    return of(passed, agents) + in_runs if agents else "no such agent"


def first_seeds(seeds: Iterable[int], generations: Iterable[int]) -> str:
    """Such as " (seed 7: generation 2,179)"; nothing if there is none."""
    found = [f"seed {s}: generation {g:,}" for s, g in zip(seeds, generations, strict=True) if g >= 0]
    return f" ({', '.join(found)})" if found else ""


def category_tables(results: Results) -> list[tuple[str, list[Line]]]:
    """Table II: for each condition agents by category, with a (paper, ours) pair for each sub-task."""
    tables = []
    for condition, found in results.conditions.items():
        lines = []
        for category in range(N_CATEGORIES):
            pairs = zip(published.TABLE_II[condition][category], found.counts[category], strict=True)
            texts = tuple((f"{theirs:,}", f"{ours:,}") for theirs, ours in pairs)
            lines.append(Line(_category(category), texts))
        tables.append((TITLES[condition], lines))
    return tables


def shown_runs(results: Results) -> PlainTable[AnalysedRun]:
    """Every analysed run: its plateau, when it solved all, agents by class and in category 10."""

    def members(kind: AgentClass) -> Callable[[AnalysedRun], str]:
        return lambda run: f"{run.members(kind):,}"

    def in_top(subtask: str) -> Callable[[AnalysedRun], str]:
        return lambda run: f"{run.in_top(subtask):,}"

    return PlainTable(
        {
            "run": lambda run: f"{TITLES[run.condition]}, seed {run.seed}",
            "plateau": lambda run: f"{run.plateau:.3f}",
            "solved all 28": lambda run: run.first_solved_in_words("{:,}"),
            **{short: members(kind) for kind, short in SHORT.items()},
            **{subtask: in_top(subtask) for subtask in SUBTASKS},
        },
        results.analysed_runs,
    )


def shown_tests(results: Results) -> PlainTable[BothTests]:
    """Comparisons of the conditions: shares, difference, interval, and the tests."""
    first, second = (TITLES[condition] for condition in Condition)
    return PlainTable(
        {
            "share of a run’s agents": lambda both: both.name,  # noqa: RUF001 - as printed
            first: lambda both: percent(both.sound.means[0]),
            second: lambda both: percent(both.sound.means[1]),
            "difference, points [95 %]": lambda both: _with_interval(both.sound),
            "Mann-Whitney p": lambda both: p_value(both.sound.mann_whitney_p),
            "permutation p": lambda both: p_value(both.sound.permutation_p),
            "Cliff’s delta": lambda both: f"{both.sound.cliffs_delta:+.2f}",  # noqa: RUF001 - as printed
            "paper’s kind, p": lambda both: p_value(both.published_p),  # noqa: RUF001 - as printed
        },
        both_tests(results),
    )


def _with_interval(sound: Comparison) -> str:
    """A difference in percentage points with its interval."""
    low, high = sound.interval
    return f"{points(sound.difference)} [{points(low)}, {points(high)}]"


def _category(category: int) -> str:
    return "0" if category == 0 else f"{category} ({8 * (category - 1) + 1} to {8 * category})"
