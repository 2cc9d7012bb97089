"""Results that no run gave, all of whose numbers differ: what is swapped on its way to a page shows."""

from pathlib import Path

import numpy as np

from arm2d import Condition
from evolution.agents.subtasks import AgentClass, categories, classify, count_table
from evolution.experiments.experiment import Experiment
from evolution.results.comparisons import compare_conditions
from evolution.results.generalisers import Generalisers, spell_lengths
from evolution.results.records import ConditionResults, Results, TransitionOutcome
from evolution.runs.folder import RunFolder
from evolution.search.config import RunConfig

HOME = Path("nowhere")


def random_successes(condition, n_runs=3, n_generations=4, seed=0):
    """Successes [R, L, 5, 9] of 80 with agents in many categories and in every class."""
    rng = np.random.default_rng([seed, *condition.encode()])
    never_met = [instruction not in condition.experienced for instruction in condition.instructions]
    chances = rng.choice(
        [0.02, 0.5, 0.97, 0.99], size=(n_runs, n_generations, 5, 9), p=[0.05, 0.05, 0.2, 0.7]
    )
    chances[..., never_met] = rng.choice([0.01, 0.98], size=(n_runs, n_generations, 5, 2))
    return rng.binomial(80, chances).astype(np.int16)


def outcome(first, n_transitions=14):
    """A class's outcome in the transition tests; all of its numbers differ."""
    shares = (first + np.arange(2 * n_transitions)) / 100
    return TransitionOutcome(
        agents=10 * first,
        action_passed=first + 1,
        object_passed=first + 2,
        action_success=shares[:n_transitions],
        object_success=shares[n_transitions:],
        runs_action=first % 7 + 3,
        runs_object=first % 7 + 2,
    )


def condition_results(condition, successes, transitions=None, best=None, first_solved=None):
    """The results of runs with these post-evaluations; classes and Table II follow from them."""
    n_runs, n_generations = successes.shape[:2]
    seeds = np.arange(1, n_runs + 1)
    generations = np.arange(100, 100 + n_generations)
    tables = np.array([count_table(categories(own.reshape(-1, 9), condition)) for own in successes])
    classes = [classify(own.reshape(-1, 9), condition) for own in successes]
    best = np.linspace(1.0, 2.57, 2000 * n_runs).reshape(n_runs, -1) if best is None else best
    return ConditionResults(
        condition=condition,
        runs=tuple(
            RunFolder(HOME / condition / f"seed-{s:04d}", RunConfig(condition, int(s))) for s in seeds
        ),
        seeds=seeds,
        best=best,
        plateau=best[:, -1],
        first_solved=np.arange(n_runs) * 1000 - 1 if first_solved is None else first_solved,
        genotypes=1100 + seeds,
        longest_stay=1200 + seeds,
        generations=generations,
        successes=successes,
        counts=tables.sum(axis=0),
        counts_per_run=tables,
        members={kind: np.array([own[kind].sum() for own in classes]) for kind in AgentClass},
        generalisers=tuple(generalisers(own[AgentClass.FULL].reshape(-1, 5), generations) for own in classes),
        transitions=transitions or {kind: outcome(11 + 31 * i) for i, kind in enumerate(AgentClass)},
        missing=(),
    )


def generalisers(members, generations):
    """Fully compositional agents [L, 5] and two genotypes of theirs; no other number equals their stays."""
    rows, ranks = np.nonzero(members)
    n = min(2, len(rows))
    return Generalisers(
        counts=members.sum(axis=1),
        generations=generations[rows],
        ranks=ranks,
        spells=spell_lengths(members.any(axis=1)),
        first=generations[rows[:n]],
        stays=1301 + np.arange(n),
        verdicts=1401 + np.arange(n),
        longest_line=1501,
    )


def results(found):
    """An experiment of these conditions, compared."""
    experiment = Experiment(HOME, {condition: own.runs for condition, own in found.items()})
    return Results(experiment, found, *compare_conditions(found))


def both_conditions(**options):
    """An experiment of three made-up runs of either condition."""
    return results({c: condition_results(c, random_successes(c), **options) for c in Condition})
