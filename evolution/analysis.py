"""Everything the paper's figures and tables show, computed from an experiment's files.

Nothing is run or drawn here: runs, post-evaluations and transition tests are read, and numbers come
out. Runs that are missing, unfinished or damaged are left out and named.

Axes: R runs, G generations, L late generations (4000 to 5999 in the paper), 5 ranks, 9 instructions.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from arm2d import NON_EXPERIENCED, Condition
from evolution.experiment import Experiment, state_of
from evolution.folder import RunFolder
from evolution.postevaluation import N_INSTRUCTIONS, TRIALS, read_post_evaluation
from evolution.randomness import Purpose, generator
from evolution.recorded import recorded_history
from evolution.settings import N_BEST
from evolution.solving import solved_trials
from evolution.statistics import Comparison, compare, mean_interval, wilcoxon_as_published
from evolution.subtasks import N_CATEGORIES, SUBTASKS, AgentClass, categories, classify, count_table
from evolution.transition_test import CLASSES, TransitionTest, read_transition_test
from evolution.transitions import passes

# A run's plateau is its median best fitness over this last part of its generations.
PLATEAU_SHARE: Final = 1 / 6
# Runs whose plateau comes so near to 18/7 count as having reached the paper's 2.57.
PLATEAU_TOLERANCE: Final = 0.02
FITNESS_LIMIT: Final = 18 / 7


@dataclass(frozen=True)
class Agent:
    """One agent of an experiment, and what it made of nine instructions.

    Attributes:
        run: The run's folder.
        generation: The generation,
        rank: the place in it, 0 for the best.
        successes: [9], of 80 trials each.
    """

    run: RunFolder
    generation: int
    rank: int
    successes: NDArray[np.int16]


@dataclass(frozen=True)
class TransitionOutcome:
    """What a class of agents made of the two transition tests.

    Attributes:
        agents: How many were tested.
        action_passed: How many passed the action transition,
        object_passed: and the object transition.
        action_success: [X], mean share of successful trials in each transition of the action word,
        object_success: and of the object word. NaN if no agent was tested.
        runs_action: Runs with an agent that passed the action transition,
        runs_object: and the object transition.
    """

    agents: int
    action_passed: int
    object_passed: int
    action_success: NDArray[np.float64]
    object_success: NDArray[np.float64]
    runs_action: int
    runs_object: int


@dataclass(frozen=True)
class ConditionResults:
    """The results of one condition.

    Attributes:
        condition: With-Indicate or With-Ignore.
        runs: The R runs that are in here.
        seeds: [R].
        best: [R, G], best fitness per generation.
        plateau: [R], median best fitness at the end.
        first_solved: [R], first generation in which one genotype carried out all trials; -1 if none.
        generations: [L], the late generations.
        successes: [R, L, 5, 9], of 80 trials.
        counts: [11, 4], Table II: agents by category and sub-task.
        counts_per_run: [R, 11, 4].
        members: Agents of each class, [R] by class.
        generalisers: [R, L], fully compositional agents among the five best.
        transitions: By class.
        missing: One sentence for every run that was left out.
    """

    condition: Condition
    runs: tuple[RunFolder, ...]
    seeds: NDArray[np.int64]
    best: NDArray[np.float64]
    plateau: NDArray[np.float64]
    first_solved: NDArray[np.int64]
    generations: NDArray[np.int32]
    successes: NDArray[np.int16]
    counts: NDArray[np.int64]
    counts_per_run: NDArray[np.int64]
    members: Mapping[AgentClass, NDArray[np.int64]]
    generalisers: NDArray[np.int64]
    transitions: Mapping[AgentClass, TransitionOutcome]
    missing: tuple[str, ...]

    @property
    def n_agents(self) -> int:
        """All post-evaluated agents."""
        return int(self.counts[:, 0].sum())

    @property
    def at_plateau(self) -> int:
        """Runs that end at the paper's 2.57."""
        return int((self.plateau >= FITNESS_LIMIT - PLATEAU_TOLERANCE).sum())

    def share_in_top(self, subtask: str) -> NDArray[np.float64]:
        """Share of each run's agents in category 10 of a sub-task, [R]."""
        column = self.counts_per_run[:, :, SUBTASKS.index(subtask)]
        return column[:, -1] / np.maximum(column.sum(axis=1), 1)

    def share_of_class(self, members: AgentClass) -> NDArray[np.float64]:
        """Share of each run's agents in a class, [R]."""
        return self.members[members] / (len(self.generations) * N_BEST)

    def best_agent(self) -> Agent | None:
        """The agent whose least-mastered instruction of all nine succeeds most; then the most successes."""
        return self._first_by(self.successes.min(axis=-1), self.successes.sum(axis=-1))

    def best_partial_agent(self) -> Agent | None:
        """Among agents above 75 % on the experienced, the one with most successes on a never-met one."""
        order = [self.condition.instructions.index(each) for each in NON_EXPERIENCED]
        known = [i for i in range(N_INSTRUCTIONS) if i not in order]
        master = np.all(4 * self.successes[..., known].astype(np.int64) > 3 * TRIALS, axis=-1)
        return self._first_by(master, self.successes[..., order].max(axis=-1), self.successes.sum(axis=-1))

    def best_specialist(self) -> Agent | None:
        """The agent that masters the experienced instructions best and never a never-met one."""
        order = [self.condition.instructions.index(each) for each in NON_EXPERIENCED]
        known = [i for i in range(N_INSTRUCTIONS) if i not in order]
        untouched = (self.successes[..., order] == 0).all(axis=-1)
        return self._first_by(
            untouched, self.successes[..., known].min(axis=-1), self.successes[..., known].sum(axis=-1)
        )

    def _first_by(self, *keys: NDArray) -> Agent | None:
        """The agent with the largest keys, the first counting most; the earliest of equals."""
        if not self.successes.size:
            return None
        index = np.lexsort([-key.reshape(-1).astype(np.int64) for key in reversed(keys)])[0]
        run, late, rank = np.unravel_index(index, self.successes.shape[:3])
        return Agent(self.runs[run], int(self.generations[late]), int(rank), self.successes[run, late, rank])


@dataclass(frozen=True)
class Results:
    """The results of an experiment.

    Attributes:
        experiment: Where they come from.
        conditions: By condition, as far as there are runs.
        comparisons: Between With-Indicate and With-Ignore with the run as the unit, by what is compared.
        published_tests: (statistic, p) of the paper's kind of test, by the same names.
    """

    experiment: Experiment
    conditions: Mapping[Condition, ConditionResults]
    comparisons: Mapping[str, Comparison]
    published_tests: Mapping[str, tuple[float, float]]

    @property
    def missing(self) -> tuple[str, ...]:
        """One sentence for every run that was left out."""
        return tuple(sentence for each in self.conditions.values() for sentence in each.missing)


def analyse(experiment: Experiment) -> Results:
    """Analyse an experiment as far as it goes."""
    conditions = {c: _analyse_condition(c, runs) for c, runs in experiment.runs.items()}
    comparisons: dict[str, Comparison] = {}
    published: dict[str, tuple[float, float]] = {}
    if all(len(each.runs) for each in conditions.values()) and len(conditions) == len(Condition):
        rng = generator(0, Purpose.STATISTICS)
        for name, (first, second) in _compared(conditions).items():
            comparisons[name] = compare(first, second, rng)
            published[name] = wilcoxon_as_published(*_per_generation(conditions, name))
    return Results(experiment, conditions, comparisons, published)


def interval_of_mean(values: NDArray[np.float64]) -> tuple[float, float]:
    """95 % bootstrap interval of the mean over runs, the same whenever it is asked for."""
    return mean_interval(values, generator(0, Purpose.STATISTICS))


def _analyse_condition(condition: Condition, runs: tuple[RunFolder, ...]) -> ConditionResults:
    complete, missing = _complete(runs)
    generations, successes = _read_successes(complete)
    histories = [recorded_history(run) for run in complete]
    best = _stack([each.best for each in histories])
    last = max(1, round(best.shape[1] * PLATEAU_SHARE)) if best.size else 1
    per_run = [categories(each.reshape(-1, N_INSTRUCTIONS), condition) for each in successes]
    tables = [count_table(each) for each in per_run]
    counts_per_run = np.array(tables, np.int64).reshape(len(complete), N_CATEGORIES, len(SUBTASKS))
    classes = [classify(each.reshape(-1, N_INSTRUCTIONS), condition) for each in successes]
    full = [each[AgentClass.FULL].reshape(len(generations), N_BEST).sum(axis=1) for each in classes]
    return ConditionResults(
        condition=condition,
        runs=tuple(complete),
        seeds=np.array([run.config.seed for run in complete], np.int64),
        best=best,
        plateau=np.median(best[:, -last:], axis=1) if best.size else np.empty(0),
        first_solved=np.array([_first_solved(run) for run in complete], np.int64),
        generations=generations,
        successes=successes,
        counts=counts_per_run.sum(axis=0),
        counts_per_run=counts_per_run,
        members={c: np.array([each[c].sum() for each in classes], np.int64) for c in AgentClass},
        generalisers=np.array(full, np.int64).reshape(len(complete), len(generations)),
        transitions=_transition_outcomes([read_transition_test(run) for run in complete]),
        missing=tuple(missing),
    )


def _complete(runs: tuple[RunFolder, ...]) -> tuple[list[RunFolder], list[str]]:
    """The runs that can be analysed, and a sentence for each of the others."""
    complete, missing = [], []
    for run in runs:
        state, name = state_of(run), f"{run.config.condition}, seed {run.config.seed}"
        if state.complete:
            try:
                read_transition_test(run)
                complete.append(run)
                continue
            except ValueError as error:
                missing.append(f"{name}: left out, {error}")
        elif state.damage:
            missing.append(f"{name}: left out, {state.damage}")
        elif not state.finished:
            missing.append(
                f"{name}: left out, {state.generations} generations so far; go on with: wordarm evolve"
            )
        else:
            missing.append(
                f"{name}: left out, not post-evaluated; go on with: wordarm postevaluate {run.path}"
            )
    # Runs of different lengths cannot stand in one table.
    lengths = {run.config.settings.generations for run in complete}
    if len(lengths) > 1:
        raise ValueError(f"the runs have {sorted(lengths)} generations; analyse runs of one length together")
    return complete, missing


def _read_successes(runs: list[RunFolder]) -> tuple[NDArray[np.int32], NDArray[np.int16]]:
    """(late generations [L], successes [R, L, 5, 9])."""
    tests = [read_post_evaluation(run) for run in runs]
    if not tests:
        return np.empty(0, np.int32), np.empty((0, 0, N_BEST, N_INSTRUCTIONS), np.int16)
    return tests[0].generations, np.stack([each.successes for each in tests])


def _first_solved(run: RunFolder) -> int:
    """The first generation in which all trials of evolution were carried out by one genotype, or -1."""
    n_trials = len(run.config.condition.experienced) * 2 * run.config.settings.trials_per_area
    all_solved = np.flatnonzero(solved_trials(run) == n_trials)
    return int(all_solved[0]) if all_solved.size else -1


def _transition_outcomes(tests: list[TransitionTest]) -> dict[AgentClass, TransitionOutcome]:
    """What each class made of the tests, over all runs."""
    outcomes = {}
    for index, members in enumerate(CLASSES):
        own = [(each.action[each.classes == index], each.object[each.classes == index]) for each in tests]
        passed = [(passes(action), passes(object_)) for action, object_ in own]
        action, object_ = (_mean_share([pair[test] for pair in own]) for test in (0, 1))
        outcomes[members] = TransitionOutcome(
            agents=sum(len(each) for each, _ in own),
            action_passed=sum(int(each.sum()) for each, _ in passed),
            object_passed=sum(int(each.sum()) for _, each in passed),
            action_success=action,
            object_success=object_,
            runs_action=sum(bool(each.any()) for each, _ in passed),
            runs_object=sum(bool(each.any()) for _, each in passed),
        )
    return outcomes


def _mean_share(successes: list[NDArray[np.int16]]) -> NDArray[np.float64]:
    """Mean share of successful trials of all agents in each transition, [X]."""
    agents = np.concatenate(successes) if successes else np.empty((0, 0))
    return agents.mean(axis=0) / TRIALS if len(agents) else np.full(agents.shape[1:], np.nan)


def _compared(conditions: Mapping[Condition, ConditionResults]) -> dict[str, list[NDArray[np.float64]]]:
    """One number per run, by what is compared; With-Indicate first."""
    ordered = [conditions[each] for each in Condition]
    shares = {
        f"sub-task {name}, category 10": [each.share_in_top(name) for each in ordered] for name in SUBTASKS
    }
    classes = {f"{kind} agents": [each.share_of_class(kind) for each in ordered] for kind in AgentClass}
    return {**shares, **classes}


def _per_generation(
    conditions: Mapping[Condition, ConditionResults], name: str
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """What the paper's kind of test takes: the same share, but of each late generation of all runs."""

    def shares(results: ConditionResults) -> NDArray[np.float64]:
        agents = results.successes.swapaxes(0, 1).reshape(len(results.generations), -1, N_INSTRUCTIONS)
        return np.array([_share(each, name, results.condition) for each in agents])

    return shares(conditions[Condition.WITH_INDICATE]), shares(conditions[Condition.WITH_IGNORE])


def _share(successes: NDArray[np.int16], name: str, condition: Condition) -> float:
    """Share of agents [A, 9] that count for one of the names of `_compared`."""
    for index, subtask in enumerate(SUBTASKS):
        if name == f"sub-task {subtask}, category 10":
            return float((categories(successes, condition)[:, index] == 10).mean())
    kind = next(each for each in AgentClass if name == f"{each} agents")
    return float(classify(successes, condition)[kind].mean())


def _stack(rows: list[NDArray[np.float64]]) -> NDArray[np.float64]:
    return np.stack(rows) if rows else np.empty((0, 0))
