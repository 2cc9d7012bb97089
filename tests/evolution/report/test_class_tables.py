"""Behaviour by class, read back from its tables; experienced and never-met instructions differ."""

import csv

import numpy as np
import pytest

from arm2d import Condition
from evolution.agents.classes import Sampling
from evolution.agents.subtasks import AgentClass
from evolution.report.classes import class_run_table, class_table
from evolution.results.classes import ClassBehaviour

INDICATE = Condition.WITH_INDICATE
KNOWN = np.array([word in INDICATE.experienced for word in INDICATE.instructions])


@pytest.fixture(scope="module")
def behaviour():
    """Three runs that carry out 10, 20 and 60 % of what they met, and a tenth as much of the rest."""
    shares = np.array([0.1, 0.2, 0.6])
    intact = shares[:, np.newaxis] * np.where(KNOWN, 1.0, 0.1)
    lesioned = np.repeat(intact[:, np.newaxis] / 2, 8, axis=1)
    windows = np.arange(36.0).reshape(3, 3, 4) / 100
    counts = np.array([5, 7, 9]), np.array([2, 3, 4])
    return ClassBehaviour(
        AgentClass.PARTIAL,
        INDICATE,
        np.array([4, 8, 9]),
        *counts,
        intact,
        lesioned,
        windows,
        np.empty(0),
        None,
    )


def rows_of(table):
    return list(csv.DictReader(table.to_csv().splitlines()))


def test_a_measure_is_told_by_its_mean_its_interval_and_its_range(behaviour):
    rows = {row["measure"]: row for row in rows_of(class_table([behaviour], Sampling(per_area=3)))}
    for of_what, factor in (("experienced", 1.0), ("never met", 0.1)):
        row = rows[f"success, {of_what}, intact"]
        low, mean, high = (float(row[name]) for name in ("95 % low", "mean over runs", "95 % high"))
        assert low < mean < high
        assert mean == pytest.approx(0.3 * factor, abs=1e-4)
        assert float(row["lowest run"]) == pytest.approx(0.1 * factor, abs=1e-4)
        assert float(row["highest run"]) == pytest.approx(0.6 * factor, abs=1e-4)
        assert (row["runs"], row["agents observed"], row["agents in the class"]) == ("3", "9", "21")
        assert row["trials each"] == "54"


def test_every_run_of_a_class_has_its_own_numbers(behaviour):
    rows = rows_of(class_run_table([behaviour]))
    assert [row["seed"] for row in rows] == ["4", "8", "9"]
    assert [row["agents observed"] for row in rows] == ["2", "3", "4"]
    shares = [float(row["share of variance, action, the second before first sight"]) for row in rows]
    assert shares == pytest.approx([0.01, 0.13, 0.25])
