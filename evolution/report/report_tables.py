"""The report's other tables, as text: Table II, runs, generalisers, comparisons, departures in size."""

from __future__ import annotations

from evolution.agents.subtasks import N_CATEGORIES, SUBTASKS, AgentClass
from evolution.results import published
from evolution.results.records import Results
from evolution.results.wording import TITLES, Line, p_value, percent, points
from evolution.search.settings import Settings


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
            f"{points(each.difference)} [{points(each.interval[0])}, {points(each.interval[1])}]",
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


def _category(category: int) -> str:
    return "0" if category == 0 else f"{category} ({8 * (category - 1) + 1} to {8 * category})"
