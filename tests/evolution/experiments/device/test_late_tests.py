"""The tests of late agents on a device, of agents that have something to show."""

import numpy as np

from arm2d import Condition, Readings
from evolution.agents.transitions import action_transitions, object_transitions, transition_successes
from evolution.runs.meta import versions


def test_transitions_succeed_as_often_as_on_the_processor(laboratory, evolved):
    for transitions in (action_transitions, object_transitions):
        asked = transitions(Condition.WITH_INDICATE)[::4]
        here, there = (
            transition_successes(evolved[10:18], asked, Readings(), np.random.default_rng(1), *where)
            for where in ((), (laboratory.run_trials,))
        )
        assert here.max() > 40
        np.testing.assert_array_equal(here, there)


def test_a_run_that_a_device_took_part_in_says_with_which_package(laboratory):
    assert versions()["warp-lang"].startswith("1.")
