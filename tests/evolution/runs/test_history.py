"""Histories: compared by what they hold, and taken apart."""

from dataclasses import replace

import numpy as np
import pytest

from evolution.runs.folder import RunFolder
from evolution.runs.recorded import recorded_history


@pytest.fixture(scope="module")
def history(finished_run):
    return recorded_history(RunFolder.open(finished_run))


def test_histories_are_equal_if_all_their_numbers_are(history, finished_run):
    assert history == recorded_history(RunFolder.open(finished_run))
    fitness = history.fitness.copy()
    fitness[3, 2] += 1e-9
    assert history != replace(history, fitness=fitness)
    assert history != history[:-1]
    assert history != "history"


def test_what_is_no_number_equals_itself(history):
    best = np.append(history.best[:-1], np.nan)
    assert replace(history, best=best) == replace(history, best=best.copy())


def test_a_number_takes_one_generation_as_a_history_of_one(history):
    assert history[-1] == history[229] == history[229:]
    assert history[np.int64(3)].generations.tolist() == [3]
    assert [each.generations[0] for each in history] == list(range(230))
    with pytest.raises(IndexError, match="there is no generation 230 in a history of 230, counted from 0"):
        history[230]
