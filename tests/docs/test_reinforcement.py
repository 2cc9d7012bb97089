"""What the page on reinforcement learning says of the curves is so."""

import numpy as np
import pytest

from arm2d import Condition
from evolution.results.learning import TRIALS, read_curves
from tests.docs.pages import DOCS

PAGE = (DOCS / "how-to" / "reinforcement-learning.md").read_text(encoding="utf-8")
CURVES = read_curves(DOCS / "results" / "learning" / "curves.csv")


def table(first):
    """The cells of the table whose first row begins with these words, row by row."""
    lines = PAGE[PAGE.index(f"| {first}") :].split("\n\n")[0].splitlines()
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in lines if "---" not in line]


def test_the_last_tests_are_those_of_the_curves():
    head, *rows = table("tested")
    condition = Condition.WITH_INDICATE
    never_met = {word: ", never met" * (word in condition.held_out) for word in condition.instructions}
    assert head[1:] == [f"{word}{remark}" for word, remark in never_met.items()]
    for curve, row in zip(CURVES, rows, strict=True):
        assert row[0] == f"{curve.learner}, seed {curve.seed}"
        assert [int(cell) for cell in row[1:]] == curve.successes[-1].tolist()


def test_what_it_took_is_what_was_measured():
    _, *rows = table("learner")
    for curve, row in zip(CURVES, rows, strict=True):
        assert row[0] == f"{curve.learner}, seed {curve.seed}"
        millions = float(row[1].removesuffix(" million").replace(",", ""))
        assert millions == pytest.approx(curve.steps[-1] / 1e6, rel=0.01)
        assert int(row[2].split()[0]) == round(curve.cpu[-1])
        for cell, share in ((row[3], 0.5), (row[4], 0.9)):
            arrived = np.flatnonzero(curve.experienced >= share)
            due = f"{curve.cpu[arrived[0]]:.0f} s" if len(arrived) else "not"
            assert cell == due
        assert row[5] == f"{100 * curve.experienced[-1]:.0f} %"


def test_every_learner_was_tested_in_80_trials_of_nine_instructions():
    for curve in CURVES:
        assert curve.successes.shape == (len(curve), 9)
        assert 0 <= curve.successes.min() <= curve.successes.max() <= TRIALS
        assert (np.diff(curve.steps) > 0).all()
        assert (np.diff(curve.cpu) >= 0).all()
