import xml.etree.ElementTree as ElementTree
from dataclasses import replace

import numpy as np
import pytest
from matplotlib.colors import to_hex
from matplotlib.figure import Figure

from arm2d import Condition, Readings
from arm2d.drawing import OBJECT_COLOURS
from evolution.figures.page import save_figure
from evolution.figures.run import (
    draw_fitness_curve,
    draw_heat_map,
    fitness_curve,
    heat_map,
    running_median,
)
from evolution.runs.folder import RunFolder
from evolution.runs.recorded import recorded_history
from evolution.search.evaluation import evaluate


@pytest.fixture(scope="module")
def evaluation():
    """Successes that can be told apart: 0, 10, 20, ... of 80."""
    result = evaluate(np.full(84, 0.5), Condition.WITH_INDICATE, Readings())
    return replace(result, successes=np.arange(0, 45, 5).reshape(1, 9, 1).repeat(2, axis=-1))


def test_heat_map_shows_every_count_in_its_place(evaluation):
    axes = Figure().add_subplot()
    draw_heat_map(axes, evaluation)
    texts = {(round(x), round(y), text.get_text()) for text in axes.texts for x, y in [text.get_position()]}
    for i in range(9):
        assert (i % 3, i // 3, f"{10 * i} of 80") in texts
        assert (i % 3, i // 3, f"{12.5 * i:.0f} %") in texts
    assert [each.get_text() for each in axes.get_yticklabels()] == ["MOVE", "TOUCH", "INDICATE"]


def test_heat_map_marks_exactly_the_never_met_ones(evaluation):
    axes = Figure().add_subplot()
    draw_heat_map(axes, evaluation)
    marked = {
        (round(x), round(y))
        for text in axes.texts
        if text.get_text() == "never met"
        for x, y in [text.get_position()]
    }
    assert marked == {(0, 0), (1, 1)}


def test_object_words_are_written_in_the_colours_of_the_objects(evaluation):
    axes = Figure().add_subplot()
    draw_heat_map(axes, evaluation)
    colours = [to_hex(each.label2.get_color()).upper() for each in axes.xaxis.get_major_ticks()]
    assert colours == list(OBJECT_COLOURS.values())


def test_fitness_curve_draws_best_mean_and_the_limit(finished_run):
    history = recorded_history(RunFolder.open(finished_run))
    axes = Figure().add_subplot()
    draw_fitness_curve(axes, history)
    drawn = [np.asarray(line.get_ydata(), dtype=float) for line in axes.lines]
    for values in (history.best, history.mean):
        assert any(np.array_equal(line, values) for line in drawn)
    assert any(np.allclose(line, 18 / 7) for line in drawn)


def test_running_median_passes_over_outliers_and_keeps_the_length():
    values = np.ones(200)
    values[77] = 9.0
    assert np.array_equal(running_median(values), np.ones(200))
    assert running_median(np.array([2.0])).tolist() == [2.0]


def test_a_single_generation_can_be_drawn(finished_run):
    history = recorded_history(RunFolder.open(finished_run))[:1]
    (axes,) = fitness_curve(history, "one").axes
    assert history.best[0] in [line.get_ydata()[0] for line in axes.lines]


def test_figures_are_written_as_png_and_svg_with_the_same_bytes_each_time(evaluation, tmp_path):
    first = [path.read_bytes() for path in save_figure(heat_map(evaluation, "agent"), tmp_path / "one")]
    second = [path.read_bytes() for path in save_figure(heat_map(evaluation, "agent"), tmp_path / "two")]
    assert first == second
    assert first[0].startswith(b"\x89PNG")
    assert ElementTree.fromstring(first[1]).tag.endswith("svg")
    assert sorted(each.name for each in tmp_path.iterdir()) == ["one.png", "one.svg", "two.png", "two.svg"]


def test_a_heat_map_of_several_agents_is_refused():
    three = evaluate(np.random.default_rng(1).random((3, 84)), Condition.WITH_IGNORE, per_area=1)
    with pytest.raises(ValueError, match="a heat map is of one agent, not of 3; evaluate one of them"):
        heat_map(three)
