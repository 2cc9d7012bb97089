"""Experiments beside the paper, read back from the places and colours of what is drawn."""

import numpy as np
import pytest
from matplotlib.colors import to_hex

from arm2d import Condition
from evolution.figures.compare import compare_figure
from evolution.figures.page import PAPER
from evolution.results import published
from evolution.results.wording import TITLES
from tests.evolution.made_up import both_conditions, condition_results, random_successes, results

PLATEAUS, RUNS, TOPS, PASSES = range(4)


@pytest.fixture(scope="module")
def experiments():
    """Two experiments, of three and of two runs, whose numbers differ; one lacks With-Ignore."""
    condition = Condition.WITH_INDICATE
    found = condition_results(
        condition,
        random_successes(condition, n_runs=2, seed=7),
        best=np.array([[2.3, 2.1], [2.4, 2.56]]),
        first_solved=np.array([0, 1]),
    )
    return {"first": both_conditions(), "second": results({condition: found})}


@pytest.fixture(scope="module")
def figure(experiments):
    return compare_figure(experiments)


@pytest.fixture(scope="module")
def colours(figure):
    (legend,) = figure.legends
    handles = zip(legend.get_texts(), legend.legend_handles, strict=True)
    return {text.get_text(): to_hex(handle.get_color()) for text, handle in handles}


def row_of(figure, condition):
    """The four panels of a condition."""
    place = 4 * list(Condition).index(condition)
    assert figure.axes[place].get_title(loc="left") == TITLES[condition]
    return figure.axes[place : place + 4]


def strokes(axes):
    """Where the paper's strokes stand, by the name of their row."""
    names = dict(zip(axes.get_yticks(), [label.get_text() for label in axes.get_yticklabels()], strict=True))
    drawn = [line for line in axes.lines if to_hex(line.get_color()) == PAPER.lower()]
    return {names[np.mean(line.get_ydata())]: line.get_xdata()[0] for line in drawn}


def large_dots(axes, colour):
    """Where the large dots of one colour stand, by the name of the nearest row."""
    names = [label.get_text() for label in axes.get_yticklabels()]
    drawn = [line for line in axes.lines if line.get_markersize() > 4 and to_hex(line.get_color()) == colour]
    return {names[round(line.get_ydata()[0])]: line.get_xdata()[0] for line in drawn}


@pytest.mark.parametrize("condition", Condition)
def test_the_papers_numbers_stand_where_its_per_cents_are(figure, condition):
    panels = row_of(figure, condition)
    runs = {"end at 18/7": 100.0}
    if condition is Condition.WITH_INDICATE:
        runs["fully compositional"] = 60.0
    assert strokes(panels[RUNS]) == runs
    shares = 100 * published.TABLE_II[condition][10] / 100_000
    expected = dict(zip([f"sub-task {name}" for name in ("I", "II", "III", "IV")], shares, strict=True))
    assert strokes(panels[TOPS]) == pytest.approx(expected)
    assert strokes(panels[PASSES]) == {}  # the paper has words only
    for axes in panels[RUNS:]:
        assert axes.get_xlim() == (-3, 103)


@pytest.mark.parametrize("condition", Condition)
def test_our_numbers_stand_in_their_rows_and_in_the_colour_of_their_experiment(
    figure, colours, experiments, condition
):
    panels = row_of(figure, condition)
    for name, experiment in experiments.items():
        drawn = {}
        for axes in panels[RUNS:]:
            drawn |= large_dots(axes, colours[name])
        if condition not in experiment.conditions:
            assert drawn == {}
            continue
        found = experiment.conditions[condition]
        n = len(found.runs)
        expected = {
            "end at 18/7": 100 * found.at_plateau / n,
            "solve all 28 trials": 100 * (found.first_solved >= 0).mean(),
            "fully compositional": 100 * np.mean([len(own) > 0 for own in found.generalisers]),
            **{f"sub-task {s}": 100 * found.share_in_top(s).mean() for s in ("I", "II", "III", "IV")},
        }
        for kind, short in zip(found.transitions, ("fully", "partially", "non-comp."), strict=True):
            outcome = found.transitions[kind]
            expected[f"{short}, action"] = 100 * outcome.action_passed / outcome.agents
            expected[f"{short}, object"] = 100 * outcome.object_passed / outcome.agents
        assert drawn == pytest.approx(expected)


def test_every_run_stands_in_the_row_of_its_experiment(figure, colours, experiments):
    for condition in Condition:
        axes = row_of(figure, condition)[PLATEAUS]
        names = [label.get_text() for label in axes.get_yticklabels()]
        for name, experiment in experiments.items():
            own = [line for line in axes.lines if to_hex(line.get_color()) == colours[name]]
            if condition not in experiment.conditions:
                assert own == []
                continue
            (line,) = own
            plateaus = np.sort(experiment.conditions[condition].plateau)
            assert np.asarray(line.get_xdata()) == pytest.approx(plateaus)
            assert {names[round(y)] for y in line.get_ydata()} == {name}


def test_single_runs_are_the_small_dots(figure, colours, experiments):
    axes = row_of(figure, Condition.WITH_INDICATE)[TOPS]
    own = [line for line in axes.lines if to_hex(line.get_color()) == colours["second"]]
    small = [line for line in own if line.get_markersize() == 2.4]
    shown = {round(line.get_ydata()[0]): np.asarray(line.get_xdata()) for line in small}
    found = experiments["second"].conditions[Condition.WITH_INDICATE]
    for row, subtask in enumerate(("I", "II", "III", "IV")):
        assert shown[row] == pytest.approx(100 * found.share_in_top(subtask))
