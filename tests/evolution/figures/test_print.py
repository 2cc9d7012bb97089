"""Every figure as it is printed: in a column of a journal (85 mm) or across its page (178 mm)."""

from functools import cache

import numpy as np
import pytest
from matplotlib.colors import to_hex, to_rgb
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from arm2d.drawing import COLUMN, FULL, OBJECT_COLOURS, STYLE
from evolution.figures.page import CLASS_COLOURS, CONDITION_COLOURS, SERIES, SUCCESS_MAP, contrast, ink_on
from evolution.search.settings import LARGEST_FITNESS
from tests.evolution.figures.gallery import FIGURES
from tests.evolution.figures.printed import cut_off, on_each_other, texts_of, too_small, unexplained
from tests.evolution.made_up import both_conditions, condition_results, random_successes, results

HIGHEST = 247 / 25.4  # of a page between its margins [in]
# The front page's picture is seen on screens; its words stand beside what they name.
ON_SCREEN = {"concept"}
IN_A_COLUMN = {"heat-map", "fitness-curve", "fans-1"}

figure = cache(lambda name: FIGURES[name]())


@pytest.mark.parametrize("name", FIGURES)
def test_a_figure_is_as_wide_as_it_is_printed_and_no_higher_than_a_page(name):
    width, height = figure(name).get_size_inches()
    if name not in ON_SCREEN:
        assert width == pytest.approx(COLUMN if name in IN_A_COLUMN else FULL)
    assert height <= HIGHEST


@pytest.mark.parametrize("name", FIGURES)
def test_nothing_written_is_cut_off_too_small_or_on_something_else(name):
    found = figure(name)
    assert cut_off(found) == []
    assert too_small(found) == set()
    assert on_each_other(found) == []


@pytest.mark.parametrize("name", sorted(FIGURES.keys() - ON_SCREEN))
def test_every_marker_dash_and_colour_of_a_line_is_explained(name):
    assert unexplained(figure(name)) == set()


def test_what_is_wrong_with_a_page_is_found():
    page = Figure(figsize=(FULL, 2))
    axes = page.add_subplot()
    axes.plot([0, 1], [0, 1], "o--", color="#123456")
    axes.set(xticks=[], yticks=[])
    page.text(0.99, 0.5, "over the edge")
    page.text(0.5, 0.5, "tiny", fontsize=5)
    page.text(0.5, 0.51, "above", fontsize=12)
    assert cut_off(page) == ["over the edge"]
    assert too_small(page) == {("tiny", 5.0)}
    assert on_each_other(page) == [("tiny", "above")]
    assert unexplained(page) == {"marker o", "a dashed line", "the colour #123456"}


def test_a_wider_page_is_judged_as_it_is_printed():
    page = Figure(figsize=(2 * FULL, 2))
    page.text(0.5, 0.5, "six in print", fontsize=11.9)
    assert too_small(page) == {("six in print", 5.95)}


@pytest.mark.parametrize("name", ["effects", "effects-on-top"])
def test_effects_explain_runs_means_the_band_and_the_paper(name):
    (legend,) = figure(name).legends
    names = [text.get_text() for text in legend.get_texts()]
    assert names == ["a run", "mean over runs, 95 % interval", "the interval of the row in bold", "the paper"]
    bold = [text for text in texts_of(figure(name)) if text.get_fontweight() == "bold"]
    rows = {label.get_text() for label in figure(name).axes[0].get_yticklabels()}
    assert len([text for text in bold if text.get_text() in rows]) == 1
    bands = [patch for patch in figure(name).axes[0].patches if isinstance(patch, Patch)]
    assert len(bands) == 1


@pytest.mark.parametrize("kind", ["effects", "failures"])
def test_variants_on_top_of_a_reading_begin_with_it_and_do_not_repeat_it(kind):
    labels = [label.get_text() for label in figure(f"{kind}-on-top").axes[0].get_yticklabels()]
    assert labels == [
        "mutation sd 0.03  (8)",
        "+ bias ranges negative  (8)",
        "+ tau exponent max 0  (9)",
        "+ bias ranges negative, tau exponent max 0  (10)",
    ]
    assert any("+: on top of mutation sd 0.03" in text.get_text() for text in figure(f"{kind}-on-top").texts)


def test_seeds_have_colours_without_an_order_up_to_ten_and_one_beyond():
    def seeds_of(found):
        lines = [own for own in found.axes[0].lines if str(own.get_label()).startswith("seed")]
        return [to_hex(own.get_color()) for own in lines]

    assert seeds_of(figure("fitness")) == [to_hex(colour) for colour in SERIES[:3]]
    from evolution.figures.paper import fitness_figure

    condition = next(iter(CONDITION_COLOURS))
    many = condition_results(condition, random_successes(condition, n_runs=12), first_solved=np.full(12, -1))
    found = fitness_figure(results({condition: many}))
    assert len(set(seeds_of(found))) == 1
    assert next(text.get_text() for text in found.legends[0].get_texts()) == "a run"


def test_axes_of_fitness_begin_where_runs_are_once_they_have_risen():
    low, high = figure("fitness").axes[0].get_ylim()
    lowest = min(found.best[:, 40:].min() for found in both_conditions().conditions.values())
    assert low == pytest.approx(lowest - 0.05, abs=0.02)
    assert high == pytest.approx(LARGEST_FITNESS, abs=0.1)


def test_colours_that_are_no_objects_are_far_from_all_objects():
    others = {*SERIES, *CLASS_COLOURS.values(), *CONDITION_COLOURS.values()}
    for other in others:
        for colour in OBJECT_COLOURS.values():
            assert np.linalg.norm(np.subtract(to_rgb(other), to_rgb(colour))) > 0.3, (other, colour)


@pytest.mark.parametrize("share", np.linspace(0, 1, 21))
def test_numbers_on_shares_can_be_read(share):
    """The contrast that WCAG 2.2 asks for, of the better of two inks."""
    assert contrast(ink_on(share), SUCCESS_MAP(share)) > 4.45
    assert contrast("#777777", "white") == pytest.approx(4.48, abs=0.01)  # a known pair


def test_letters_of_the_style_can_be_read_in_print():
    assert min(size for name, size in STYLE.items() if name.endswith("size") and "major" not in name) >= 6
