"""The paper's figures, read back from what is drawn, on made-up results whose numbers all differ."""

import numpy as np
import pytest
from matplotlib.colors import to_hex
from matplotlib.figure import Figure

from arm2d import Condition
from evolution.agents.transitions import action_transitions, object_transitions
from evolution.figures.generalisers import draw_density, generalisers_figure
from evolution.figures.page import CLASS_COLOURS, QUIET
from evolution.figures.paper import all_figures, fitness_figure, table_figure, transitions_figure
from evolution.figures.run import running_median
from evolution.results import published
from evolution.results.wording import TITLES
from tests.evolution.made_up import both_conditions


@pytest.fixture(scope="module")
def experiment():
    return both_conditions()


def panels(figure, experiment):
    """(results, its panels) of each condition; the titles say which they are."""
    columns = len(figure.axes) // len(experiment.conditions)
    for place, (condition, found) in enumerate(experiment.conditions.items()):
        own = figure.axes[place * columns : (place + 1) * columns]
        assert all(axes.get_title(loc="left").startswith(TITLES[condition]) for axes in own)
        yield found, own


def test_bars_of_table_ii_have_the_papers_shares_on_the_left_and_ours_on_the_right(experiment):
    figure = table_figure(experiment)
    (legend,) = figure.legends
    handles = zip(legend.legend_handles, legend.get_texts(), strict=True)
    names = {to_hex(handle.get_facecolor()): text.get_text() for handle, text in list(handles)[:11]}
    sides = [text.get_text() for text in legend.get_texts()][11:]
    assert sides == ["left bar: the paper", "right bar: ours"]
    assert list(names.values()) == [*(f"{8 * k - 7} to {8 * k}" for k in range(10, 0, -1)), "0"]
    for found, (axes,) in panels(figure, experiment):
        labels = [label.get_text() for label in axes.get_xticklabels()]
        assert [label.split("\n")[0] for label in labels] == ["I", "II", "III", "IV"]
        for column, place in enumerate(axes.get_xticks()):
            for whose, sign in ((published.TABLE_II[found.condition], -1), (found.counts, 1)):
                bars = [
                    bar
                    for bar in axes.patches
                    if np.sign(bar.get_x() + bar.get_width() / 2 - place) == sign
                    and abs(bar.get_x() - place) < 0.5
                    and bar.get_facecolor()[3] > 0
                ]
                heights = {names[to_hex(bar.get_facecolor())]: bar.get_height() for bar in bars}
                shares = 100 * whose[:, column] / whose[:, column].sum()
                assert [heights[name] for name in ["0", *list(names.values())[-2::-1]]] == pytest.approx(
                    shares
                )
                ends = [bar.get_y() + bar.get_height() for bar in bars]
                assert [bar.get_y() for bar in bars[1:]] == pytest.approx(ends[:-1])  # one on the other


def test_transitions_stand_above_their_names_in_the_panel_of_their_word(experiment):
    for found, (action, object_) in panels(transitions_figure(experiment), experiment):
        for axes, word, transitions in (
            (action, "action", action_transitions(found.condition)),
            (object_, "object", object_transitions(found.condition)),
        ):
            assert axes.get_title(loc="left").endswith(f"{word} word changes")
            labels = [label.get_text() for label in axes.get_yticklabels()]
            for label, transition in zip(labels, transitions, strict=True):
                changed = [getattr(heard, word).name for heard in (transition.before, transition.after)]
                assert label.upper() == " → ".join(changed)
            stays = "object" if word == "action" else "action"
            groups = {getattr(transition.before, stays).name for transition in transitions}
            assert {text.get_text().upper() for text in axes.texts} == groups
            lines = {to_hex(line.get_color()): line for line in axes.lines if line.get_marker() == "o"}
            texts = [text.get_text() for text in axes.get_legend().get_texts()]
            for kind, outcome in found.transitions.items():
                line = lines[to_hex(CLASS_COLOURS[kind])]
                success, passed = getattr(outcome, f"{word}_success"), getattr(outcome, f"{word}_passed")
                assert np.asarray(line.get_xdata()) == pytest.approx(100 * success)
                # Side by side, so that classes that do the same do not hide one another.
                shift = {"fully": -1, "partially": 0, "non-compositional": 1}[str(kind).split()[0]]
                np.testing.assert_allclose(np.subtract(line.get_ydata(), axes.get_yticks()), 0.24 * shift)
                assert line.get_label() == f"{kind}: {passed} of {outcome.agents} pass"
                assert line.get_label() in texts


def test_fitness_lines_are_the_runs_and_dots_stand_where_they_solved_all(experiment):
    for found, (axes,) in panels(fitness_figure(experiment), experiment):
        for seed, best, first in zip(found.seeds, found.best, found.first_solved, strict=True):
            (line,) = [own for own in axes.lines if own.get_label() == f"seed {seed}"]
            np.testing.assert_array_equal(line.get_ydata(), running_median(best))
            own = [mark for mark in axes.lines if to_hex(mark.get_color()) == to_hex(line.get_color())]
            dots = [tuple(mark.get_xydata()[0]) for mark in own if mark.get_marker() == "o"]
            assert dots == ([(first, line.get_ydata()[first])] if first >= 0 else [])  # on its run's line
        ends = sorted(end for best in found.best if (end := running_median(best)[-1]) < 18 / 7 - 0.02)
        near = [sum(abs(end - other) < 0.02 for other in ends) for end in ends]
        assert [text.get_text() for text in axes.texts] == [f"{n} runs" for n in sorted(set(near)) if n > 1]
        (dashed,) = [own for own in axes.lines if to_hex(own.get_color()) == QUIET.lower()]
        assert set(dashed.get_ydata()) == {18 / 7}
        assert axes.get_title(loc="right") == f"{found.at_plateau} of 3 runs end at 18/7"


def test_generalisers_stand_at_their_generations_in_the_row_of_their_run(experiment):
    figure = generalisers_figure(experiment)
    for found, (axes,) in panels(figure, experiment):
        names = [label.get_text() for label in axes.get_yticklabels()]
        places = dict(zip(names, axes.get_yticks(), strict=True))
        marks = [line for line in axes.lines if line.get_marker() == "d"]
        drawn = {tuple(line.get_xdata()) for line in marks}
        assert drawn == {tuple(own.generations) for own in found.generalisers if len(own)}
        notes = {round(text.xy[1], 6): text.get_text() for text in axes.texts}
        for run, seed in enumerate(found.seeds):
            full, partial, _ = (found.members[kind][run] for kind in found.members)
            expected = f"{full} fully, {partial} partially" if full or partial else "none"
            assert notes[round(places[str(seed)], 6)] == expected


def test_partial_agents_are_dark_in_the_lane_of_their_rank_and_in_the_cell_of_their_generations():
    generations = np.arange(100, 112)
    members = np.zeros((12, 5), bool)
    members[5:10, 1] = True
    members[[0, 2], 4] = True
    axes = Figure().add_subplot()
    draw_density(axes, generations, members, top=-0.1, bottom=-0.6)
    (image,) = axes.images
    shares = np.zeros((5, 3))
    shares[1, 1], shares[4, 0] = 1.0, 0.4
    np.testing.assert_allclose(np.asarray(image.get_array())[..., 3], 0.75 * shares)
    assert tuple(image.get_extent()) == (100, 115, -0.6, -0.1)
    assert image.origin == "upper"  # the best rank on top


def test_all_four_figures_of_the_paper_are_drawn_for_one_condition_too(experiment):
    only = type(experiment)(
        experiment.experiment, {Condition.WITH_IGNORE: experiment.conditions[Condition.WITH_IGNORE]}, {}, {}
    )
    figures = all_figures(only)
    assert {name: len(figure.axes) for name, figure in figures.items()} == {
        "fitness": 1,
        "table-ii": 1,
        "transitions": 2,
        "generalisers": 1,
    }
