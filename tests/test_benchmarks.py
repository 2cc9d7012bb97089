"""The comparison of inverse kinematics: what is promised of ours, and what is said of the others."""

import numpy as np
import pytest

from mujoco_port.film.gl import choose_back_end

choose_back_end()  # before mujoco is imported

from benchmarks import ik, ik_solvers  # noqa: E402
from models.robots import ROBOTS, get_robot  # noqa: E402
from mujoco_port.reach.kinematics import ArmKinematics  # noqa: E402


@pytest.mark.parametrize("name", ROBOTS)
@pytest.mark.parametrize("with_heading", [False, True])
def test_ours_is_within_a_nanometre_in_99_of_100_steps(name, with_heading):
    robot = get_robot(name)
    solver, kinematics = ik_solvers.Ours(robot, with_heading=with_heading), ArmKinematics(robot)
    ((_, figures),) = ik.compare([solver], kinematics, ik.trial_walks()[::9])
    assert len(figures.times) > 300
    assert np.percentile(figures.errors, 99) <= 1e-9
    assert figures.jump <= 0.15


def test_without_wishes_for_rotation_the_posture_is_another_and_the_place_the_same():
    robot = get_robot("icub")
    kinematics, (alpha, beta) = ArmKinematics(robot), ik.workspace_walk()
    target = ik.hand_targets(robot.plane, alpha[:1], beta[:1])[0]
    heading = float(ik.hand_headings(robot.plane, alpha[:1], beta[:1])[0])
    start = np.clip(kinematics.rest, kinematics.lower, kinematics.upper)
    free, bound = (
        ik_solvers.settled(ik_solvers.Ours(robot, with_heading=each), start, target, heading)
        for each in (False, True)
    )
    assert np.abs(free - bound).max() > 0.01
    for angles in (free, bound):
        np.testing.assert_allclose(kinematics.forward(angles).position, target, atol=1e-9)


def test_a_solver_that_is_not_installed_is_named_with_the_command(monkeypatch):
    monkeypatch.setattr(ik, "installed", list)
    expected = "mink: not compared with, as it is not installed; run: pip install 'wordarm[benchmark]'"
    assert ik.remark("mink") == expected


@pytest.mark.parametrize("name", ik_solvers.installed())
def test_the_others_arrive_with_the_settings_they_are_given(name):
    robot = get_robot("icub")
    solver = ik_solvers.library(name, robot, ik_solvers.TUNED[name])
    ((_, figures),) = ik.compare([solver], ArmKinematics(robot), ik.trial_walks()[:1])
    assert np.percentile(figures.errors, 99) <= 2e-6
