"""Behaviour by class, read back from bars, dots and labels; all numbers are made up and differ."""

import numpy as np
import pytest
from matplotlib.colors import to_hex
from matplotlib.figure import Figure

from arm2d import Condition
from evolution.agents.classes import PARTS
from evolution.agents.lesions import LESIONS
from evolution.agents.subtasks import AgentClass
from evolution.agents.variance import WINDOWS
from evolution.figures.classes import SHORT, SHOWN_WINDOWS, classes_figure, draw_shares, draw_success
from evolution.figures.neurons import SHARE_LABELS
from evolution.results.classes import ClassBehaviour
from evolution.results.wording import TITLES


def class_behaviour(kind, condition, n_runs, seed):
    rng = np.random.default_rng([seed, list(AgentClass).index(kind)])
    return ClassBehaviour(
        kind,
        condition,
        np.arange(n_runs) + 3,
        rng.integers(20, 90, n_runs),
        rng.integers(1, 20, n_runs),
        rng.random((n_runs, 9)),
        rng.random((n_runs, 8, 9)),
        rng.dirichlet([1, 2, 3, 4], (n_runs, 3)),
        np.empty(0),
        None,
    )


@pytest.fixture(scope="module")
def behaviours():
    """Of both conditions; nobody is fully compositional in the second."""
    return {
        condition: {
            kind: class_behaviour(kind, condition, (3, 1, 2)[i] * (i > 0 or place == 0), place)
            for i, kind in enumerate(AgentClass)
        }
        for place, condition in enumerate(Condition)
    }


def legends(figure):
    """Colours by what the legends call them."""
    named = {}
    for legend in figure.legends:
        for text, handle in zip(legend.get_texts(), legend.legend_handles, strict=True):
            colour = handle.get_facecolor() if hasattr(handle, "get_facecolor") else handle.get_color()
            named[text.get_text()] = to_hex(colour)
    return named


@pytest.fixture(scope="module")
def colours(behaviours):
    return legends(classes_figure(behaviours))


def test_the_conditions_stand_beneath_each_other(behaviours):
    figure = classes_figure(behaviours)
    titles = [axes.get_title(loc="left") for axes in figure.axes]
    first, second = (TITLES[condition] for condition in Condition)
    beside = "what is left without a word"
    assert titles == [
        f"{first}: what the neurons follow",
        beside,
        f"{second}: what the neurons follow",
        beside,
    ]


def test_bars_are_the_mean_shares_of_their_class_and_window_in_the_colours_of_the_words(behaviours, colours):
    for classes in behaviours.values():
        axes = Figure().add_subplot()
        draw_shares(axes, list(classes.values()))
        places, labels = np.array(axes.get_yticks()), [text.get_text() for text in axes.get_yticklabels()]
        heads = {
            text.get_position()[1] + 0.62: text.get_text()
            for text in axes.texts
            if text.get_text() in WINDOWS
        }
        for start, window in zip(sorted(heads), SHOWN_WINDOWS, strict=True):
            assert heads[start] == list(WINDOWS)[window]
            for row, behaviour in enumerate(classes.values()):
                place = start + row
                name, count = labels[np.abs(places - place).argmin()].split("\n")
                assert name == SHORT[behaviour.kind]
                runs, agents = len(behaviour.seeds), int(behaviour.agents.sum())
                bars = [bar for bar in axes.patches if abs(bar.get_y() + bar.get_height() / 2 - place) < 0.1]
                if not runs:
                    assert (count, bars) == ("none", [])
                    continue
                assert count == f"{agents} agents, {runs} run{'s' if runs > 1 else ''}"
                widths = {to_hex(bar.get_facecolor()): bar.get_width() for bar in bars}
                means = 100 * behaviour.windows[:, window].mean(axis=0)
                expected = {
                    colours[SHARE_LABELS[part]]: share for part, share in zip(PARTS, means, strict=True)
                }
                assert widths == pytest.approx(expected)
                ends = np.cumsum([bar.get_width() for bar in bars])
                assert [bar.get_x() for bar in bars] == pytest.approx([0.0, *ends[:-1]])


def test_dots_are_the_runs_and_their_mean_in_the_row_of_their_lesion(behaviours, colours):
    names = ["intact", *(f"{lesion.word} word {lesion.manner} {lesion.time}" for lesion in LESIONS)]
    for classes in behaviours.values():
        axes = Figure().add_subplot()
        draw_success(axes, list(classes.values()))
        rows = [text.get_text() for text in axes.get_yticklabels()]
        places = np.array(axes.get_yticks())
        assert rows == names
        drawn = set()
        for behaviour in classes.values():
            own = [line for line in axes.lines if to_hex(line.get_color()) == colours[str(behaviour.kind)]]
            large = [line for line in own if line.get_alpha() is None]
            small = [line for line in own if line.get_alpha() is not None]  # pale
            success = 100 * behaviour.success(known=True)
            if not len(success):
                assert own == []
                continue
            (mean,) = large
            assert np.asarray(mean.get_xdata()) == pytest.approx(success.mean(axis=0))
            offsets = np.asarray(mean.get_ydata()) - places
            assert np.abs(offsets).max() < 0.3
            assert offsets == pytest.approx(np.full(9, offsets[0]))
            drawn.add(round(offsets[0], 3))
            assert np.array([line.get_xdata() for line in small]) == pytest.approx(success)
            for line in small:
                assert np.asarray(line.get_ydata()) == pytest.approx(mean.get_ydata())
        assert len(drawn) == sum(len(each.seeds) > 0 for each in classes.values())
