"""Everything the paper's figures and tables show, computed from an experiment's files.

Nothing is run or drawn here: runs, post-evaluations and transition tests are read, and numbers come
out. Runs that are missing, unfinished or damaged are left out and named.

Axes: R runs, G generations, L late generations (4000 to 5999 in the paper), 5 ranks, 9 instructions.
"""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray

from arm2d import Condition
from evolution.agents.postevaluation import N_INSTRUCTIONS, TRIALS
from evolution.agents.subtasks import N_CATEGORIES, SUBTASKS, AgentClass, categories, classify, count_table
from evolution.agents.transitions import CLASSES, TransitionTest, passes
from evolution.experiments.experiment import Experiment
from evolution.results.comparisons import compare_conditions
from evolution.results.generalisers import generalisers_of
from evolution.results.records import ConditionResults, Results, TransitionOutcome
from evolution.results.statistics import mean_interval
from evolution.results.tested_runs import TestedRun, read_tested_runs
from evolution.runs.folder import RunFolder
from evolution.search.randomness import Purpose, generator
from evolution.search.settings import N_BEST

# A run's plateau is its median best fitness over this last part of its generations.
PLATEAU_SHARE: Final = 1 / 6


def analyse(experiment: Experiment) -> Results:
    """Analyse an experiment as far as it goes.

    Raises:
        ValueError: If its runs are of different lengths.
    """
    conditions = {c: _analyse_condition(c, runs) for c, runs in experiment.runs.items()}
    comparisons, published = compare_conditions(conditions)
    return Results(experiment, conditions, comparisons, published)


def check_some_tested(results: Results) -> None:
    """Refuse an analysis without a single run.

    Raises:
        ValueError: With what the first run lacks, and the command that makes it.
    """
    if not any(len(each.runs) for each in results.conditions.values()):
        first, others = results.missing[0], len(results.missing) - 1
        more = f" (likewise {others} more)" if others else ""
        raise ValueError(f"{results.experiment.path} has no run that can be analysed: {first}{more}")


def interval_of_mean(values: NDArray[np.float64]) -> tuple[float, float]:
    """95 % bootstrap interval of the mean over runs, the same whenever it is asked for."""
    return mean_interval(values, generator(0, Purpose.STATISTICS))


def _analyse_condition(condition: Condition, runs: tuple[RunFolder, ...]) -> ConditionResults:
    tested, missing = read_tested_runs(runs)
    best = np.stack([run.best for run in tested]) if tested else np.empty((0, 0))
    generations, successes = _late_successes(tested)
    agents = [run.evaluation.agents for run in tested]
    tables = [count_table(categories(own, condition)) for own in agents]
    counts_per_run = np.array(tables, np.int64).reshape(len(tested), N_CATEGORIES, len(SUBTASKS))
    classes = [classify(own, condition) for own in agents]
    full = [members[AgentClass.FULL].reshape(-1, N_BEST) for members in classes]
    return ConditionResults(
        condition=condition,
        runs=tuple(run.run for run in tested),
        seeds=np.array([run.run.config.seed for run in tested], np.int64),
        best=best,
        plateau=_plateaus(best),
        first_solved=np.array([run.first_solved for run in tested], np.int64),
        genotypes=np.array([run.genotypes for run in tested], np.int64),
        longest_stay=np.array([run.longest_stay for run in tested], np.int64),
        generations=generations,
        successes=successes,
        counts=counts_per_run.sum(axis=0),
        counts_per_run=counts_per_run,
        members={c: np.array([own[c].sum() for own in classes], np.int64) for c in AgentClass},
        generalisers=tuple(
            generalisers_of(run.run, generations, members) for run, members in zip(tested, full, strict=True)
        ),
        transitions=_transition_outcomes([run.transitions for run in tested]),
        missing=tuple(missing),
    )


def _plateaus(best: NDArray[np.float64]) -> NDArray[np.float64]:
    """Median best fitness of each run over its last generations, [R]."""
    last = max(1, round(best.shape[1] * PLATEAU_SHARE))
    return np.median(best[:, -last:], axis=1) if best.size else np.empty(0)


def _late_successes(tested: list[TestedRun]) -> tuple[NDArray[np.int32], NDArray[np.int16]]:
    """(late generations [L], successes [R, L, 5, 9])."""
    if not tested:
        return np.empty(0, np.int32), np.empty((0, 0, N_BEST, N_INSTRUCTIONS), np.int16)
    return tested[0].evaluation.generations, np.stack([run.evaluation.successes for run in tested])


def _transition_outcomes(tests: list[TransitionTest]) -> dict[AgentClass, TransitionOutcome]:
    """What each class made of the tests, over all runs."""
    outcomes = {}
    for index, members in enumerate(CLASSES):
        own = [(test.action[test.classes == index], test.object[test.classes == index]) for test in tests]
        passed = [(passes(action), passes(object_)) for action, object_ in own]
        action, object_ = (_mean_share([pair[test] for pair in own]) for test in (0, 1))
        outcomes[members] = TransitionOutcome(
            agents=sum(len(agents) for agents, _ in own),
            action_passed=sum(int(agents.sum()) for agents, _ in passed),
            object_passed=sum(int(agents.sum()) for _, agents in passed),
            action_success=action,
            object_success=object_,
            runs_action=sum(bool(agents.any()) for agents, _ in passed),
            runs_object=sum(bool(agents.any()) for _, agents in passed),
        )
    return outcomes


def _mean_share(successes: list[NDArray[np.int16]]) -> NDArray[np.float64]:
    """Mean share of successful trials of all agents in each transition, [X]."""
    agents = np.concatenate(successes) if successes else np.empty((0, 0))
    return agents.mean(axis=0) / TRIALS if len(agents) else np.full(agents.shape[1:], np.nan)
