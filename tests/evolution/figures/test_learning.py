import numpy as np

from evolution.figures.learning import SOONEST, learning_figure
from tests.evolution.figures.gallery import curves


def test_every_panel_shows_every_curve_over_its_own_time():
    found = curves()
    panels = learning_figure(found).axes
    assert [axes.get_title(loc="left") for axes in panels] == [
        "the seven, on average",
        "TOUCH Green, never met",
        "MOVE Blue, never met",
    ]
    for row, axes in enumerate(panels):
        for curve, line in zip(found, axes.lines, strict=True):
            due = [curve.experienced, *curve.held_out.T][row]
            np.testing.assert_array_equal(line.get_ydata(), due)
            np.testing.assert_array_equal(line.get_xdata(), np.maximum(curve.cpu, SOONEST))


def test_seeds_of_a_learner_share_a_colour_and_an_entry_in_the_legend():
    figure = learning_figure(curves())
    colours = [line.get_color() for line in figure.axes[0].lines]
    assert colours[0] == colours[1] != colours[2]
    (legend,) = figure.legends
    assert [text.get_text() for text in legend.get_texts()] == ["evolution", "PPO, LSTM"]
