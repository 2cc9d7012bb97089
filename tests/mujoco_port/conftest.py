"""What the tests of the port share: a back end that draws, a champion's trials, the robot's kinematics."""

import numpy as np
import pytest

from mujoco_port.film.gl import choose_back_end

choose_back_end()  # before any test imports mujoco

from arm2d import Condition, Readings, draw_trials, record_trial  # noqa: E402
from models.robots import get_robot  # noqa: E402
from mujoco_port.acting.lab import Lab  # noqa: E402
from mujoco_port.reach.kinematics import ArmKinematics  # noqa: E402


@pytest.fixture(scope="session")
def robot():
    return get_robot("icub")


@pytest.fixture(scope="session")
def kinematics(robot):
    return ArmKinematics(robot)


@pytest.fixture(scope="session")
def champion_records(evolved_agent):
    """A trial of each of the nine instructions from each start area, eighteen in all."""
    trials = draw_trials(Condition.WITH_INDICATE.instructions, 1, Readings(), np.random.default_rng(11))
    return [record_trial(evolved_agent, trials[t]) for t in range(len(trials))]


@pytest.fixture(scope="session")
def lab(robot):
    return Lab(robot)
