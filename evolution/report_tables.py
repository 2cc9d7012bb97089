"""The report's words and tables: published numbers beside ours, already as text."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from types import MappingProxyType
from typing import Final

import numpy as np

from arm2d import Condition
from evolution import published
from evolution.analysis import ConditionResults, Results
from evolution.settings import Settings
from evolution.subtasks import N_CATEGORIES, SUBTASKS, AgentClass

TITLES: Final = MappingProxyType(
    {Condition.WITH_INDICATE: "With-Indicate", Condition.WITH_IGNORE: "With-Ignore"}
)
NOT_GIVEN: Final = "not given"
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


@dataclass(frozen=True)
class Line:
    """One row of a table of pairs: what it is, then (paper, ours) for each condition."""

    what: str
    pairs: tuple[tuple[str, str], ...]


def main_lines(results: Results) -> list[Line]:
    """Everything the paper gives a number or a word for, but Table II's other categories."""
    shown = list(results.conditions.items())

    def line(what: str, pair) -> Line:
        return Line(what, tuple(pair(condition, each) for condition, each in shown))

    lines = [
        line("runs that end at the largest fitness, 18/7", _plateau_runs),
        line("best fitness at the end of a run", _plateau),
        line("runs in which one genotype solved all 28 trials", _solved),
        line("runs with fully compositional agents", _runs_with_generalisers),
        line("most of them among the five best of a generation", _most_generalisers),
    ]
    for index, name in enumerate(SUBTASKS):
        what = f"agents in category 10 of sub-task {name}: {SUBTASK_WORDS[name]}"
        lines.append(line(what, lambda c, each, i=index: _top_share(c, each, i)))
    for kind in AgentClass:
        for test, word in enumerate(("action", "object")):
            what = f"{kind} agents that pass the {word} transition"
            lines.append(line(what, lambda c, each, k=kind, t=test: _passed(c, each, k, t)))
    return lines


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


def run_rows(results: Results) -> list[tuple[str, ...]]:
    """One row per analysed run: its plateau, when it solved all, agents by class and in category 10."""
    rows = []
    for condition, each in results.conditions.items():
        for run, seed in enumerate(each.seeds):
            first = int(each.first_solved[run])
            rows.append(
                (
                    f"{TITLES[condition]}, seed {seed}",
                    f"{each.plateau[run]:.3f}",
                    f"{first:,}" if first >= 0 else "never",
                    *(f"{each.members[kind][run]:,}" for kind in AgentClass),
                    *(f"{each.counts_per_run[run, -1, column]:,}" for column in range(len(SUBTASKS))),
                )
            )
    return rows


def comparison_rows(results: Results) -> list[tuple[str, ...]]:
    """One row per comparison of the conditions: shares, difference, interval, and the tests."""
    return [
        (
            name,
            *(percent(mean) for mean in each.means),
            f"{_points(each.difference)} [{_points(each.interval[0])}, {_points(each.interval[1])}]",
            p_value(each.mann_whitney_p),
            p_value(each.permutation_p),
            f"{each.cliffs_delta:+.2f}",
            p_value(results.published_tests[name][1]),
        )
        for name, each in results.comparisons.items()
    ]


def departures_in_size(results: Results) -> list[str]:
    """Where an experiment is smaller or larger than the paper's, so that numbers cannot be compared."""
    sentences = []
    settings = {run.config.settings for run in results.experiment.all_runs}
    paper = Settings().to_mapping()
    for each in settings:
        ours = each.to_mapping()
        sentences += [
            f"{name.replace('_', ' ')} {ours[name]:,}, not {paper[name]:,}"
            for name in paper
            if ours[name] != paper[name]
        ]
    for condition, each in results.conditions.items():
        if len(each.runs) != published.RUNS:
            runs = "run" if len(each.runs) == 1 else "runs"
            sentences.append(f"{len(each.runs)} {TITLES[condition]} {runs}, not {published.RUNS}")
    return sentences


def percent(share: float) -> str:
    """A share in per cent; small ones with more digits, so that few agents are not shown as none."""
    if share == 0:
        return "0 %"
    return f"{100 * share:.1f} %" if share >= 0.001 else f"{100 * share:.3f} %"


def p_value(p: float) -> str:
    """A p-value as exact as it makes sense."""
    if math.isnan(p):
        return "not defined"
    if p < 1e-300:
        return "below 1e-300"
    return f"{p:.2g}" if p < 0.995 else "1"


def of(part: int, whole: int) -> str:
    """Such as "3 of 10"."""
    return f"{part:,} of {whole:,}"


def first_seeds(seeds: Iterable[int], generations: Iterable[int]) -> str:
    """Such as " (seed 7: generation 2,179)"; nothing if there is none."""
    found = [f"seed {s}: generation {g:,}" for s, g in zip(seeds, generations, strict=True) if g >= 0]
    return f" ({', '.join(found)})" if found else ""


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
    return paper, str(int(each.generalisers.max())) if each.generalisers.size else "no run"


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


def _category(category: int) -> str:
    return "0" if category == 0 else f"{category} ({8 * (category - 1) + 1} to {8 * category})"


def _points(difference: float) -> str:
    rounded = round(100 * difference, 1) + 0.0  # no minus before nought
    return f"{rounded:+.1f}".replace("-", "−") if rounded else "0.0"  # noqa: RUF001 - minus
