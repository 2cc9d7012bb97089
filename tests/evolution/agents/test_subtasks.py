"""Categories of Table II and classes of agents (spec section 10)."""

import numpy as np
import pytest

from arm2d import NON_EXPERIENCED, Condition, Task
from evolution.agents.subtasks import (
    AgentClass,
    carries_out,
    categories,
    classify,
    count_table,
    obeys_experienced,
)
from evolution.results import published

CONDITION = Condition.WITH_INDICATE
TOUCH_GREEN, MOVE_BLUE = (CONDITION.instructions.index(each) for each in NON_EXPERIENCED)


def agent(others=80, touch_green=80, move_blue=80):
    """Successes [1, 9] of one agent."""
    successes = np.full((1, 9), others)
    successes[0, [TOUCH_GREEN, MOVE_BLUE]] = touch_green, move_blue
    return successes


@pytest.mark.parametrize(
    ("lowest", "category"), [(0, 0), (1, 1), (8, 1), (9, 2), (72, 9), (73, 10), (80, 10)]
)
def test_category_follows_the_lowest_score_in_steps_of_eight(lowest, category):
    assert categories(agent(others=lowest), CONDITION).tolist() == [[category] * 4]


def test_sub_tasks_add_the_never_met_instructions_one_by_one():
    found = categories(agent(others=80, touch_green=40, move_blue=8), CONDITION)
    assert found.tolist() == [[10, 1, 5, 1]]


def test_every_agent_is_counted_once_in_each_sub_task():
    successes = np.random.default_rng(0).integers(0, 81, (500, 9))
    assert count_table(categories(successes, CONDITION)).sum(axis=0).tolist() == [500] * 4


@pytest.mark.parametrize(
    ("successes", "expected"),
    [
        (agent(), AgentClass.FULL),
        (agent(61, 61, 61), AgentClass.FULL),
        (agent(80, 7, 61), AgentClass.PARTIAL),
        (agent(80, 61, 7), AgentClass.PARTIAL),
        (agent(80, 7, 7), AgentClass.NONE),
        (agent(80, 8, 61), None),
        (agent(80, 60, 7), None),
        (agent(60, 80, 80), None),
    ],
)
def test_classes_are_those_above_three_quarters_and_below_a_tenth(successes, expected):
    found = [kind for kind, members in classify(successes, CONDITION).items() if members[0]]
    assert found == ([expected] if expected else [])


def test_classes_are_of_the_papers_two_conditions_which_may_be_named():
    named = classify(agent(), "with-indicate")
    assert [kind for kind, members in named.items() if members[0]] == [AgentClass.FULL]
    other = Task(held_out=("indicate red", "move green"))  # both of which this agent fails
    successes = np.full((1, 9), 80)
    successes[0, [other.instructions.index(word) for word in other.held_out]] = 0
    with pytest.raises(ValueError, match="this classification is made for the paper's two conditions"):
        classify(successes, other)
    assert obeys_experienced(successes, other).all()
    assert not carries_out(successes, other, other.held_out[0]).any()


@pytest.mark.parametrize(
    ("successes", "sentence"),
    [
        (agent() / 80, r"whole numbers \[A, 9\] of 80 trials, .* but had float64 \[1, 9\]"),
        (agent(), None),
        (agent() > 60, r"whole numbers \[A, 9\] of 80 trials, .* but had bool \[1, 9\]"),
        (agent()[0], r"of 80 trials, .* but had int64 \[9\]"),
        (np.zeros((1, 9, 2), int), r"of 80 trials, .* but had int64 \[1, 9, 2\]"),
        (np.zeros((1, 12), int), r"of 80 trials, .* but had int64 \[1, 12\]"),
        (agent(others=81), "must be of 80 trials, so 0 to 80, but had 81"),
        (agent(move_blue=-1), "must be of 80 trials, so 0 to 80, but had -1"),
    ],
)
def test_only_counts_of_eighty_trials_are_taken(successes, sentence):
    asked = (
        classify,
        categories,
        obeys_experienced,
        lambda found, condition: carries_out(found, condition, NON_EXPERIENCED[0]),
    )
    for ask in asked:
        if sentence is None:
            ask(successes, CONDITION)
            continue
        with pytest.raises(ValueError, match=sentence):
            ask(successes, CONDITION)


@pytest.mark.parametrize("condition", Condition)
def test_published_table_counts_all_agents_in_every_sub_task(condition):
    assert published.TABLE_II[condition].sum(axis=0).tolist() == [published.AGENTS] * 4
