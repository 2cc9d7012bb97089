"""The two conditions compared: what enters each test, by plain loops over agents that all differ."""

import numpy as np
import pytest
from scipy import stats

from arm2d import NON_EXPERIENCED, Condition
from evolution.agents.subtasks import AgentClass
from evolution.results.statistics import compare
from tests.evolution.made_up import both_conditions, condition_results, random_successes, results

MOVE_BLUE = next(word for word in NON_EXPERIENCED if "MOVE" in str(word))
TOUCH_GREEN = next(word for word in NON_EXPERIENCED if "TOUCH" in str(word))
ASKED = {"I": (), "II": (MOVE_BLUE,), "III": (TOUCH_GREEN,), "IV": (MOVE_BLUE, TOUCH_GREEN)}


def counts(agent, condition, name):
    """Whether an agent [9] counts for what is compared, in the words of the paper."""
    done = dict(zip(condition.instructions, agent.tolist(), strict=True))
    known = [done[word] for word in condition.experienced]
    never_met = [done[word] for word in NON_EXPERIENCED]
    if name.startswith("sub-task"):
        asked = [*known, *(done[word] for word in ASKED[name.split()[1].rstrip(",")])]
        return min(asked) > 72
    full, none = all(n > 60 for n in never_met), all(n < 8 for n in never_met)
    partial = max(never_met) > 60 and min(never_met) < 8
    masters = all(n > 60 for n in known)
    return (
        masters
        and {
            f"{AgentClass.FULL} agents": full,
            f"{AgentClass.PARTIAL} agents": partial,
            f"{AgentClass.NONE} agents": none,
        }[name]
    )


@pytest.fixture(scope="module")
def experiment():
    return both_conditions()


def test_the_papers_kind_of_test_takes_a_share_of_every_late_generation_of_all_runs(experiment):
    assert len(experiment.published_tests) == 7
    for name, (statistic, p) in experiment.published_tests.items():
        shares = []
        for condition, found in experiment.conditions.items():
            n_runs, n_generations, n_ranks, _ = found.successes.shape
            shares.append([])
            for generation in range(n_generations):
                agents = [found.successes[r, generation, k] for r in range(n_runs) for k in range(n_ranks)]
                shares[-1].append(np.mean([counts(agent, condition, name) for agent in agents]))
        assert len(set(shares[0])) > 1
        expected = stats.ranksums(*shares)
        assert (statistic, p) == pytest.approx((expected.statistic, expected.pvalue), rel=1e-12), name


def test_the_sound_tests_take_a_share_of_the_agents_of_every_run(experiment):
    for name, comparison in experiment.comparisons.items():
        shares = [
            np.array(
                [np.mean([counts(agent, c, name) for agent in run.reshape(-1, 9)]) for run in found.successes]
            )
            for c, found in experiment.conditions.items()
        ]
        expected = compare(*shares, np.random.default_rng(0))
        assert comparison.means == pytest.approx(expected.means), name
        assert comparison.mann_whitney_p == pytest.approx(expected.mann_whitney_p), name
        assert comparison.permutation_p == pytest.approx(expected.permutation_p), name
        assert comparison.cliffs_delta == pytest.approx(expected.cliffs_delta), name


def test_one_condition_alone_is_not_compared():
    condition = Condition.WITH_IGNORE
    alone = results({condition: condition_results(condition, random_successes(condition))})
    assert (alone.comparisons, alone.published_tests) == ({}, {})
