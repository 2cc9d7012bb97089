"""What an agent and its neurons do, read back from what is drawn; all numbers are made up and differ."""

from functools import partial

import numpy as np
import pytest
from matplotlib.colors import to_hex
from matplotlib.figure import Figure

from arm2d import NON_EXPERIENCED, Condition, ObjectWord, Readings
from arm2d.constants import DT
from arm2d.drawing import INK, OBJECT_COLOURS, STYLE, look
from evolution.agents.behaviour import Behaviour
from evolution.agents.lesions import LESIONS, LesionScores
from evolution.agents.variance import VarianceShares, bin_times, events_of, mean_by_instruction
from evolution.figures.behaviour import draw_alpha, draw_beta, draw_lesions, trajectory_handles
from evolution.figures.neurons import (
    SHARE_LABELS,
    activity_figure,
    draw_variance,
    variance_figure,
)
from evolution.figures.page import SUCCESS_MAP
from evolution.figures.states import draw_cube, draw_paths

INDICATE = Condition.WITH_INDICATE
READINGS = Readings(sector_centres=(35.0, 90.0, 145.0), sector_half_width=7.0)
PER_AREA = 2


@pytest.fixture(scope="module")
def behaviour():
    """Two trials of each instruction from each area; in the second the target is not met."""
    rng = np.random.default_rng(21)
    n = 9 * 2 * PER_AREA
    steps = rng.integers(40, 250, n)
    rows = np.arange(251)

    def until_the_end(values):
        values[rows > steps[:, np.newaxis]] = np.nan
        return values

    met = np.arange(n) % PER_AREA == 0
    return Behaviour(
        INDICATE,
        np.repeat(np.arange(9), 2 * PER_AREA),
        np.tile(np.repeat([0, 1], PER_AREA), 9),
        rng.random(n) < 0.5,
        steps,
        until_the_end(rng.uniform(-30, 210, (n, 251))),
        until_the_end(rng.uniform(0, 90, (n, 251))),
        until_the_end(rng.random((n, 251, 3))),
        np.where(met, rng.integers(3, 15, n), -1),
        np.where(met, rng.integers(20, 35, n), -1),
    )


def marks(axes):
    """Place, shape and face of every mark."""
    drawn = [line for line in axes.lines if line.get_linestyle() == "None"]
    return {
        (*place, line.get_marker(), to_hex(line.get_markerfacecolor()))
        for line in drawn
        for place in line.get_xydata().tolist()
    }


def paths(axes):
    """What is drawn between gaps, with the line that it is a part of."""
    lines = [line for line in axes.lines if line.get_linestyle() != "None"]
    for line in lines:
        data = line.get_xydata()
        for path in np.split(data, np.flatnonzero(np.isnan(data[:, 0]))):
            yield path[np.isfinite(path[:, 0])], line


@pytest.mark.parametrize(
    ("draw", "name"), [(partial(draw_alpha, readings=READINGS), "alpha"), (draw_beta, "beta")]
)
def test_every_trial_is_a_line_whose_look_the_legend_explains(draw, name, behaviour):
    handles = {handle.get_label(): handle for handle in trajectory_handles()}
    failed = to_hex(handles["not carried out"].get_color())
    for instruction in INDICATE.instructions:
        axes = Figure().add_subplot()
        draw(axes, behaviour, instruction)
        angles, trials = getattr(behaviour, name), behaviour.of(instruction)
        drawn = {path[0, 1]: (path, line) for path, line in paths(axes)}
        assert drawn.keys() == set(angles[trials, 0])
        for trial in trials:
            path, line = drawn[angles[trial, 0]]
            n = behaviour.steps[trial] + 1
            np.testing.assert_array_equal(path[:, 1], angles[trial, :n])
            np.testing.assert_allclose(path[:, 0], DT * np.arange(n))
            own = OBJECT_COLOURS[instruction.object].lower()
            assert to_hex(line.get_color()) == (own if behaviour.success[trial] else failed)
            area = ("from the right", "from the left")[behaviour.areas[trial]]
            assert line._unscaled_dash_pattern == handles[area]._unscaled_dash_pattern
        expected = set()
        for label, first in (
            ("first sight of the target", behaviour.first_sight),
            ("first touch of the target", behaviour.first_touch),
        ):
            look = handles[label].get_marker(), to_hex(handles[label].get_markerfacecolor())
            for trial in trials:
                if (row := first[trial]) != -1:
                    expected.add((float(DT * row), float(angles[trial, row]), *look))
        assert len(expected) == 4
        assert marks(axes) == expected


def test_the_objects_sectors_lie_behind_the_lines_in_their_colours(behaviour):
    axes = Figure().add_subplot()
    draw_alpha(axes, behaviour, INDICATE.instructions[0], READINGS)
    colours = [to_hex(patch.get_facecolor()) for patch in axes.patches]
    assert colours == [colour.lower() for colour in OBJECT_COLOURS.values()]
    for patch, centre in zip(axes.patches, READINGS.sector_centres, strict=True):
        assert (patch.get_y(), patch.get_height()) == pytest.approx((centre - 7.0, 14.0))


def test_titles_tell_the_instruction_its_success_and_whether_it_was_met(behaviour):
    for instruction in INDICATE.instructions:
        with look(STYLE):  # which says where a title stands
            axes = Figure().add_subplot()
            draw_alpha(axes, behaviour, instruction, READINGS)
        share = 100 * behaviour.success[behaviour.of(instruction)].mean()
        never_met = ", never met" if instruction in NON_EXPERIENCED else ""
        assert axes.get_title(loc="left") == str(instruction)
        assert axes.get_title(loc="right") == f"{share:.0f} %{never_met}"


def test_lesions_stand_above_their_column_and_beside_their_instruction():
    rng = np.random.default_rng(22)
    scores = LesionScores(INDICATE, 10, rng.random((3, 9)), rng.random((3, 8, 9)))
    axes = Figure().add_subplot()
    draw_lesions(axes, scores)
    columns = {round(place, 6): label.get_text() for place, label in ticks(axes.xaxis)}
    rows = {round(place, 6): label.get_text() for place, label in ticks(axes.yaxis)}
    shown = {}
    for text in axes.texts:
        x, y = text.get_position()
        if text.get_text().isdigit():
            shown[columns[round(x, 6)], rows[round(y - 0.02, 6)]] = text.get_text()
    cells = {
        (round(each.get_x() - 0.02 + 0.5, 6), round(each.get_y() - 0.04 + 0.5, 6)): each
        for each in axes.patches
    }
    names = ["intact", *(f"{lesion.word} word\n{lesion.manner}\n{lesion.time}" for lesion in LESIONS)]
    table = np.concatenate([scores.intact[:, np.newaxis], scores.lesioned], axis=1).mean(axis=0)
    assert len(shown) == 81
    for column, name in enumerate(names):
        for row, instruction in enumerate(INDICATE.instructions):
            share = table[column, row]
            assert shown[name, str(instruction)] == f"{100 * share:.0f}"
            x = next(place for place, text in columns.items() if text == name)
            assert to_hex(cells[x, row + 0.5].get_facecolor()) == to_hex(SUCCESS_MAP(share))
    framed = {round(each.get_y() + 0.02) for each in axes.patches if not each.get_fill()}
    assert {INDICATE.instructions[row] for row in framed} == set(NON_EXPERIENCED)


def ticks(axis):
    return zip(axis.get_ticklocs(), axis.get_ticklabels(), strict=True)


def test_activity_is_drawn_by_neuron_and_event_in_colours_and_styles_of_the_words(behaviour):
    figure = activity_figure(behaviour, "agent")
    (legend,) = figure.legends
    handles = {
        text.get_text(): handle
        for text, handle in zip(legend.get_texts(), legend.legend_handles, strict=True)
    }
    panels = np.array(figure.axes).reshape(3, 3)
    for column, (event, rows) in enumerate(events_of(behaviour).items()):
        assert panels[0, column].get_title(loc="left") == event
        means = mean_by_instruction(behaviour, rows)
        for neuron in range(3):
            assert panels[neuron, 0].get_ylabel() == f"output of neuron {neuron + 1}"
            _, *lines = panels[neuron, column].lines
            for line, instruction, mean in zip(lines, INDICATE.instructions, means[..., neuron], strict=True):
                np.testing.assert_array_equal(line.get_ydata(), mean)
                np.testing.assert_array_equal(line.get_xdata(), bin_times())
                object_, action = (
                    handles[instruction.object.name.capitalize()],
                    handles[instruction.action.name],
                )
                assert to_hex(line.get_color()) == to_hex(object_.get_color())
                assert line.get_linestyle() == action.get_linestyle()


def test_shares_of_variance_are_stacked_in_the_colours_of_the_legend():
    time = bin_times()
    parts = np.random.default_rng(23).dirichlet([1, 2, 3, 4], len(time)).T
    parts[:, :5] = np.nan
    shares = VarianceShares(time, *parts, np.arange(3))
    figure = variance_figure({"an event": shares}, "agent")
    (legend,) = figure.legends
    colours = {
        text.get_text(): to_hex(handle.get_color())
        for text, handle in zip(legend.get_texts(), legend.legend_handles, strict=True)
    }
    axes = Figure().add_subplot()
    draw_variance(axes, shares)
    layers = {to_hex(layer.get_facecolor()[0]): layer for layer in axes.collections}
    at = 40
    below = 0.0
    for name, label in SHARE_LABELS.items():
        points = layers[colours[label]].get_paths()[0].vertices
        heights = points[np.isclose(points[:, 0], time[at])][:, 1]
        top = below + 100 * getattr(shares, name)[at]
        assert [heights.min(), heights.max()] == pytest.approx([below, top])
        below = top
    assert below == pytest.approx(100)
    assert axes.get_xlim() == (time[5], time[-1])


def test_paths_of_an_action_word_have_the_colours_of_its_objects_and_marks_at_events(behaviour):
    """They are drawn as means of two steps."""
    points = np.random.default_rng(24).random((len(behaviour), 251, 2))
    for trial, n_steps in enumerate(behaviour.steps):
        points[trial, n_steps + 1 :] = np.nan
    for action in range(3):
        axes = Figure().add_subplot()
        draw_paths(axes, behaviour, points, action)
        trials = np.flatnonzero(behaviour.actions == action)
        drawn = {path[0, 0]: (path, line) for path, line in paths(axes)}
        assert len(drawn) == len(trials) == 12
        expected = set()
        for trial in trials:
            means = [(points[trial, k] + points[trial, k + 1]) / 2 for k in range(behaviour.steps[trial])]
            path, line = drawn[means[0][0]]
            np.testing.assert_array_equal(path, means)
            colour = OBJECT_COLOURS[ObjectWord(behaviour.objects[trial])].lower()
            assert to_hex(line.get_color()) == colour
            events = {
                ("s", INK.lower()): 0,
                ("o", "#ffffff"): behaviour.first_sight[trial],
                ("D", colour): behaviour.first_touch[trial],
                ("X", colour): behaviour.steps[trial],
            }
            last = behaviour.steps[trial] - 1
            expected |= {
                (*means[min(row, last)].tolist(), *look) for look, row in events.items() if row != -1
            }
        assert marks(axes) == expected


def test_the_cube_has_twelve_edges_and_names_its_axes_beyond_their_ends():
    axes = Figure().add_subplot()
    plane = np.linalg.qr(np.random.default_rng(25).random((3, 2)))[0]
    mean = np.array([0.2, 0.5, 0.9])
    draw_cube(axes, mean, plane)
    edges = {
        tuple(np.round(np.sort((line.get_xydata() @ plane.T), axis=0).ravel(), 9)) for line in axes.lines
    }
    assert len(edges) == len(axes.lines) == 12
    for line in axes.lines:
        way = np.diff(line.get_xydata(), axis=0)[0]
        assert any(np.allclose(way, plane[neuron]) for neuron in range(3))
    for neuron, text in enumerate(axes.texts):
        assert text.get_text() == f"neuron {neuron + 1}"
        assert text.xy == pytest.approx((np.eye(3)[neuron] - mean) @ plane)
