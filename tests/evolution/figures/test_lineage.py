"""The skills of a line, read back from what is drawn."""

import numpy as np
import pytest
from matplotlib.colors import to_hex
from matplotlib.figure import Figure

from arm2d import Condition
from arm2d.drawing import INK, OBJECT_COLOURS
from evolution.agents.lineage_scores import LineageScores, Skills
from evolution.figures.lineage import Row, draw_skill, lineage_figure, skill_rows
from evolution.figures.page import FAINT

# What the legend calls the colours of the flags.
COLOURS = {"black": INK, "grey": FAINT}


@pytest.fixture(scope="module")
def scores():
    """Every skill comes at a generation of its own and, lost for a while, for good at another."""
    shares = []
    for n, start in ((9, 10), (3, 200), (3, 300)):
        share = np.zeros((900, n))
        for column in range(n):
            share[start + 5 * column : start + 5 * column + 60, column] = 0.8
            share[700 + start // 4 + column :, column] = 0.9
        shares.append(Skills.along(share))
    return LineageScores(Condition.WITH_INDICATE, 10, 0, *shares)


def flags(axes):
    """Generation and colour of every flag, and what its number says."""
    lines = {line.get_xdata()[0]: to_hex(line.get_color()) for line in axes.lines}
    numbers = {text.xy[0]: (text.get_text(), to_hex(text.get_color())) for text in axes.texts}
    assert {generation: (f"{generation:,}", colour) for generation, colour in lines.items()} == numbers
    return lines


def test_flags_have_the_colours_that_the_legend_names():
    skills = [Skills.along(np.ones((30, n))) for n in (9, 3, 3)]
    figure = lineage_figure(LineageScores(Condition.WITH_INDICATE, 10, 0, *skills), "agent")
    legend = next(text.get_text() for text in figure.texts if "Flags" in text.get_text())
    words = legend.replace("\n", " ")
    assert "first came (black:" in words
    assert "came for good, if later (grey:" in words
    row = Row("skill", "#123456", np.linspace(0, 1, 2000), first=60, for_good=1234)
    axes = Figure().add_subplot()
    draw_skill(axes, row)
    assert flags(axes) == {60: COLOURS["black"].lower(), 1234: COLOURS["grey"].lower()}


def test_a_skill_that_stayed_has_one_flag_and_one_that_never_came_none():
    for first, for_good, expected in ((60, 60, {60: INK.lower()}), (60, -1, {60: INK.lower()}), (-1, -1, {})):
        axes = Figure().add_subplot()
        draw_skill(axes, Row("skill", "#123456", np.linspace(0, 1, 2000), first, for_good))
        assert flags(axes) == expected


def test_what_came_with_the_last_generations_has_not_come_for_good():
    for for_good, shown in ((1975, True), (1976, False)):
        axes = Figure().add_subplot()
        draw_skill(axes, Row("skill", "#123456", np.linspace(0, 1, 2000), 60, for_good))
        assert (for_good in flags(axes)) is shown


def test_every_row_shows_its_own_skill_in_the_colour_of_its_object(scores):
    figure = lineage_figure(scores, "agent")
    skills = [(scores.held_bent, i) for i in range(3)] + [(scores.success, i) for i in range(9)]
    colours = [OBJECT_COLOURS[word.object] for word in scores.condition.instructions]
    for place, (axes, (skill, column)) in enumerate(zip(figure.axes, skills, strict=True)):
        assert flags(axes) == {skill.first[column]: INK.lower(), skill.for_good[column]: FAINT.lower()}
        heights = axes.collections[-1].get_paths()[0].vertices
        at = int(skill.for_good[column]) + 10
        assert np.isclose(heights[np.isclose(heights[:, 0], at)][:, 1].max(), skill.shares[at, column])
        if place >= 3:
            assert to_hex(axes.yaxis.label.get_color()) == colours[place - 3].lower()
            assert to_hex(axes.collections[-1].get_facecolor()[0]) == colours[place - 3].lower()


def test_rows_are_grouped_by_the_word_that_is_heard(scores):
    groups = skill_rows(scores)
    (bent, _), *rest = groups
    assert bent == "S1 on the target, S2 bent, for 1 s"
    assert [title for title, _ in rest] == ["MOVE", "TOUCH", "INDICATE"]
    for title, rows in groups[1:]:
        for row, object_ in zip(rows, ("Blue", "Green", "Red"), strict=True):
            word = f"{title} {object_}"
            column = [str(instruction) for instruction in scores.condition.instructions].index(word)
            assert (row.label, row.first) == (object_, scores.success.first[column])
            np.testing.assert_array_equal(row.shares, scores.success.shares[:, column])
            assert row.never_met == (word in ("MOVE Blue", "TOUCH Green"))
