"""The confirmation: its worlds and seeds, the declared rules on made-up runs, and its commands."""

import csv
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from arm2d import Condition, Readings
from evolution.cli import main
from evolution.commands.study import DECLARED_PARTS
from evolution.study.declared.confirmation.decision import WINNER, decision, judged
from evolution.study.declared.confirmation.figure import worlds_figure
from evolution.study.declared.confirmation.less_one import cost_table, costs
from evolution.study.declared.confirmation.less_one_figure import less_one_figure
from evolution.study.declared.confirmation.verdict import JUDGED, decide, duel_table, world_table
from evolution.study.declared.confirmation.worlds import (
    DEFAULT,
    PRINTED,
    SMALLEST_DEPARTURE,
    WORLD_A,
    WORLD_B,
    departures,
    fresh,
    fresh_worlds,
    hundred,
    less_one,
    runs_of_worlds,
)
from evolution.study.declared.nearest import spreads
from evolution.study.declared.outcomes import FIGURES
from evolution.study.declared.parts import factorial
from evolution.study.declared.results import chosen_worlds, regressions
from evolution.study.declared.rows import write_rows
from evolution.study.declared.study import PARTS
from tests.evolution.study.declared.synthetic import made_up, runs_with_effects

CHOSEN = [Readings(parent_scaling="rank"), Readings(crossover=0.3, mutation_sd=0.03)]
PAGE = (Path(__file__).parents[4] / "docs" / "declaration.md").read_text(encoding="utf-8")
FAR, NEAR = (2.2, (0.05, 0.01, 0.0, 0.0)), (2.56, (0.6, 0.05, 0.02, 0.001))


# Nine seeds: as few as let all ways to exchange runs be counted, and enough for a corrected p of 0.001.
SEEDS = range(101, 110)


def made_fresh(near, chosen=CHOSEN, noise=0.02):
    """Runs of a confirmation in which the worlds named are near to the paper and the others are not."""
    rng, names = np.random.default_rng(3), fresh(chosen).names
    runs = []
    for config in fresh(chosen).configs:
        if config.seed not in SEEDS:
            continue
        plateau, shares = NEAR if names[config.readings] in near else FAR
        own = [share * (1 + rng.normal(0, 10 * noise)) for share in shares]
        runs.append(made_up(config, plateau + rng.normal(0, noise), own))
    return runs


@pytest.fixture(scope="module")
def spread():
    return spreads(runs_with_effects(1))


def decided(near, spread):
    return decide(runs_of_worlds(made_fresh(near), fresh_worlds(CHOSEN)), spread)


def test_fresh_runs_are_thirty_of_every_world_and_condition():
    part = fresh(CHOSEN)
    # Six worlds in both conditions, and the printed one With-Ignore.
    assert len(part.configs) == len(set(part.configs)) == 30 * 13
    assert {config.seed for config in part.configs} == set(range(101, 131))
    assert {config.settings.generations for config in part.configs} == {6000}
    assert not {c.seed for c in part.configs} & {c.seed for c in factorial().configs}
    printed = [c for c in part.configs if part.names[c.readings] == PRINTED]
    assert {c.condition for c in printed} == {Condition.WITH_IGNORE}
    assert len(set(part.names.values())) == len(part.names) == 7


def test_world_that_has_two_names_is_run_once():
    part = fresh([WORLD_B, CHOSEN[0]])
    assert len(part.configs) == 30 * 11
    own = runs_of_worlds([made_up(config) for config in part.configs], fresh_worlds([WORLD_B, CHOSEN[0]]))
    assert own["first"] == own["b"]
    assert len(own["b"][Condition.WITH_IGNORE]) == 30


def test_pilots_worlds_are_those_of_the_declaration():
    assert departures(WORLD_A).keys() == {
        "mutation", "parent_scaling", "ties", "tau_exponent_max", "camera_origin",
    }  # fmt: skip
    assert replace(WORLD_B, camera_origin="end") == WORLD_A
    assert (WORLD_A.mutation_probability, WORLD_A.mutation_sd) == (0.4, 0.03)
    assert replace(SMALLEST_DEPARTURE, parent_scaling="raw", ties="elders") == fresh_worlds(CHOSEN)[DEFAULT]
    assert fresh_worlds(CHOSEN)[PRINTED] == Readings.preset("printed")
    assert "| A | `parent_scaling` excess, `ties` children, `tau_exponent_max` 1, `mutation_sd` 0.03" in PAGE


def test_printed_runs_of_with_indicate_are_the_default_s():
    own = runs_of_worlds(made_fresh({"b"}), fresh_worlds(CHOSEN))
    assert own[PRINTED][Condition.WITH_INDICATE] == own[DEFAULT][Condition.WITH_INDICATE]
    assert len(own[PRINTED][Condition.WITH_INDICATE]) == len(SEEDS)


def test_winner_is_the_nearest_and_beats_the_printed_readings(spread):
    found = decided({"b"}, spread)
    assert (found.winner, found.beats) == ("b", ("b",))
    assert min(found.distances, key=found.distances.__getitem__) == "b"
    assert "beats the printed readings: it is to be the default" in found.sentence


def test_two_runs_of_every_world_and_condition_are_needed(spread):
    runs = made_fresh({"b"})
    two = [run for run in runs if run.config.seed in SEEDS[:2]]
    assert decide(runs_of_worlds(two, fresh_worlds(CHOSEN)), spread).winner == "b"
    with pytest.raises(ValueError, match="1 runs of b with-ignore are measured; the verdict needs two"):
        decide(runs_of_worlds([run for run in two if not is_last_of_b(run)], fresh_worlds(CHOSEN)), spread)


def is_last_of_b(run):
    config = run.config
    return (config.condition, config.readings, config.seed) == (Condition.WITH_IGNORE, WORLD_B, SEEDS[1])


def test_default_stays_where_nothing_is_better(spread):
    found = decided(set(), spread)
    assert found.beats == ()
    assert (
        "does not beat the printed readings in all that is asked: by this rule the default stays"
        in found.sentence
    )


def test_world_that_is_better_in_one_condition_only_does_not_beat_the_printed(spread):
    near, far = made_fresh({"a"}), made_fresh(set())
    mixed = [
        one if one.config.condition is Condition.WITH_INDICATE else other
        for one, other in zip(near, far, strict=True)
    ]
    assert decide(runs_of_worlds(mixed, fresh_worlds(CHOSEN)), spread).beats == ()


def test_world_beyond_the_published_figures_does_not_beat_the_printed(spread):
    """More of what the paper has less of is further from it."""
    runs = made_fresh(set())
    names = fresh(CHOSEN).names
    beyond = [
        made_up(run.config, run.plateau + 0.1, (0.4, 0.9, 0.9, 0.9))
        if names[run.config.readings] == "a"
        else run
        for run in runs
    ]
    found = decide(runs_of_worlds(beyond, fresh_worlds(CHOSEN)), spread)
    duels = [each for each in found.duels if each.world == "a"]
    assert all(each.corrected < 0.01 and each.difference.value > 0 for each in duels)
    assert found.beats == ()


def test_duels_are_corrected_together(spread):
    found = decided({"b"}, spread)
    assert len(found.duels) == 5 * 2 * 2
    for each in found.duels:
        assert each.p <= each.corrected <= 1
    rows = list(csv.DictReader(duel_table(found.duels).to_csv().splitlines()))
    assert len(rows) == 20
    own, worlds = runs_of_worlds(made_fresh({"b"}), fresh_worlds(CHOSEN)), fresh_worlds(CHOSEN)
    table = list(csv.DictReader(world_table(own, worlds, found.distances, found.beats).to_csv().splitlines()))
    assert len(table) == 14
    assert {row["world"] for row in table if row["beats printed"] == "yes"} == {"b"}


def made_decision(plateaus, tops, seeds=range(131, 140), noise=0.02):
    """Runs in which the winner, world B, and the printed readings have these means, by condition."""
    rng, part, runs = np.random.default_rng(5), decision(WORLD_B), []
    for config in part.configs:
        if config.seed in seeds:
            which = part.names[config.readings], config.condition
            shares = [max(0.0, tops[which] + rng.normal(0, noise)), 0.05, 0.02, 0.001]
            runs.append(made_up(config, plateaus[which] + rng.normal(0, noise), shares))
    return runs


INDICATE, IGNORE = Condition
BOTH_AT_THE_TOP = {
    (WINNER, INDICATE): 2.55, (PRINTED, INDICATE): 2.30, (WINNER, IGNORE): 2.55, (PRINTED, IGNORE): 2.54,
}  # fmt: skip
NEARER = {(WINNER, INDICATE): 0.6, (PRINTED, INDICATE): 0.1, (WINNER, IGNORE): 0.6, (PRINTED, IGNORE): 0.6}


def test_decision_asks_the_winner_and_the_printed_readings_with_seeds_nobody_has_run():
    part = decision(WORLD_A)
    assert len(part.configs) == len(set(part.configs)) == 120
    assert set(part.names.values()) == {WINNER, PRINTED}
    others = [fresh(CHOSEN), factorial(), less_one(WORLD_A), hundred(WORLD_A)]
    assert not {c.seed for c in part.configs} & {c.seed for other in others for c in other.configs}
    assert "seeds 131 to 160" in PAGE


def test_default_may_change_to_what_is_better_in_one_condition_and_no_worse_in_the_other(spread):
    _, found = judged(made_decision(BOTH_AT_THE_TOP, NEARER), WORLD_B, spread)
    assert found.is_default
    assert found.sentence.endswith("than the printed readings: it is to be the default")


@pytest.mark.parametrize(
    ("plateaus", "tops", "missed"),
    [
        ({(WINNER, INDICATE): 2.30}, {}, "better With-Indicate"),
        ({}, {(WINNER, INDICATE): 0.1}, "better With-Indicate"),
        ({(WINNER, IGNORE): 2.50}, {}, "no worse With-Ignore"),
        ({}, {(WINNER, IGNORE): 0.5}, "no worse With-Ignore"),
        ({}, {(PRINTED, INDICATE): 0.6, (WINNER, INDICATE): 1.4}, "nearer to the paper"),
    ],
)
def test_default_stays_if_one_of_three_things_is_not_shown(plateaus, tops, missed, spread):
    _, found = judged(made_decision({**BOTH_AT_THE_TOP, **plateaus}, {**NEARER, **tops}), WORLD_B, spread)
    assert not found.is_default
    assert missed in found.sentence
    assert found.sentence.endswith("than the printed readings: the default stays")


@pytest.mark.parametrize(
    ("figure", "lower", "holds"),
    [("plateau", 0.015, True), ("plateau", 0.025, False), ("top", 0.045, True), ("top", 0.055, False)],
)
def test_a_little_less_than_the_margin_is_no_worse(figure, lower, holds, spread):
    """With hardly any noise an interval ends near the mean difference."""
    plateaus, tops = dict(BOTH_AT_THE_TOP), dict(NEARER)
    changed = plateaus if figure == "plateau" else tops
    changed[WINNER, IGNORE] = changed[PRINTED, IGNORE] - lower
    _, found = judged(made_decision(plateaus, tops, noise=0.001), WORLD_B, spread)
    assert found.no_worse == holds


def test_command_takes_every_declared_part_for_one():
    """It names them itself: the study is loaded late."""
    assert DECLARED_PARTS == PARTS


def test_less_one_takes_back_one_departure_at_a_time():
    part = less_one(WORLD_B)
    assert len(part.configs) == 4 * 20
    assert {config.condition for config in part.configs} == {Condition.WITH_INDICATE}
    assert set(part.names.values()) == {
        "without-mutation", "without-parent-scaling", "without-ties", "without-tau-exponent-max",
    }  # fmt: skip
    assert {c.seed for c in part.configs} < {c.seed for c in fresh(CHOSEN).configs}


# What the winner's plateau loses without a departure.
LOST = {"ties": 0.3, "mutation": 0.0}


@pytest.fixture(scope="module")
def taken_back():
    """Runs of a winner, and of the winner less one departure with the same seeds."""
    rng, part = np.random.default_rng(1), less_one(WORLD_B)
    winner = [made_up(replace(c, readings=WORLD_B), 2.55 + rng.normal(0, 0.03)) for c in part.configs[::4]]
    without = {
        name: [
            made_up(
                replace(run.config, readings=departures(WORLD_B)[name]),
                run.plateau - lost + rng.normal(0, 0.01),
            )
            for run in winner
        ]
        for name, lost in LOST.items()
    }
    return winner, without


def table_of(taken_back):
    rows = csv.DictReader(cost_table(costs(*taken_back)).to_csv().splitlines())
    return {(row["factor"], row["outcome"]): row for row in rows}


def test_what_a_departure_is_worth_is_told_seed_by_seed(taken_back):
    rows, (winner, without) = table_of(taken_back), taken_back
    ties, mutation = rows["ties", "plateau"], rows["mutation", "plateau"]
    assert float(ties["difference"]) == pytest.approx(-0.3, abs=0.02)
    assert float(ties["after Holm"]) < 0.01 < float(mutation["after Holm"])
    assert int(ties["seeds"]) == 20
    for name, row in (("ties", ties), ("mutation", mutation)):
        assert int(row["at 18/7"]) == sum(run.at_limit for run in without[name])
        assert int(row["winner at 18/7"]) == sum(run.at_limit for run in winner) > 0


def test_a_seed_that_the_winner_has_not_run_counts_on_neither_side(taken_back):
    winner, without = taken_back
    found = costs(winner[1:], without)
    assert {len(cost.differences) for cost in found} == {19}
    assert {cost.winners_at_limit for cost in found} == {sum(run.at_limit for run in winner[1:])}


def test_picture_of_departures_shows_every_seed_and_what_is_taken_back(taken_back):
    rows, (winner, without) = table_of(taken_back), taken_back
    figure = less_one_figure(costs(winner, without), WORLD_B, "title")
    labels = [label.get_text() for label in figure.axes[0].get_yticklabels()]
    assert labels == ["ties: elders\nin place of children", "mutation: 0.4 / 0.1\nin place of 0.4 / 0.03"]
    with_all = sum(run.at_limit for run in winner)
    assert [text.get_text() for text in figure.axes[0].texts][1:] == [
        f"{sum(run.at_limit for run in without[name])} : {with_all}" for name in LOST
    ]
    for axes, outcome in zip(figure.axes, JUDGED, strict=True):
        scale = 100 if outcome.is_share else 1
        marks = [line for line in axes.lines if line.get_label() != "zero"]
        for row, name in enumerate(LOST):
            told, (seeds, interval, mean) = rows[name, outcome.name], marks[3 * row : 3 * row + 3]
            pairs = zip(without[name], winner, strict=True)
            np.testing.assert_allclose(
                seeds.get_xdata(), [scale * (outcome.of_run(a) - outcome.of_run(b)) for a, b in pairs]
            )
            ends = [scale * float(told[each]) for each in ("low", "high")]
            assert list(interval.get_xdata()) == pytest.approx(ends, abs=0.01)
            assert list(mean.get_xdata()) == pytest.approx([scale * float(told["difference"])], abs=0.01)
            assert list(mean.get_ydata()) == [row]
            assert (mean.get_markerfacecolor() == "white") == (float(told["after Holm"]) >= 0.05)


@pytest.mark.parametrize("default", [Readings(), WORLD_B], ids=["today's", "another"])
def test_hundred_runs_under_the_default_and_twenty_under_the_printed_readings(default):
    part = hundred(default)
    assert part.whole
    counts = {name: sum(part.names[c.readings] == name for c in part.configs) for name in part.names.values()}
    assert counts == {DEFAULT: 200, PRINTED: 40}
    assert {c.seed for c in part.configs} == set(range(1, 101))


@pytest.fixture(scope="module")
def study(tmp_path_factory):
    """A folder with the rows of a whole factorial study and of some seeds of its confirmation."""
    folder = tmp_path_factory.mktemp("study")
    runs = runs_with_effects(1)
    (folder / "factorial").mkdir()
    write_rows(runs, folder / "factorial" / "rows.csv")
    chosen = [world.readings for world in chosen_worlds(regressions(runs), runs)]
    (folder / "fresh").mkdir()
    write_rows(made_fresh({"b"}, chosen), folder / "fresh" / "rows.csv")
    return folder


def test_picture_shows_every_run_mean_and_published_value(spread):
    own = runs_of_worlds(made_fresh({"b"}), fresh_worlds(CHOSEN))
    figure = worlds_figure(own, decide(own, spread).distances, "title")
    runs = [found for conditions in own.values() for found in conditions.values()]
    for axes, outcome in zip(figure.axes, FIGURES, strict=True):
        scale = 100 if outcome.is_share else 1
        drawn = [np.asarray(line.get_xdata()) for line in axes.lines]
        every = [scale * outcome.values(found) for found in runs]
        np.testing.assert_allclose(np.concatenate(drawn[0::4]), np.concatenate(every))
        np.testing.assert_allclose([each[0] for each in drawn[2::4]], [each.mean() for each in every])
        rows = [(row, condition) for row in range(len(own)) for condition in Condition]
        for (row, condition), interval, mean in zip(rows, axes.lines[1::4], axes.lines[2::4], strict=True):
            (low, high), (value,) = interval.get_xdata(), mean.get_xdata()
            assert low <= value <= high
            height = row + (-0.2 if condition is Condition.WITH_INDICATE else 0.2)
            assert [*interval.get_ydata(), *mean.get_ydata()] == pytest.approx([height] * 3)
        published = [scale * outcome.published(condition) for _ in own for condition in Condition]
        np.testing.assert_allclose([each[0] for each in drawn[3::4]], published)
    labels = [label.get_text().split(" (")[0] for label in figure.axes[0].get_yticklabels()]
    assert labels[:4] == ["first", "second", "A", "B"]
    assert labels[-1] == "printed"
    counted = [text.get_text() for text in figure.axes[0].texts]
    assert counted == [f"{sum(run.at_limit for run in found)} of {len(found)}" for found in runs]


@pytest.mark.slow
def test_confirmation_is_written_by_one_command(study, capsys):
    folder = study
    assert main(["study", "readings", "--part=fresh", f"--output={folder}", "--now"]) == 0
    said = capsys.readouterr().out
    assert "so far: the winner, b, beats the printed readings: it is to be the default" in said
    assert "117 of 390 runs are measured so far" in said
    results = folder / "fresh" / "results"
    assert sorted(path.name for path in results.iterdir()) == [
        "fresh-duels.csv",
        "fresh-worlds.csv",
        "fresh-worlds.png",
        "fresh-worlds.svg",
        "fresh.csv",
    ]


@pytest.mark.slow
def test_decision_is_written_by_one_command(study, capsys):
    (study / "decision").mkdir()
    write_rows(made_decision(BOTH_AT_THE_TOP, NEARER), study / "decision" / "rows.csv")
    assert main(["study", "readings", "--part=decision", f"--output={study}", "--now", "--early"]) == 0
    said = capsys.readouterr().out
    assert "so far: the winner is better With-Indicate, no worse With-Ignore, nearer to the paper" in said
    with (study / "decision" / "results" / "decision-worlds.csv").open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    told = [(row["world"], row["runs"], row["beats printed"]) for row in rows]
    assert told == [(WINNER, "9", "yes")] * 2 + [(PRINTED, "9", "no")] * 2
    assert (study / "decision" / "results" / "decision-duels.csv").is_file()


@pytest.mark.slow
def test_less_one_asks_for_the_winner_s_departures(study, capsys):
    folder = study
    rng = np.random.default_rng(7)
    (folder / "less-one").mkdir()
    write_rows(
        [made_up(config, 2.4 + rng.normal(0, 0.02)) for config in less_one(WORLD_B).configs],
        folder / "less-one" / "rows.csv",
    )
    assert main(["study", "readings", "--part=less-one", f"--output={folder}", "--now", "--early"]) == 0
    assert "80 of 80 runs are measured so far" in capsys.readouterr().out
    with (folder / "less-one" / "results" / "less-one-effects.csv").open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert {row["factor"] for row in rows} == departures(WORLD_B).keys()


@pytest.mark.slow
def test_what_is_chosen_waits_for_what_it_is_chosen_from(study, tmp_path, capsys):
    folder = study
    assert main(["study", "readings", "--part=fresh", f"--output={tmp_path}", "--now"]) == 2
    assert "0 of 450 runs of the part factorial have a row in" in capsys.readouterr().err
    (tmp_path / "factorial").mkdir()
    (tmp_path / "factorial" / "rows.csv").write_bytes((folder / "factorial" / "rows.csv").read_bytes())
    (tmp_path / "fresh").mkdir()
    (tmp_path / "fresh" / "rows.csv").write_bytes((folder / "fresh" / "rows.csv").read_bytes())
    command = ["study", "readings", "--part=less-one", f"--output={tmp_path}", "--now"]
    assert main(command) == 2
    assert "117 of 390 runs of the part fresh have a row in" in capsys.readouterr().err
    assert main([*command, "--early"]) == 0
    assert "without ties: 0 of 20 runs are measured" in capsys.readouterr().out
