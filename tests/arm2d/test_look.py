"""Pictures look the same whatever a user's matplotlibrc says."""

import matplotlib as mpl
import numpy as np
import pytest

from arm2d import Readings, draw_trials, record_trial
from arm2d.look import look
from arm2d.video import Panel

STRANGE = {"font.size": 30.0, "axes.facecolor": "red", "lines.linewidth": 9.0, "text.usetex": True}


@pytest.fixture(scope="module")
def record():
    readings = Readings()
    (trial, *_) = draw_trials(["touch green"], 1, readings, np.random.default_rng(4))
    return record_trial(np.full(84, 0.4), trial, readings)


def test_a_style_is_in_force_only_while_it_is_asked_for():
    with mpl.rc_context(STRANGE):
        with look({"font.size": 7.0}):
            assert mpl.rcParams["font.size"] == 7.0
            assert mpl.rcParams["axes.facecolor"] == mpl.rcParamsDefault["axes.facecolor"]
            assert not mpl.rcParams["text.usetex"]
        assert mpl.rcParams["font.size"] == STRANGE["font.size"]


def test_a_films_frames_are_the_same_under_any_style(record):
    plain = Panel(record, 240, 180, note="a note").frame(2.5)
    with mpl.rc_context(STRANGE):
        assert np.array_equal(Panel(record, 240, 180, note="a note").frame(2.5), plain)
