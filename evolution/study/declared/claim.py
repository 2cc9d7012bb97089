"""Does INDICATE foster compositionality? The declared tests, the run as the unit (docs/declaration.md)."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from arm2d import Condition
from arm2d.tasks.task import AnyTask
from evolution.agents.subtasks import SUBTASKS, AgentClass
from evolution.report.columns import PlainTable
from evolution.results.statistics import (
    bootstrap_interval,
    declared_ways,
    difference_of_means,
    drawn_sign_flip_test,
    mean_interval,
    permutation_p,
    proportions_interval,
    ratio_of_means,
)
from evolution.search.randomness import Purpose, generator
from evolution.study.declared.beta_binomial import Counts, compare_counts
from evolution.study.declared.regression import Estimate, estimate_columns
from evolution.study.declared.rows import MeasuredRun
from evolution.study.effects import holm
from evolution.study.late_transitions import CLASSES, TESTS

STRICT: Final = 0.01
FULL: Final = str(AgentClass.FULL)
PARTIAL: Final = str(AgentClass.PARTIAL)
# With fewer runs above 0, those that a bootstrap draws may all be 0, and nothing can be divided by them.
ENOUGH: Final = 10
UNKNOWN: Final = Estimate(float("nan"), float("nan"), float("nan"))


@dataclass(frozen=True)
class Question:
    """A count of agents within a run, and the agents it is a share of."""

    name: str
    count: str
    among: str = "agents"

    def counts(self, runs: Sequence[MeasuredRun]) -> Counts:
        """(k, n) of every run that has agents of the kind."""
        pairs = [(run.counts[self.count], run.counts[self.among]) for run in runs if run.counts[self.among]]
        k, n = np.array(pairs, np.int64).reshape(-1, 2).T
        return k, n

    def shares(self, runs: Sequence[MeasuredRun]) -> NDArray[np.float64]:
        """K / n of these runs."""
        k, n = self.counts(runs)
        return k / n


# The test that decides comes first; the others are corrected together.
QUESTIONS: Final = (
    Question("fully compositional agents", FULL),
    Question("partially compositional agents", PARTIAL),
    *(Question(f"agents in category 10 of {name}", f"category 10 of {name}") for name in SUBTASKS[1:]),
    Question("masters that understand MOVE Blue", "masters that understand MOVE Blue", "masters"),
    Question("masters that understand TOUCH Green", "masters that understand TOUCH Green", "masters"),
    Question("masters that understand both", FULL, "masters"),
    *(
        Question(f"{kind} agents that pass {test} transitions", f"{kind}, pass {test} transitions", str(kind))
        for test in TESTS
        for kind in CLASSES
    ),
)
HAVING: Final = (FULL, PARTIAL)  # runs that have such agents are counted, too


@dataclass(frozen=True)
class Answer:
    """One test of the two conditions, With-Indicate less With-Ignore.

    Attributes:
        question: What was asked.
        runs: Of each condition that could tell.
        means: Of each condition: mean share over runs, or share of runs.
        difference: Of these, with its 95 % interval.
        p: Of the declared model,
        permutation_p: and of permuted runs; NaN for shares of runs and for worlds.
        corrected: p after Holm's correction; the first question's is its own.
        ratio: With-Indicate's mean share by With-Ignore's, with a 95 % bootstrap interval over runs: told
            beside the tests. Unknown where fewer than `ENOUGH` runs of a condition have any, for shares of
            runs and for worlds.
    """

    question: str
    runs: tuple[int, int]
    means: tuple[float, float]
    difference: Estimate
    p: float
    permutation_p: float = float("nan")
    corrected: float = float("nan")
    ratio: Estimate = UNKNOWN


def answers(runs: Sequence[MeasuredRun]) -> list[Answer]:
    """All declared tests between the conditions; those that too few runs can tell are left out.

    Raises:
        ValueError: If there are fewer than two runs of a condition.
    """
    groups = [[run for run in runs if run.config.condition is condition] for condition in Condition]
    if min(map(len, groups)) < 2:
        told = " and ".join(str(len(group)) for group in groups)
        raise ValueError(f"{told} runs of the conditions are measured; the tests need two of each")
    first, *others = [
        _by_counts(question, groups)
        for question in QUESTIONS
        if min(len(question.counts(group)[0]) for group in groups) >= 2
    ]
    others = [*(_by_runs(kind, groups) for kind in HAVING), *others]
    corrected = [first.p, *holm(np.array([each.p for each in others]))]
    return [replace(each, corrected=float(p)) for each, p in zip([first, *others], corrected, strict=True)]


def shares_by_world(runs: Sequence[MeasuredRun], question: Question) -> NDArray[np.float64]:
    """Shares [W, 2], With-Indicate and With-Ignore, in the W worlds in which both can tell."""
    able = [run for run in runs if run.counts[question.among]]
    return _by_world(able, lambda run: run.counts[question.count] / run.counts[question.among])


def _by_world(runs: Iterable[MeasuredRun], number: Callable[[MeasuredRun], float]) -> NDArray[np.float64]:
    """A number of each run [W, 2], With-Indicate and With-Ignore, in the W worlds that both met."""
    found: dict[AnyTask, dict[int, float]] = {condition: {} for condition in Condition}
    for run in runs:
        found[run.config.condition][run.config.seed] = number(run)
    first, second = found.values()
    both = sorted(first.keys() & second.keys())
    return np.array([(first[seed], second[seed]) for seed in both], float).reshape(-1, 2)


def averaged_over_worlds(runs: Sequence[MeasuredRun]) -> list[Answer]:
    """The same questions over the worlds that both conditions met, as paired differences."""
    shares = {question.name: shares_by_world(runs, question) for question in QUESTIONS}
    having = {
        _runs_with(kind): _by_world(runs, lambda run, kind=kind: run.counts[kind] > 0) for kind in HAVING
    }
    decides = QUESTIONS[0].name
    found = [
        _by_differences(name, pairs)
        for name, pairs in ({decides: shares.pop(decides)} | having | shares).items()
        if len(pairs) >= 2
    ]
    corrected = [found[0].p, *holm(np.array([each.p for each in found[1:]]))] if found else []
    return [replace(each, corrected=float(p)) for each, p in zip(found, corrected, strict=True)]


def _by_differences(name: str, pairs: NDArray[np.float64]) -> Answer:
    """A question answered by numbers of two conditions in the same worlds, [W, 2]."""
    differences, means = pairs[:, 0] - pairs[:, 1], pairs.mean(axis=0)
    interval = mean_interval(differences, generator(0, Purpose.STATISTICS))
    p = drawn_sign_flip_test(differences, generator(0, Purpose.STATISTICS))
    difference = Estimate(float(differences.mean()), *interval)
    return Answer(name, (len(pairs), len(pairs)), (float(means[0]), float(means[1])), difference, p)


def verdict(under_default: Answer, over_worlds: Estimate) -> str:
    """The declared sentence.

    Args:
        under_default: The first question's answer from the hundred runs.
        over_worlds: The same difference averaged over the worlds of the factorial study.
    """
    own = under_default.difference
    told = (
        f"{100 * own.value:+.2g} points of all late agents [{100 * own.low:.2g}, {100 * own.high:.2g}], "
        f"p = {under_default.p:.2g}, under the default; {100 * over_worlds.value:+.2g} "
        f"[{100 * over_worlds.low:.2g}, {100 * over_worlds.high:.2g}] averaged over worlds"
    )
    same_sign = own.value * over_worlds.value > 0
    if under_default.p < STRICT and same_sign:
        return f"{'supported' if own.value > 0 else 'contradicted'}: {told}"
    if own.value * over_worlds.value < 0 and not _holds_zero(own) and not _holds_zero(over_worlds):
        return f"depends on the reading: {told}"
    return f"undecided: {told}"


def answer_table(sources: Iterable[tuple[str, Sequence[Answer]]]) -> PlainTable[tuple[str, Answer]]:
    """One row per source of runs and test."""
    return PlainTable(
        {
            "runs": lambda row: row[0],
            "question": lambda row: row[1].question,
            "With-Indicate runs": lambda row: row[1].runs[0],
            "With-Ignore runs": lambda row: row[1].runs[1],
            "With-Indicate": lambda row: f"{row[1].means[0]:.5f}",
            "With-Ignore": lambda row: f"{row[1].means[1]:.5f}",
            **estimate_columns("difference", "low", "high", of=lambda row: row[1].difference, form=".5f"),
            **_ratio_columns(),
            "p": lambda row: f"{row[1].p:.2g}",
            "p by permutation of runs": lambda row: _if_known(row[1].permutation_p),
            "after Holm": lambda row: f"{row[1].corrected:.2g}",
        },
        [(source, answer) for source, found in sources for answer in found],
    )


def _ratio_columns() -> dict[str, Callable[[tuple[str, Answer]], str]]:
    """Three columns that are empty where the ratio is unknown."""
    columns = estimate_columns("ratio", "ratio low", "ratio high", of=lambda row: row[1].ratio, form=".2f")
    return {
        name: lambda row, told=told: "" if np.isnan(row[1].ratio.value) else told(row)
        for name, told in columns.items()
    }


def _if_known(p: float) -> str:
    return "" if np.isnan(p) else f"{p:.2g}"


def _by_counts(question: Question, groups: Sequence[Sequence[MeasuredRun]]) -> Answer:
    """A question answered by the beta-binomial model, and by permutation of runs."""
    first, second = (question.shares(group) for group in groups)
    means = float(first.mean()), float(second.mean())
    rng, ways = generator(0, Purpose.STATISTICS), declared_ways(len(first) + len(second), len(first))
    interval = bootstrap_interval([first, second], difference_of_means, rng)
    tested = compare_counts(*(question.counts(group) for group in groups))
    return Answer(
        question.name, (len(first), len(second)), means, Estimate(means[0] - means[1], *interval),
        tested.p, permutation_p(np.concatenate([first, second]), ways), ratio=_ratio(first, second),
    )  # fmt: skip


def _ratio(first: NDArray[np.float64], second: NDArray[np.float64]) -> Estimate:
    """Of mean shares."""
    if min(map(np.count_nonzero, (first, second))) < ENOUGH:
        return UNKNOWN
    interval = bootstrap_interval([first, second], ratio_of_means, generator(0, Purpose.STATISTICS))
    return Estimate(float(first.mean() / second.mean()), *interval)


def _by_runs(kind: str, groups: Sequence[Sequence[MeasuredRun]]) -> Answer:
    """How many runs have agents of a class."""
    from scipy.stats import fisher_exact

    counted = [(sum(run.counts[kind] > 0 for run in group), len(group)) for group in groups]
    (k1, n1), (k2, n2) = counted
    p: Any = fisher_exact([[k1, n1 - k1], [k2, n2 - k2]])[1]
    difference = Estimate((k1 / n1) - (k2 / n2), *proportions_interval(*counted))
    return Answer(_runs_with(kind), (n1, n2), (k1 / n1, k2 / n2), difference, float(p))


def _runs_with(kind: str) -> str:
    """What is asked of runs that have agents of a class."""
    return f"runs with {kind} agents"


def _holds_zero(each: Estimate) -> bool:
    return each.low <= 0 <= each.high
