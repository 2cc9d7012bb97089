"""The regressions of the factorial study on made-up runs whose effects are known."""

import csv

import numpy as np
import pytest
from matplotlib.colors import to_hex
from scipy.stats import chi2

from arm2d import Condition
from arm2d.readings import PLAIN
from evolution.cli import main
from evolution.figures.paper import TITLES
from evolution.study.declared.factors import FACTORS
from evolution.study.declared.held_back import check
from evolution.study.declared.levels_figure import levels_figure
from evolution.study.declared.nearest import active_factors, distance, nearest_worlds, spreads
from evolution.study.declared.outcomes import FIGURES, OUTCOMES, PLATEAU, SOLVED, TOP_SHARES
from evolution.study.declared.regression import N_MAIN, SIGNIFICANT, design, fit, level_numbers
from evolution.study.declared.results import (
    check_table,
    chosen_worlds,
    effect_table,
    regressions,
    write_factorial,
)
from evolution.study.declared.rows import write_rows
from tests.evolution.study.declared.synthetic import (
    PLACES,
    configs,
    level_of,
    logistic,
    made_up,
    runs_with_effects,
)


@pytest.fixture(scope="module")
def runs():
    return runs_with_effects(1)


@pytest.fixture(scope="module")
def indicate(runs):
    return [run for run in runs if run.config.condition is Condition.WITH_INDICATE]


@pytest.fixture(scope="module")
def plateau(indicate):
    return fit(indicate, PLATEAU)


@pytest.fixture(scope="module")
def models(runs):
    return regressions(runs)


def place(factor, level):
    """Numbers of a factor and of one of its levels."""
    return PLACES[factor], list(FACTORS[PLACES[factor]].levels).index(level)


def test_design_has_a_column_for_every_level_but_the_defaults_and_products_for_interactions():
    levels = level_numbers([made_up(config) for config in configs(Condition.WITH_INDICATE)])
    assert design(levels).shape == (300, N_MAIN) == (300, 33)
    assert np.linalg.matrix_rank(design(levels)) == 33
    one, other = PLACES["mutation"], PLACES["object_radius"]
    assert design(levels, [(one, other)]).shape == (300, 33 + 3 * 4)
    assert np.linalg.matrix_rank(design(levels[:150], [(one, other)])) == 45


@pytest.mark.parametrize(
    ("factor", "level", "true"),
    [
        # Beside its own 0.3 the quarter of the runs that have excess gain 0.25 more, and the other way round.
        ("mutation", "0.4 / 0.03", 0.3 + 0.25 / 4),
        ("parent_scaling", "excess", 0.2 + 0.25 / 4),
        ("start_areas", "bounds", -0.2),
        ("camera_origin", "end", 0.0),
        ("object_radius", "11.8", 0.0),
    ],
)
def test_known_effects_lie_in_their_intervals(plateau, factor, level, true):
    effect = plateau.effect(*place(factor, level))
    assert effect.low <= true <= effect.high
    assert effect.high - effect.low < 0.12


def test_factors_that_do_something_are_told_from_those_that_do_not(plateau):
    found = {FACTORS[i].name for i in np.flatnonzero(plateau.corrected < 0.05)}
    assert found == {"mutation", "parent_scaling", "start_areas"}


def test_p_of_a_factor_is_that_of_walds_chi_square(models):
    """Robust errors have no degrees of freedom: F would give larger p."""
    model = next(model for own in models.values() for model in own if not model.interactions)
    first = 1
    for own, p in zip(FACTORS, model.p, strict=True):
        levels = slice(first, first := first + len(own.levels) - 1)
        b = model.coefficients[levels]
        distance = b @ np.linalg.solve(model.covariance[levels, levels], b)
        assert p == pytest.approx(chi2.sf(distance, len(b)), rel=1e-6), own.name


def test_interaction_that_is_there_enters_and_others_do_not(plateau):
    assert plateau.interactions == ((PLACES["mutation"], PLACES["parent_scaling"]),)
    assert len(plateau.tried) == 3


@pytest.mark.slow
def test_intervals_hold_what_they_promise():
    """Of twenty 95 % intervals of an effect at most three miss it, whether it is 0.3 or none."""
    missed = {"mutation": 0, "crossover": 0}
    for seed in range(20):
        rng = np.random.default_rng(seed)
        runs = [
            made_up(config, 2 + 0.3 * (level_of(config, "mutation") == "0.1 / 0.05") + rng.normal(0, 0.2))
            for config in configs(Condition.WITH_INDICATE)
        ]
        model = fit(runs, PLATEAU)
        for factor, level, true in (("mutation", "0.1 / 0.05", 0.3), ("crossover", "0.3", 0.0)):
            effect = model.effect(*place(factor, level))
            missed[factor] += not effect.low <= true <= effect.high
    assert all(n <= 3 for n in missed.values())


def test_effects_on_shares_are_differences_of_shares(indicate):
    model = fit(indicate, SOLVED)
    effect = model.effect(*place("camera_origin", "end"))
    true = logistic(0.5) - logistic(-1.5)
    # Mixing with the mean pulls an effect towards 0 by a tenth (33 parameters, 300 runs).
    assert effect.low <= true / (1 + 33 / 300) <= effect.high
    assert model.corrected[PLACES["camera_origin"]] < 0.001


def test_level_under_which_nothing_succeeds_has_a_finite_effect():
    rng = np.random.default_rng(4)
    runs = [
        made_up(config, shares=(rng.random() * (level_of(config, "ties") == "children"), 0, 0, 0))
        for config in configs(Condition.WITH_INDICATE)
    ]
    effect = fit(runs, TOP_SHARES[0]).effect(*place("ties", "children"))
    assert 0.4 < effect.low <= effect.value <= effect.high < 0.55


def test_outcome_that_is_the_same_in_all_runs_has_no_effects(indicate):
    runs = [made_up(config) for config in configs(Condition.WITH_INDICATE)]
    for outcome in (SOLVED, PLATEAU, *TOP_SHARES):
        model = fit(runs, outcome)
        assert model.predict(model.levels[:2]) == pytest.approx(outcome.values(runs[:2]), abs=1e-9)
        effect = model.effect(*place("ties", "children"))
        assert (effect.value, effect.low, effect.high) == (0, 0, 0)
        assert model.corrected.min() == 1


def test_too_few_runs_are_refused(indicate):
    with pytest.raises(ValueError, match="65 runs of a condition are measured; the regression has 33 param"):
        fit(indicate[:65], PLATEAU)


def test_held_back_runs_are_predicted_as_far_as_there_is_something_to_predict(indicate):
    known = check(indicate, PLATEAU)
    assert (len(known.model.levels), len(known.found)) == (240, 60)
    assert known.skill.low > 0.5
    lower, _, upper = known.thirds
    assert upper[1] - lower[1] > 0.3
    rng = np.random.default_rng(2)
    noise = check([made_up(run.config, rng.normal(2, 0.2)) for run in indicate], PLATEAU)
    assert noise.skill.value < 0.1


def test_nearest_worlds_are_those_of_the_known_effects(models, runs):
    first, second = chosen_worlds(models, runs)
    assert (first.readings.mutation_sd, first.readings.parent_scaling) == (0.03, "excess")
    assert first.distance <= second.distance
    changed = [
        name for name, value in first.readings.to_mapping().items() if value != getattr(second.readings, name)
    ]
    assert len(changed) >= 2 or "mutation_sd" in changed
    # What does nothing stays at its first level.
    assert first.readings.object_radius == PLAIN.object_radius
    assert first.predicted[Condition.WITH_INDICATE][0] == pytest.approx(2.65, abs=0.1)


def test_active_factors_are_those_that_matter_to_a_figure_in_some_condition(models):
    figures = {c: [model for model in own if model.outcome in FIGURES] for c, own in models.items()}
    names = {FACTORS[i].name for i in active_factors(figures)}
    # The camera decides only what is solved, which is not among the figures.
    assert {"mutation", "parent_scaling", "start_areas"} <= names
    assert "camera_origin" not in names


def test_distance_is_0_for_the_published_figures_and_counts_standard_deviations(runs):
    spread = spreads(runs)
    published = {c: np.array([[figure.published(c) for figure in FIGURES]] * 2) for c in Condition}
    published[Condition.WITH_IGNORE][1] += spread[Condition.WITH_IGNORE]
    np.testing.assert_allclose(distance(published, spread), [0, np.sqrt(0.5)], atol=1e-12)


def test_nothing_that_matters_leaves_the_plain_readings():
    rng = np.random.default_rng(5)
    made = [made_up(config, rng.normal(2, 0.1), rng.random(4)) for config in configs()]
    models = {
        c: [fit([run for run in made if run.config.condition is c], figure) for figure in FIGURES]
        for c in Condition
    }
    assert [world.readings for world in nearest_worlds(models, spreads(made))] == [PLAIN]


def test_figure_has_a_row_for_every_level_and_the_published_values(models):
    figure = levels_figure(models, "title")
    panels = figure.axes
    assert [axes.get_title(loc="left") for axes in panels[:2]] == ["plateau", "solved [%]"]
    labels = [label.get_text() for label in panels[0].get_yticklabels()]
    assert len(labels) == sum(len(factor.levels) for factor in FACTORS) == 52
    assert labels[:2] == ["mutation: 0.4 / 0.1", "0.4 / 0.03"]
    dashed = [np.asarray(line.get_xdata())[0] for line in panels[2].lines if line.get_linestyle() == "--"]
    np.testing.assert_allclose(dashed, [60.231, 66.293])


def test_every_mean_and_its_interval_stand_in_the_row_of_their_level(models):
    figure = levels_figure(models, "title")
    (legend,) = figure.legends
    colours = {
        text.get_text(): to_hex(handle.get_color())
        for text, handle in zip(legend.get_texts(), legend.legend_handles, strict=True)
    }
    levels = [(factor, level) for factor, own in enumerate(FACTORS) for level in range(len(own.levels))]
    for column, axes in enumerate(figure.axes):
        rows = np.array(figure.axes[0].get_yticks())
        for condition, own in models.items():
            model, colour = own[column], colours[TITLES[condition]]
            scale = 100 if model.outcome.is_share else 1
            dots = {}
            for line in axes.lines:
                if line.get_marker() == "o" and to_hex(line.get_markeredgecolor()) == colour:
                    filled = to_hex(line.get_markerfacecolor()) == colour
                    for x, y in line.get_xydata():
                        dots[int(np.abs(rows - y).argmin())] = x, filled
            (bars,) = (bar for bar in axes.collections if to_hex(bar.get_color()[0]) == colour)
            intervals = {int(np.abs(rows - own[0, 1]).argmin()): own[:, 0] for own in bars.get_segments()}
            assert len(dots) == len(intervals) == 52
            for row, (factor, level) in enumerate(levels):
                mean = model.level_mean(factor, level)
                value, filled = dots[row]
                assert value == pytest.approx(scale * mean.value)
                assert filled == (model.corrected[factor] < SIGNIFICANT)
                assert intervals[row] == pytest.approx([scale * mean.low, scale * mean.high])


def test_tables_say_what_the_regressions_say(models, indicate):
    rows = list(csv.DictReader(effect_table(models).to_csv().splitlines()))
    assert len(rows) == 2 * len(OUTCOMES) * 52
    (row,) = (
        r
        for r in rows
        if (r["condition"], r["outcome"], r["level"]) == ("with-indicate", "plateau", "0.4 / 0.03")
    )
    assert float(row["effect"]) == pytest.approx(0.3625, abs=0.06)
    assert int(row["runs"]) == sum(run.config.readings.mutation_sd == 0.03 for run in indicate)
    table = {Condition.WITH_INDICATE: [check(indicate, PLATEAU)]}
    (told,) = csv.DictReader(check_table(table).to_csv().splitlines())
    assert told["runs held back"] == "60"


@pytest.mark.slow
def test_results_are_written_as_far_as_there_are_runs(runs, tmp_path, capsys):
    paths, notes = write_factorial(runs, tmp_path / "all")
    assert not notes
    assert sorted(path.name for path in paths) == [
        "factorial-check.csv", "factorial-claim.csv", "factorial-effects.csv", "factorial-interactions.csv",
        "factorial-levels.png", "factorial-levels.svg", "factorial-worlds.csv", "factorial.csv",
    ]  # fmt: skip
    write_rows(runs[:150], tmp_path / "rows.csv")
    output = [f"--output={tmp_path / 'out'}", f"--rows={tmp_path / 'rows.csv'}", "--now"]
    assert main(["study", "readings", "--part=factorial", *output]) == 0
    said = capsys.readouterr().out
    assert (
        "with-indicate, the check on held-back runs has to wait: 60 runs of a condition are measured" in said
    )
    assert "150 of 450 runs are measured so far" in said
    assert (tmp_path / "out" / "factorial" / "results" / "factorial-effects.csv").exists()
    assert not (tmp_path / "out" / "factorial" / "results" / "factorial-check.csv").exists()
