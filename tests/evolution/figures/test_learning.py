import numpy as np
import pytest
from matplotlib.colors import to_hex

from arm2d import Condition
from arm2d.drawing import OBJECT_COLOURS
from evolution.figures.learning import SOONEST, learning_figure
from evolution.results.learning import LearningCurve
from tests.evolution.figures.gallery import curves


def test_every_curve_is_drawn_over_its_own_time():
    found = curves()
    over_time, _ = learning_figure(found).axes
    assert over_time.get_title(loc="left") == "the seven, on average"
    for curve, line in zip(found, over_time.lines, strict=True):
        np.testing.assert_array_equal(line.get_ydata(), curve.experienced)
        np.testing.assert_array_equal(line.get_xdata(), np.maximum(curve.cpu, SOONEST))


def test_the_last_test_of_what_was_never_met_stands_in_the_row_of_its_learner():
    found = curves()
    _, in_the_end = learning_figure(found).axes
    names = [label.get_text() for label in in_the_end.get_yticklabels()]
    assert names == ["evolution, 1", "evolution, 2", "PPO, LSTM, 1"]
    legend = in_the_end.get_legend()
    told = [text.get_text() for text in legend.get_texts()]
    assert told == ["TOUCH Green", "MOVE Blue"]
    marks = iter(in_the_end.lines)
    for row, curve in enumerate(found):
        for instruction, share in zip(curve.condition.held_out, curve.held_out[-1], strict=True):
            mark = next(marks)
            assert mark.get_xdata() == pytest.approx(share)
            assert round(float(mark.get_ydata()[0])) == row
            colour = OBJECT_COLOURS[instruction.object]
            assert to_hex(mark.get_color()) == to_hex(colour)
            assert to_hex(legend.legend_handles[told.index(str(instruction))].get_color()) == to_hex(colour)
    assert next(marks, None) is None
    assert len({float(share) for curve in found for share in curve.held_out[-1]}) > 1


def test_tests_at_a_time_that_the_axis_cannot_tell_apart_are_one_point():
    curve = LearningCurve.empty("evolution", Condition.WITH_INDICATE, 1)
    for test, cpu in enumerate((0.0, 0.05, SOONEST, 1.0, 2.0)):
        curve = curve.longer(1000 * test, cpu, [16 * test] * 9)
    (line,) = learning_figure([curve]).axes[0].lines
    np.testing.assert_array_equal(line.get_xdata(), [SOONEST, 1.0, 2.0])
    np.testing.assert_allclose(line.get_ydata(), [0.4, 0.6, 0.8])


def test_seeds_of_a_learner_share_a_colour_and_an_entry_in_the_legend():
    figure = learning_figure(curves())
    colours = [line.get_color() for line in figure.axes[0].lines]
    assert colours[0] == colours[1] != colours[2]
    (legend,) = figure.legends
    assert [text.get_text() for text in legend.get_texts()] == ["evolution", "PPO, LSTM"]
    labels = [label.get_color() for label in figure.axes[1].get_yticklabels()]
    assert labels == colours
