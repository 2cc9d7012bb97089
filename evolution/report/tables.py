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


def main_lines(results: Results) -> list[Line]:
    """Everything the paper gives a number or a word for, but Table II's other categories."""
    shown = list(results.conditions.items())

    def line(what: str, pair: Callable[[Condition, ConditionResults], tuple[str, str]]) -> Line:
        return Line(what, tuple(pair(condition, each) for condition, each in shown))

    lines = [
        line("runs that end at the largest fitness, 18/7", _plateau_runs),
        line("best fitness at the end of a run", _plateau),
        line("runs in which one genotype solved all 28 trials", _solved),
        line("runs with fully compositional agents", _runs_with_generalisers),
        line("most of them among the five best of a generation", _most_generalisers),
        line("their mean rank among the five best, from 0 to 4", _rank_of_generalisers),
        line("most generations in a row in which a run has one", _longest_spell),
    ]
    for index, name in enumerate(SUBTASKS):
        what = f"agents in category 10 of sub-task {name}: {SUBTASK_WORDS[name]}"
        lines.append(line(what, lambda c, each, i=index: _top_share(c, each, i)))
    for kind in AgentClass:
        for test, word in enumerate(("action", "object")):
            what = f"{kind} agents that pass the {word} transition"
            lines.append(line(what, lambda c, each, k=kind, t=test: _passed(c, each, k, t)))
    return lines


def _plateau_runs(condition: Condition, each: ConditionResults) -> tuple[str, str]:
    return of(published.RUNS, published.RUNS), of(each.at_plateau, len(each.runs))


def _plateau(condition: Condition, each: ConditionResults) -> tuple[str, str]:
    paper = f"about {published.PLATEAU}"
    if not len(each.runs):
        return paper, "no run"
    low, middle, high = np.quantile(each.plateau, [0, 0.5, 1])
    if len(each.runs) == 1:
        return paper, f"{middle:.2f}"
    return paper, f"{low:.2f} to {high:.2f}, median {middle:.2f}"


def _solved(condition: Condition, each: ConditionResults) -> tuple[str, str]:
    solved = int((each.first_solved >= 0).sum())
    return NOT_GIVEN, of(solved, len(each.runs)) + first_seeds(each.seeds, each.first_solved)


def _runs_with_generalisers(condition: Condition, each: ConditionResults) -> tuple[str, str]:
    known = condition is Condition.WITH_INDICATE
    paper = of(published.RUNS_WITH_GENERALISERS, published.RUNS) if known else NOT_GIVEN
    return paper, of(runs_with_generalisers(each), len(each.runs))


def runs_with_generalisers(each: ConditionResults) -> int:
    """Runs in which some agent is fully compositional."""
    return int((each.members[AgentClass.FULL] > 0).sum())


def _most_generalisers(condition: Condition, each: ConditionResults) -> tuple[str, str]:
    paper = "one or two" if condition is Condition.WITH_INDICATE else NOT_GIVEN
    return paper, str(max(int(found.counts.max()) for found in each.generalisers)) if each.runs else "no run"


def _rank_of_generalisers(condition: Condition, each: ConditionResults) -> tuple[str, str]:
    return NOT_GIVEN, rank_of_generalisers(each)


def _longest_spell(condition: Condition, each: ConditionResults) -> tuple[str, str]:
    return NOT_GIVEN, longest_spell(each)


def _top_share(condition: Condition, each: ConditionResults, column: int) -> tuple[str, str]:
    theirs, ours = published.TABLE_II[condition][-1, column], each.counts[-1, column]
    return (
        f"{percent(theirs / published.AGENTS)} ({theirs:,})",
        f"{percent(ours / each.n_agents)} ({ours:,})" if each.n_agents else "no run",
    )


def _passed(condition: Condition, each: ConditionResults, kind: AgentClass, test: int) -> tuple[str, str]:
    outcome = each.transitions[kind]
    action = (outcome.action_passed, outcome.runs_action)
    object_ = (outcome.object_passed, outcome.runs_object)
    passed, runs = object_ if test else action
    in_runs = f", in {runs} run{'s' if runs != 1 else ''}" if passed else ""
    ours = of(passed, outcome.agents) + in_runs if outcome.agents else "no such agent"
    return PUBLISHED_TRANSITIONS[condition][kind][test], ours


def first_seeds(seeds: Iterable[int], generations: Iterable[int]) -> str:
    """Such as " (seed 7: generation 2,179)"; nothing if there is none."""
    found = [f"seed {s}: generation {g:,}" for s, g in zip(seeds, generations, strict=True) if g >= 0]
    return f" ({', '.join(found)})" if found else ""


def category_tables(results: Results) -> list[tuple[str, list[Line]]]:
    """Table II: for each condition agents by category, with a (paper, ours) pair for each sub-task."""
    tables = []
    for condition, each in results.conditions.items():
        lines = []
        for category in range(N_CATEGORIES):
            pairs = zip(published.TABLE_II[condition][category], each.counts[category], strict=True)
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
