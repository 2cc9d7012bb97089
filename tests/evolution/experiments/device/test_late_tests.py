"""The tests of late agents on a device, of agents that have something to show."""

import numpy as np
import pytest

from arm2d import Condition, Task
from arm2d.device.errors import DeviceTaskError
from evolution.agents.transitions import Candidates, both_tests
from evolution.experiments.device.late_tests import both_tests_on, own_trials
from evolution.runs.meta import versions
from evolution.search.config import RunConfig


def test_transitions_succeed_as_often_as_on_the_processor(laboratory, evolved):
    config = RunConfig(Condition.WITH_INDICATE, seed=3)
    ranks = [[0, 2], [], [4]]
    candidates = [
        Candidates(10 + number, evolved[10 + 5 * number : 15 + 5 * number], np.array(own, np.int64))
        for number, own in enumerate(ranks)
    ]
    here, there = both_tests(config, candidates), both_tests_on(laboratory, config, candidates)
    assert max(action.max(initial=0) for action, _ in here) > 40
    for one, other in zip(here, there, strict=True):
        for test in (0, 1):
            np.testing.assert_array_equal(one[test], other[test])


def test_late_agents_of_another_task_are_not_given_the_paper_s_trials(laboratory, evolved):
    config = RunConfig(Task(places="dealt"), seed=3)
    with pytest.raises(DeviceTaskError, match="not with-indicate"):
        laboratory.success([own_trials(config, 30, evolved[:5])])


def test_a_run_that_a_device_took_part_in_says_with_which_package(laboratory):
    assert versions()["warp-lang"].startswith("1.")
