"""A session with an evolved agent, and starts as anybody draws them."""

import numpy as np
import pytest

from arm2d import Condition, Readings, draw_trials
from mujoco_port.live.actor import Actor
from mujoco_port.live.session import Session
from mujoco_port.live.trial import Start


@pytest.fixture(scope="session")
def actor(evolved_agent):
    return Actor("an evolved agent", evolved_agent, Readings(), Condition.WITH_INDICATE.instructions)


@pytest.fixture(scope="session")
def draw_trial():
    """A batch of one trial from an area, whatever is asked in it."""

    def draw(area, seed):
        trials = draw_trials("touch green", 1, Readings(), np.random.default_rng(seed))
        return trials[("right", "left").index(area)]

    return draw


@pytest.fixture(scope="session")
def draw_start(draw_trial):
    def draw(area, seed):
        trial = draw_trial(area, seed)
        return Start(float(trial.alpha[0]), trial.discs[0])

    return draw


@pytest.fixture
def session(lab, actor, draw_start):
    return Session(lab, actor, draw_start)
