"""The picture of all cells: every mark where its number is, in the colour of its condition."""

import numpy as np
import pytest
from matplotlib.colors import to_hex

from evolution.figures.page import CONDITION_COLOURS, SERIES
from evolution.study.beyond.cells import CELLS
from evolution.study.beyond.comparisons import comparisons, verdict_of
from evolution.study.beyond.figure import LOOKS, NOT_COMPARED, PAPER_WIDTH, cells_figure, drawn_words
from evolution.study.beyond.groups import groups_of
from evolution.study.beyond.outcomes import ALL_UNDERSTOOD, OUTCOMES, TESTED, UNDERSTOOD
from tests.evolution.study.beyond.made_up import SEEDS, made_study


@pytest.fixture(scope="module")
def panels(groups, found):
    return cells_figure(groups, found).axes


def third(group):
    return group.runs[0].config.task.third


def lines_of(axes, group):
    """The lines in a group's place: within a third of a row of its height, in its colour."""
    offset, colour, _ = LOOKS[third(group)]
    y = CELLS.index(group.cell) + offset
    own = [line for line in axes.lines if to_hex(line.get_color()) == colour.lower() and line.get_transform()]
    flat = [line for line in own if np.allclose(np.mean(line.get_ydata()), y, atol=1e-9)]
    marks = [line for line in axes.lines if to_hex(line.get_markeredgecolor()) == colour.lower()]
    mark = [line for line in marks if line.get_markersize() == 4.0 and line.get_ydata()[0] == y]
    flat = [line for line in flat if line.get_linewidth() != PAPER_WIDTH]
    return flat, mark


def test_rows_are_cells_the_paper_s_task_in_bold(panels):
    labels = panels[0].get_yticklabels()
    assert [label.get_text() for label in labels] == [cell.title for cell in CELLS]
    assert [label.get_fontweight() for label in labels] == ["bold"] + ["normal"] * 9
    low, high = panels[0].get_ylim()
    assert low > len(CELLS) - 1 > 0 > high


def test_conditions_have_the_project_s_colours_and_lie_side_by_side():
    (up, first, _), (down, second, _), (middle, third_colour, _) = LOOKS.values()
    assert [first, second] == list(CONDITION_COLOURS.values())
    assert third_colour in SERIES
    assert up < middle == 0 < down


def test_means_and_intervals_stand_at_their_numbers(panels, groups, found):
    for axes, outcome in zip(panels, OUTCOMES, strict=True):
        for group in groups:
            own = outcome.estimate(group.runs, drawn_words(group, outcome))
            flat, (mark,) = lines_of(axes, group)
            assert mark.get_xdata()[0] == pytest.approx(100 * own.value)
            ends = [line.get_xdata() for line in flat if len(line.get_xdata()) == 2]
            assert any(np.allclose(end, [100 * own.low, 100 * own.high]) for end in ends)
            filled = mark.get_markerfacecolor() != "white"
            assert filled == (verdict_of(group, outcome, found) != "undecided")
            assert (mark.get_marker() == NOT_COMPARED) == (outcome not in TESTED)


def test_some_marks_are_filled_and_the_paper_s_are_not(groups, found):
    filled = [
        (group.cell.name, outcome.name)
        for group in groups
        for outcome in OUTCOMES
        if verdict_of(group, outcome, found) != "undecided"
    ]
    assert ("dealt", "plateau") in filled
    assert "paper" not in {name for name, _ in filled}


def test_every_run_is_a_dot_where_runs_are_not_counted(panels, groups):
    for axes, outcome in zip(panels, OUTCOMES, strict=True):
        for group in groups:
            flat, _ = lines_of(axes, group)
            dots = [line for line in flat if line.get_marker() == "o" and len(line.get_xdata()) == len(SEEDS)]
            assert len(dots) == (0 if outcome.counts_runs else 1)
            for line in dots:
                due = 100 * outcome.values(group.runs, drawn_words(group, outcome))
                np.testing.assert_allclose(line.get_xdata(), due)
                assert np.ptp(line.get_ydata()) < 0.3


def test_what_is_not_compared_has_the_paper_s_line_only_beside_as_many_held_out(panels, groups):
    axes = panels[OUTCOMES.index(ALL_UNDERSTOOD)]
    drawn = {
        (round(float(np.mean(line.get_ydata())), 6), to_hex(line.get_color()), float(line.get_xdata()[0]))
        for line in axes.lines
        if line.get_linewidth() == PAPER_WIDTH
    }
    means = {third(group): 100 * group.estimate(ALL_UNDERSTOOD).value for group in groups[:2]}
    assert list(means) == ["indicate", "ignore"]
    assert drawn == {
        (CELLS.index(cell), LOOKS[condition][1].lower(), mean)
        for cell in CELLS
        if not cell.name.startswith("without-")
        for condition, mean in means.items()
    }


def test_the_paper_s_task_is_a_line_through_all_rows_in_each_condition(panels, groups):
    for axes, outcome in zip(panels, TESTED, strict=False):
        upright = {
            to_hex(line.get_color()): line.get_xdata()[0]
            for line in axes.lines
            if list(line.get_ydata()) == [0, 1] and line.get_linewidth() == 0.6
        }
        for group in groups:
            if group.cell.name == "paper":
                own = 100 * group.estimate(outcome).value
                assert upright.pop(LOOKS[third(group)][1].lower()) == pytest.approx(own)
        assert upright == {}


def test_understanding_is_drawn_over_the_instructions_by_which_it_is_compared(panels, groups):
    """With the mean of the paper's task over the same ones, where these are fewer than the paper's two."""
    axes = panels[OUTCOMES.index(UNDERSTOOD)]
    papers = {third(group): group for group in groups if group.cell.name == "paper"}
    dotted = {
        (round(float(np.mean(line.get_ydata())), 6), round(float(line.get_xdata()[0]), 6))
        for line in axes.lines
        if line.get_linewidth() == 1.6
    }
    due, told = set(), {group.cell.name: [str(w) for w in drawn_words(group, UNDERSTOOD)] for group in groups}
    assert told["without-move-blue"] == ["MOVE Blue"]
    assert sorted(told["without-four"]) == sorted(told["paper"]) == ["MOVE Blue", "TOUCH Green"]
    for group in groups:
        words = drawn_words(group, UNDERSTOOD)
        if len(words) == 1:
            mean = 100 * UNDERSTOOD.values(papers[third(group)].runs, words).mean()
            y = CELLS.index(group.cell) + LOOKS[third(group)][0]
            due.add((round(y, 6), round(float(mean), 6)))
    assert len(due) == 4
    assert dotted == due


def test_all_that_is_drawn_lies_within_its_panel(panels):
    for axes in panels:
        low, high = axes.get_xlim()
        for line in axes.lines:
            assert low <= min(line.get_xdata()) <= max(line.get_xdata()) <= high


def test_head_tells_runs_and_generations_and_only_measured_cells_have_a_row():
    runs = [run for run in made_study(range(201, 203), generations=60) if run.cell in ("paper", "dealt")]
    groups = groups_of(runs[:-1])
    figure = cells_figure(groups, comparisons(groups))
    assert any("1 to 2 runs of 60 generations" in text.get_text() for text in figure.texts)
    labels = [label.get_text() for label in figure.axes[0].get_yticklabels()]
    assert labels == ["the paper's task", "colours change places"]
    (legend,) = figure.legends
    assert "INDICATE and IGNORE" not in [text.get_text() for text in legend.get_texts()]
