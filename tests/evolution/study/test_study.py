"""The study of readings: its variants, what runs are measured by, its tables and pictures."""

import csv
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from arm2d import Condition
from arm2d.readings import PLAIN
from evolution.agents.postevaluation import post_evaluate
from evolution.agents.solving import solved_trials
from evolution.cli import main
from evolution.experiments.variants import value_name
from evolution.runs.folder import RunFolder
from evolution.runs.recorded import recorded_history
from evolution.runs.run import evolve
from evolution.runs.storage import DamagedFileError
from evolution.search.config import RunConfig
from evolution.search.settings import Settings
from evolution.study.drawn import base_among, drawn, read_drawn
from evolution.study.effects import effect_table, effects, holm
from evolution.study.figure import effects_figure, failures_figure
from evolution.study.measures import FILE, RunMeasures, measure
from evolution.study.results import write_study
from evolution.study.table import VariantMeasures, group, nearest, run_table, variant_table
from evolution.study.variants import around, confirmation, finalists, screening

RESULTS = Path(__file__).parents[3] / "docs" / "results" / "readings"
SETTINGS = Settings(population=12, elites=2, parents=6, generations=40)


@pytest.fixture(scope="module")
def measured(tmp_path_factory):
    """Four short runs of two worlds, named as in the study's tables (plain was the default) and measured."""
    path, named = tmp_path_factory.mktemp("study"), []
    for name, readings in (("default", PLAIN), ("object-radius-8", replace(PLAIN, object_radius=8.0))):
        for seed in (2, 1):
            folder = path / name / f"seed-{seed:04d}"
            evolve(folder, RunConfig(Condition.WITH_INDICATE, seed, SETTINGS, readings))
            named.append((name, measure(RunFolder.open(folder))))
    return path, named


def test_screening_stays_as_it_was_run():
    """New readings go into the factorial study: these rows are history."""
    with (RESULTS / "screening-variants.csv").open(encoding="utf-8") as file:
        run = [row["variant"] for row in csv.DictReader(file)]
    assert [departures(world) for world in screening().worlds] == run


def departures(world):
    """The name of a world at the time of the screening: what differs from the plain readings."""
    plain = PLAIN.to_mapping()
    special = [value_name(name, value) for name, value in world.to_mapping().items() if value != plain[name]]
    return "+".join(special) or "default"


PARTS = [screening(), finalists([replace(PLAIN, object_radius=8.0), PLAIN]), around()]


@pytest.mark.parametrize("part", PARTS, ids=lambda part: part.name)
def test_variants_are_distinct_worlds_the_plain_one_among_them(part):
    configs = part.configs()
    assert len(set(configs)) == len(configs) == part.seeds * len(part.conditions) * len(part.worlds)
    assert sum(each.readings == PLAIN for each in configs) == part.seeds * len(part.conditions)


def test_around_changes_the_favourite_by_one_line_of_the_screening_at_a_time():
    favourite, worlds = replace(PLAIN, mutation_sd=0.03), around().worlds
    sizes = [world for world in worlds if replace(world, mutation_sd=0.1) == PLAIN]
    assert sorted(world.mutation_sd for world in sizes) == [0.01, 0.02, 0.03, 0.05, 0.07, 0.1]
    screened = {replace(world, mutation_sd=0.03) for world in screening().worlds}
    others = [world for world in worlds if world not in sizes]
    assert set(others) < screened - {favourite}


def test_nearest_variant_is_the_one_whose_numbers_are_the_published_ones(measured):
    variants = group(measured[1])
    plateau = max(variants, key=lambda each: each.plateaus.mean())  # neither reaches the published share
    assert [each.name for each in nearest(variants, 1)] == [plateau.name]


def variant(name, plateau, top_share, *, seeds=(1, 2), generations=3000, **changed):
    """Runs whose plateaus and shares of agents in category 10 of sub-task I are these."""
    top = np.arange(100)[:, np.newaxis, np.newaxis, np.newaxis] < 100 * top_share
    successes = np.broadcast_to(np.where(top, 40, 0), (100, 5, 9, 2)).astype(np.int16)
    runs = []
    for seed in seeds:
        config = RunConfig(
            Condition.WITH_INDICATE, seed, Settings(generations=generations), replace(PLAIN, **changed)
        )
        runs.append(RunMeasures(config, plateau, 7, 0.5, successes))
    return VariantMeasures(name, Condition.WITH_INDICATE, generations, tuple(runs))


def test_nearest_looks_at_the_share_of_agents_where_plateaus_are_alike():
    """The published share is 60 %: too many is as far off as too few."""
    shares = {"none": 0.0, "all": 1.0, "some": 0.5, "published": 0.6}
    variants = [variant(name, 2.4, share) for name, share in shares.items()]
    assert [near.name for near in nearest(variants, 4)] == ["published", "some", "all", "none"]


def test_nearest_looks_at_plateaus_where_shares_are_alike():
    plateaus = {"low": 1.9, "high": 2.55, "middle": 2.2}
    variants = [variant(name, plateau, 0.3) for name, plateau in plateaus.items()]
    assert [near.name for near in nearest(variants, 3)] == ["high", "middle", "low"]


def test_nearest_counts_both_ranks_the_same():
    first_and_last, both_second = variant("a", 2.57, 0.0), variant("b", 2.5, 0.5)
    last_and_third = variant("c", 2.0, 0.4)
    last = variant("d", 1.9, 0.61)
    # Ranks of plateau and share: a 1 + 4, b 2 + 2, c 3 + 3, d 4 + 1; equals stand as they came.
    variants = [first_and_last, both_second, last_and_third, last]
    assert [near.name for near in nearest(variants, 4)] == ["b", "a", "d", "c"]


def test_only_runs_of_one_length_and_condition_make_a_pair():
    default, longer = variant("default", 2.2, 0.1), variant("longer", 2.5, 0.1, generations=6000)
    wide = variant("wide", 2.3, 0.1, object_radius=8.0)
    ignore = replace(
        wide,
        condition=Condition.WITH_IGNORE,
        runs=tuple(
            replace(run, config=replace(run.config, condition=Condition.WITH_IGNORE)) for run in wide.runs
        ),
    )
    assert effects([longer, wide]) == []
    assert effects([default, ignore]) == []
    assert effects([default, longer]) == []
    (effect,) = effects([default, longer, wide, ignore])
    assert effect.pairs == ((default, wide),)
    assert effect.differences == pytest.approx([0.1, 0.1])


def test_only_seeds_that_all_worlds_have_are_counted():
    default = variant("default", 2.2, 0.1, seeds=(1, 2, 4))
    wide = variant("wide", 2.3, 0.1, seeds=(2, 3, 4), object_radius=8.0)
    (effect,) = effects([default, wide])
    assert effect.seeds == [2, 4]
    for runs in (effect.without, effect.changed):
        assert [run.config.seed for run in runs] == [2, 4]


def test_sampled_agents_are_those_of_the_post_evaluation(measured):
    path, named = measured
    run = RunFolder.open(path / "default" / "seed-0002")
    whole = post_evaluate(run)
    tenth = np.flatnonzero(whole.generations % 10 == 0)
    np.testing.assert_array_equal(named[0][1].successes.sum(axis=-1), whole.successes[tenth])


def test_measures_say_when_a_run_first_solved_all_trials(measured):
    path, named = measured
    solved = solved_trials(RunFolder.open(path / "default" / "seed-0002"))
    assert (named[0][1].first_solved >= 0) == bool((solved == 28).any())
    assert named[0][1].solved_late == (solved[26:] == 28).mean()


def test_measures_are_kept_and_damage_is_named(measured):
    path, _ = measured
    run = RunFolder.open(path / "object-radius-8" / "seed-0001")
    kept = measure(run)
    file = run.path / FILE
    before = file.read_bytes()
    np.testing.assert_array_equal(measure(run).successes, kept.successes)
    file.write_bytes(before[:-30])
    with pytest.raises(DamagedFileError, match="remove it and repeat the command"):
        measure(run)
    for value in (-1, 41):  # of 40 trials
        file.write_bytes(before)
        arrays = run.read_arrays(file)
        arrays["successes"][-1, -1, -1, -1] = value
        run.write_arrays(file, arrays)
        with pytest.raises(DamagedFileError, match=r"its successes are not all in \[0, 40\]"):
            measure(run)
    file.write_bytes(before)


def test_plateau_is_the_median_best_fitness_of_the_last_sixth(measured):
    path, named = measured
    best = recorded_history(RunFolder.open(path / "default" / "seed-0002")).best
    assert named[0][1].plateau == np.median(best[-round(len(best) / 6) :])


def test_a_study_of_runs_too_short_to_be_measured_is_refused(tmp_path, capsys):
    assert main(["study", "readings", "--generations=29", f"--output={tmp_path}"]) == 2
    assert (
        "a run of 29 generations is too short to be measured; it needs at least 30" in capsys.readouterr().err
    )
    assert not list(tmp_path.iterdir())


def test_unfinished_run_is_not_measured(tmp_path):
    run = RunFolder.create(tmp_path / "run", RunConfig(settings=SETTINGS))
    with pytest.raises(ValueError, match="is not finished; go on with"):
        measure(run)


def test_runs_are_put_together_by_variant_and_ordered_by_seed(measured):
    variants = group(measured[1])
    assert [each.name for each in variants] == ["default", "object-radius-8"]
    assert [[run.config.seed for run in each.runs] for each in variants] == [[1, 2], [1, 2]]


def test_rows_hold_what_was_measured(measured):
    variants = group(measured[1])
    runs = list(csv.DictReader(run_table(variants).to_csv().splitlines()))
    assert [row["seed"] for row in runs] == ["1", "2", "1", "2"]
    assert float(runs[0]["plateau"]) == pytest.approx(variants[0].runs[0].plateau, abs=1e-4)
    one, other = csv.DictReader(variant_table(variants).to_csv().splitlines())
    mean = np.mean([float(row["plateau"]) for row in runs[2:]])
    assert float(other["plateau"]) == pytest.approx(mean, abs=1e-4)
    assert float(one["plateau low"]) <= float(one["plateau"]) <= float(one["plateau high"])


def test_a_variant_and_its_runs_are_told_with_their_own_numbers():
    """Successes that differ in every instruction and area; one run of three never solved all its trials."""
    successes = np.tile(np.arange(5, 23).reshape(9, 2), (100, 5, 1, 1)).astype(np.int16)
    base = variant("default", 2.4, 0.0, seeds=(1, 2, 3))
    runs = [
        replace(run, successes=successes, first_solved=first)
        for run, first in zip(base.runs, (100, -1, 250), strict=True)
    ]
    told = replace(base, runs=tuple(runs))
    (row,) = csv.DictReader(variant_table([told]).to_csv().splitlines())
    assert (row["runs that solve all trials"], row["median generation of these"]) == ("2", "175")
    assert (row["weakest instruction"], row["from"]) == ("MOVE Green", "right")
    assert float(row["its success"]) == pytest.approx(7 / 40, abs=5e-4)
    by_run = list(csv.DictReader(run_table([told]).to_csv().splitlines()))
    assert [run["first generation that solved all trials"] for run in by_run] == ["100", "never", "250"]
    for place, name in enumerate(list(by_run[0])[-18:]):
        assert name.endswith(("right", "left")[place % 2])
        assert float(by_run[0][name]) == pytest.approx((5 + place) / 40, abs=5e-4)


def test_weakest_instruction_is_the_least_carried_out_of_the_experienced(measured):
    (variant, _) = group(measured[1])
    instruction, area, success = variant.weakest
    order = variant.condition.instructions
    assert instruction in variant.condition.experienced
    assert success == variant.success_by_area[order.index(instruction), ("right", "left").index(area)]
    known = [order.index(each) for each in variant.condition.experienced]
    assert success == variant.success_by_area[known].min()


def test_effect_of_a_reading_is_its_difference_seed_by_seed(measured):
    variants = group(measured[1])
    (effect,) = effects(variants)
    assert (effect.reading, effect.value, effect.seeds) == ("object_radius", 8.0, [1, 2])
    np.testing.assert_array_equal(effect.differences, variants[1].plateaus - variants[0].plateaus)
    assert (effect.without, effect.changed) == (list(variants[0].runs), list(variants[1].runs))
    (row,) = csv.DictReader(effect_table(variants).to_csv().splitlines())
    assert float(row["plateau, difference"]) == pytest.approx(effect.differences.mean(), abs=1e-4)
    # Two seeds have four choices of signs, two of which are at least as far off as any.
    assert float(row["p"]) == float(row["p after Holm"]) == (1.0 if np.prod(effect.differences) < 0 else 0.5)


def test_effect_counts_seeds_not_pairs_of_worlds(measured):
    """The same pair of worlds twice, once more under a reading that both share, says nothing new."""
    twice = group(measured[1]) + [
        replace(each, name=f"{each.name}+success-f1-f2-f3", runs=tuple(strict(run) for run in each.runs))
        for each in group(measured[1])
    ]
    by_name = {(each.reading, each.value): each for each in effects(twice)}
    radius = by_name["object_radius", 8.0]
    assert (len(radius.pairs), radius.seeds) == (2, [1, 2])
    np.testing.assert_array_equal(radius.differences, effects(group(measured[1]))[0].differences)
    np.testing.assert_array_equal(by_name["success", "f1_f2_f3"].differences, [0.0, 0.0])


def strict(run):
    """The run under the reading of success that changes no fitness."""
    return replace(run, config=replace(run.config, readings=replace(run.config.readings, success="f1_f2_f3")))


def test_holm_multiplies_the_smallest_p_by_all_looks_and_keeps_their_order():
    np.testing.assert_allclose(holm(np.array([0.02, 0.5, 0.01, 0.04])), [0.06, 0.5, 0.04, 0.08])
    np.testing.assert_array_equal(holm(np.array([0.9, 0.8])), [1.0, 1.0])


def test_figures_show_every_variant_and_the_published_values(measured):
    variants = [drawn(variant) for variant in group(measured[1])]
    effects = effects_figure(variants)
    labels = [label.get_text() for label in effects.axes[0].get_yticklabels()]
    assert labels == ["plain", "object radius 8"]
    dashed = [np.asarray(line.get_xdata()) for line in effects.axes[2].lines if line.get_linestyle() == "--"]
    np.testing.assert_allclose(dashed, [[60.231, 60.231]])
    failures = failures_figure(variants)
    (image,) = failures.axes[0].images
    np.testing.assert_allclose(
        np.asarray(image.get_array())[1], 100 * group(measured[1])[1].success_by_area.ravel()
    )


def test_what_is_drawn_can_be_read_back_from_the_table_of_runs(measured, tmp_path):
    path = tmp_path / "part-runs.csv"
    path.write_text(run_table(group(measured[1])).to_csv())
    for again, variant in zip(read_drawn(path), group(measured[1]), strict=True):
        shown = drawn(variant)
        assert (again.name, again.condition, again.generations) == (shown.name, shown.condition, 40)
        for name in ("seeds", "plateaus", "solved", "top_shares", "generalists", "success"):
            np.testing.assert_allclose(getattr(again, name), getattr(shown, name), rtol=0, atol=5e-4)


def test_what_is_no_table_of_runs_is_refused(tmp_path):
    path = tmp_path / "other.csv"
    path.write_text("variant,condition\ndefault,with-indicate\n")
    with pytest.raises(ValueError, match=r"is no table of a study's runs .* ends with -runs\.csv"):
        read_drawn(path)


def test_the_confirmation_stands_on_the_finalists_runs_of_the_same_seeds():
    """What the table of docs/readings.md calls alone."""
    variants = read_drawn(RESULTS / "confirmation-runs.csv")
    finalists = read_drawn(RESULTS / "finalists-runs.csv")
    for condition, plateau in ((Condition.WITH_INDICATE, 2.45), (Condition.WITH_IGNORE, 2.54)):
        base = base_among(finalists, [each for each in variants if each.condition is condition])
        assert (base.name, base.seeds.tolist()) == ("mutation-sd-0.03", list(range(11, 21)))
        assert base.plateaus.mean() == pytest.approx(plateau, abs=0.005)
    assert base_among(finalists, read_drawn(RESULTS / "screening-runs.csv")) is None


def test_study_is_written_as_tables_and_pictures(measured, tmp_path):
    paths = list(write_study(group(measured[1]), screening(), tmp_path))
    assert sorted(tmp_path.iterdir()) == sorted(paths)
    assert {each.suffix for each in paths} == {".csv", ".png", ".svg"}


@pytest.mark.parametrize(("part", "among"), [("finalists", "screening"), ("confirmation", "around")])
def test_what_is_chosen_needs_what_it_is_chosen_from(part, among, tmp_path, capsys):
    assert main(["study", "readings", f"--part={part}", f"--output={tmp_path}"]) == 2
    message = f"no run is measured in {tmp_path / among}; begin with: wordarm study readings --part {among}"
    assert message in capsys.readouterr().err
    assert not list(tmp_path.iterdir())


def test_confirmed_are_the_two_nearest_and_both_together_with_seeds_that_had_no_say():
    seen = replace(PLAIN, mutation_sd=0.03, object_vision="any_part")
    own = replace(PLAIN, starts_shared="genotype")
    part = confirmation([seen, own, PLAIN])
    assert part.worlds == (seen, own, replace(seen, starts_shared="genotype"))
    assert {each.seed for each in around().configs()}.isdisjoint(each.seed for each in part.configs())
    less = replace(seen, mutation_sd=0.1)
    assert confirmation([seen, less]).worlds == (seen, less)
    with pytest.raises(ValueError, match="needs two variants to choose from, and one is measured"):
        confirmation([seen])
