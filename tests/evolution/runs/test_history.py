"""Records of arrays: compared by what they hold, and histories taken apart."""

import inspect
from dataclasses import fields, is_dataclass, replace
from importlib import import_module
from pathlib import Path

import numpy as np
import pytest

import evolution
from evolution.runs.folder import RunFolder
from evolution.runs.history import alike
from evolution.runs.recorded import recorded_history

ROOT = Path(evolution.__file__).parent


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


def records():
    """Every class of these rooms that has an array among its fields."""
    for room in ("agents", "runs", "results"):
        for file in sorted((ROOT / room).glob("*.py")):
            module = import_module(f"evolution.{room}.{file.stem}")
            own = [
                each for each in vars(module).values() if getattr(each, "__module__", "") == module.__name__
            ]
            for kind in filter(is_dataclass, filter(inspect.isclass, own)):
                if any(str(each.type).startswith("NDArray") for each in fields(kind)):
                    yield kind


def test_every_record_of_arrays_can_be_compared():
    found = list(records())
    assert len(found) > 15
    assert [kind.__name__ for kind in found if vars(kind)["__eq__"] is not alike] == []


def test_a_number_takes_one_generation_as_a_history_of_one(history):
    assert history[-1] == history[229] == history[229:]
    assert history[np.int64(3)].generations.tolist() == [3]
    assert [each.generations[0] for each in history] == list(range(230))
    with pytest.raises(IndexError, match="there is no generation 230 in a history of 230, counted from 0"):
        history[230]
