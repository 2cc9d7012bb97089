"""Drawings stay small whatever is in them, and their words stay words."""

import io
import re
from pathlib import Path

import numpy as np
import pytest
from matplotlib.figure import Figure
from matplotlib.image import imread

from arm2d import Condition
from evolution.agents.lineage_scores import LineageScores, Skills
from evolution.figures.lineage import lineage_figure
from evolution.figures.page import LARGEST_DRAWING, png_bytes, shortened, svg_bytes

DOCS = Path(__file__).parents[3] / "docs"
LIMIT = 500_000


@pytest.fixture(scope="module")
def long_line():
    """Six thousand ancestors whose skills change in every generation: nothing can be denser."""
    rng = np.random.default_rng(5)
    rise = np.linspace(0.1, 0.95, 6000)[:, np.newaxis]
    skills = [Skills.along(rng.binomial(20, rise, (6000, n)) / 20) for n in (9, 3, 3)]
    return lineage_figure(LineageScores(Condition.WITH_INDICATE, 10, 0, *skills), "the longest line there is")


@pytest.fixture(scope="module")
def drawing(long_line):
    return svg_bytes(long_line)


def test_a_line_of_six_thousand_ancestors_is_a_small_drawing(drawing):
    assert len(drawing) <= LARGEST_DRAWING <= LIMIT
    assert b"<image" in drawing  # its dense layers are pixels


def test_words_and_axes_of_a_dense_figure_are_still_drawn(drawing):
    names = re.findall(rb"<!-- (.*?) -->", drawing)
    for word in (b"The agent's line of ancestors", b"MOVE", b"never met   Blue", b"5,000"):
        assert word in names
    assert len(re.findall(rb'<g id="text_', drawing)) > 20


def test_pixels_do_not_stay_in_the_figure(long_line, drawing):
    layers = [each for axes in long_line.axes for each in (*axes.collections, *axes.lines)]
    assert layers
    assert not any(each.get_rasterized() for each in layers)
    shown = imread(io.BytesIO(png_bytes(long_line, 60)))
    assert shown.ndim == 3


def test_a_figure_that_is_small_is_drawn_without_pixels():
    figure = Figure()
    figure.add_subplot().plot([0, 1], [1, 0])
    assert b"<image" not in svg_bytes(figure)


def test_digits_no_eye_can_tell_are_dropped_in_paths_only():
    before = b'<svg><path d="M 1.234567 2.3"/><use transform="scale(0.015625)"/></svg>'
    assert shortened(before) == b'<svg><path d="M 1.23 2.3"/><use transform="scale(0.015625)"/></svg>'


def test_every_drawing_in_the_docs_is_small():
    drawings = sorted(DOCS.rglob("*.svg"))
    assert drawings
    assert {each.name: each.stat().st_size for each in drawings if each.stat().st_size > LIMIT} == {}
