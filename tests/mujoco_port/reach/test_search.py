"""The search for constants: it repeats, never ends worse than it began, and prints what the record holds."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import models.robots
from mujoco_port.reach import wishes
from mujoco_port.reach.search import search, search_with_progress, varied, written
from mujoco_port.reach.wishes import Cost, Wishes, walks


@pytest.fixture
def few_walks(monkeypatch):
    """Two short walks in place of nearly eight hundred steps."""
    short = [(alpha[::4], beta[::4]) for alpha, beta in walks()[1:3]]
    monkeypatch.setattr(wishes, "walks", lambda: short)


def test_origin_of_the_search_is_the_record_itself(robot, kinematics):
    n_coordinates = 3 + 2 * len(robot.joints) + 2
    same = varied(robot, kinematics, np.zeros(n_coordinates))
    np.testing.assert_allclose(same.base_position, robot.base_position, rtol=1e-15)
    within = np.clip(robot.posture.rest, kinematics.lower, kinematics.upper)  # its digits may end beyond
    np.testing.assert_allclose(same.posture.rest, within, rtol=1e-15)
    np.testing.assert_allclose(same.posture.weights, robot.posture.weights, rtol=1e-15)


def test_rest_stays_within_the_joint_limits(robot, kinematics):
    n = len(robot.joints)
    far = np.zeros(3 + 2 * n + 2)
    far[3 : 3 + n] = 100.0
    np.testing.assert_array_equal(varied(robot, kinematics, far).posture.rest, kinematics.upper)


def test_search_repeats_and_is_never_worse_than_its_start(robot, few_walks):
    costs: list[float] = []

    def tell(done, cost, best):
        costs.append(cost.total)

    worse = replace(robot, posture=replace(robot.posture, heading_weight=0.01, level_weight=0.01))
    first = search(worse, evaluations=20, seed=3, tell=tell)
    again = search(worse, evaluations=20, seed=3, tell=lambda *_: None)
    assert first == again
    assert (np.diff(costs) <= 0.0).all()
    assert costs[-1] < costs[0]


def test_steps_of_the_walks_are_those_of_the_2d_world():
    for alpha, beta in walks():
        assert np.abs(np.diff(alpha)).max() <= 2.9 + 1e-9
        assert np.abs(np.diff(beta)).max() <= 2.9 + 1e-9
        assert (alpha.min(), beta.min()) >= (-30.0, 0.0)
        assert (alpha.max(), beta.max()) <= (210.0, 90.0)


def test_place_out_of_reach_costs_more_than_anything_soft(robot, few_walks):
    here = Wishes(robot).cost(robot)
    far = replace(robot, base_position=(0.0, -2.0, 0.0))
    assert here.reach == 0.0
    assert Wishes(robot).cost(far).total > 10.0 * here.total


def test_cost_is_the_sum_of_its_wishes():
    assert Cost(1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0).total == 36.0


def test_record_is_printed_as_it_stands_in_its_file(robot):
    source = Path(models.robots.__file__).read_text()
    for line in written(robot).splitlines():
        assert line in source


def test_a_search_that_is_interrupted_gives_the_best_record_so_far(robot, monkeypatch):
    """Each record is better than the one before, until Ctrl-C is pressed in the third population."""
    asked = []

    def cost(self, candidate):
        if len(asked) == 35:
            raise KeyboardInterrupt
        asked.append(candidate)
        return Cost(100.0 - len(asked))

    monkeypatch.setattr(Wishes, "cost", cost)
    found = search_with_progress(robot, evaluations=10_000, seed=1)
    population = 4 + int(3 * np.log(3 + 2 * len(robot.joints) + 2))
    assert found == asked[2 * population]  # the record itself was the first


def test_the_record_costs_what_the_search_left_it_at(robot, few_walks):
    """On the few walks; whoever changes one of its numbers by hand is told."""
    assert Wishes(robot).cost(robot).total == pytest.approx(0.85687, rel=1e-4)


def test_negative_numbers_are_refused(robot):
    with pytest.raises(ValueError, match="give numbers from 0 on"):
        search(robot, evaluations=-1, seed=0, tell=lambda *_: None)
