"""Doing something now and then, by a clock that the test moves."""

import pytest

from evolution.runs import intervals
from evolution.runs.intervals import at_intervals


class Clock:
    """Shows what it is told to."""

    def __init__(self):
        self.now = 100.0

    def monotonic(self):
        return self.now


@pytest.fixture
def clock(monkeypatch):
    clock = Clock()
    monkeypatch.setattr(intervals, "time", clock)
    return clock


def times_of_calls(clock, lasting, **how):
    """When something that lasts so long [s] is done, asked every second for a minute."""
    begun = []

    def act():
        begun.append(clock.now - 100.0)
        clock.now += lasting

    maybe = at_intervals(10.0, act, **how)
    while clock.now < 160.0:
        maybe()
        clock.now += 1.0
    return begun


def test_the_first_call_acts_and_then_one_every_so_often(clock):
    assert times_of_calls(clock, 0.0) == [0.0, 10.0, 20.0, 30.0, 40.0, 50.0]


def test_the_interval_runs_from_the_end_of_one_call_to_the_next(clock):
    assert times_of_calls(clock, 5.0) == [0.0, 15.0, 30.0, 45.0]


def test_what_takes_long_is_done_less_often(clock):
    """A fifth of the time for something that lasts 5 s: 25 s of rest after it."""
    assert times_of_calls(clock, 5.0, largest_share=0.2) == [0.0, 30.0]


def test_arguments_are_handed_on(clock):
    heard = []
    at_intervals(1.0, lambda *given, **named: heard.append((given, named)))(1, 2, three=3)
    assert heard == [((1, 2), {"three": 3})]
