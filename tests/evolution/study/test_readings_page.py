"""docs/readings.md against the runs it stands on, docs/results/readings/*-runs.csv."""

import csv
import re
from pathlib import Path

import numpy as np
import pytest

from evolution.results.records import PLATEAU_TOLERANCE
from evolution.results.statistics import sign_flip_test
from evolution.search.settings import LARGEST_FITNESS

DOCS = Path(__file__).parents[3] / "docs"
PAGE = (DOCS / "readings.md").read_text(encoding="utf-8")
FLOWING = " ".join(PAGE.split())
NAMES = {
    "**default**": "default",
    "`mutation_sd` 0.03": "mutation-sd-0.03",
    "`mutation_probability` 0.04": "mutation-probability-0.04",
    "`mutation_sd` 0.03, `sector_half_width` 5": "mutation-sd-0.03+sector-half-width-5",
}
CONDITIONS = ("With-Indicate", "With-Ignore")
FRESH = range(11, 21)


def read_runs(part):
    """The runs of a part by variant, condition and seed."""
    with (DOCS / "results" / "readings" / f"{part}-runs.csv").open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    return {(r["variant"], r["condition"], int(r["seed"])): r for r in rows}


@pytest.fixture(scope="module")
def runs():
    """Those of the finalists."""
    return read_runs("finalists")


def rows_below(heading):
    """Cells of the table's rows; a first cell left empty is that of the row above."""
    table = PAGE[PAGE.index(heading) :]
    rows, name = [], ""
    for line in re.findall(r"^\|(.*)\|$", table.split("\n\n", 1)[0], re.MULTILINE)[2:]:
        first, *cells = (cell.strip() for cell in line.split("|"))
        name = first or name
        rows.append((name, *cells))
    return rows


def plateaus(runs, variant, condition, seeds):
    return np.array([float(runs[variant, condition.lower(), seed]["plateau"]) for seed in seeds])


def test_finalists_table_says_what_the_runs_say(runs):
    rows = rows_below("| variant | condition | plateau, mean [95 %] | at 18/7")
    assert [(name, condition) for name, condition, *_ in rows] == [(n, c) for n in NAMES for c in CONDITIONS]
    for name, condition, plateau, at_limit, fresh, share, compositional in rows:
        own = [runs[NAMES[name], condition.lower(), seed] for seed in range(1, 21)]
        found = plateaus(runs, NAMES[name], condition, range(1, 21))
        reached = found >= LARGEST_FITNESS - PLATEAU_TOLERANCE
        assert plateau.startswith(f"{found.mean():.2f} [")
        assert int(at_limit.strip("*")) == reached.sum()
        assert int(fresh.split()[0]) == reached[10:].sum()
        top = 100 * np.mean([float(run["sub-task I, category 10"]) for run in own])
        assert share.strip("*").startswith(f"{top:.0f} % [")
        assert int(compositional) == sum(float(run["fully compositional"]) > 0 for run in own)


def test_fresh_seeds_say_what_the_page_quotes_of_them(runs):
    quoted = [row for row in rows_below("| reading | condition | plateau, difference") if row[-1]]
    assert len(quoted) == 4
    for name, condition, *_, told in quoted:
        without = plateaus(runs, "default", condition, FRESH)
        gains = plateaus(runs, NAMES[name], condition, FRESH) - without
        difference, p = re.fullmatch(r"([+-][\d.]+), p = ([\d.]+)", told).groups()
        assert f"{gains.mean():+.2f}" == difference
        assert f"{sign_flip_test(gains):.{len(p) - 2}f}" == p


def test_plateaus_lack_whole_instructions_as_often_as_the_page_says(runs):
    missing = {key: LARGEST_FITNESS - float(run["plateau"]) for key, run in runs.items()}
    sevenths = {key: round(7 * gap) for key, gap in missing.items()}
    near = sum(abs(gap - sevenths[key] / 7) <= 0.02 for key, gap in missing.items())
    one_short = [run for key, run in runs.items() if key[1] == "with-ignore" and sevenths[key] == 1]
    red = sum(lacks(run, "TOUCH Red") for run in one_short)
    assert f"{near} of the {len(runs)} plateaus lie within 0.02 of 18/7" in FLOWING
    assert f"Of the {len(one_short)} With-Ignore runs that are one short, {red} lack TOUCH Red" in FLOWING


def lacks(run, instruction):
    """Whether late agents fail in more than half of its trials."""
    return (float(run[f"{instruction}, right"]) + float(run[f"{instruction}, left"])) / 2 < 0.5


def test_sizes_of_mutations_do_what_the_page_says():
    around = read_runs("around")
    rows = rows_below("| `mutation_sd` | plateau, mean [95 %]")
    assert [size for size, *_ in rows] == ["**0.1**", "0.07", "0.05", "0.03", "0.02", "0.01"]
    for size, plateau, at_limit, share in rows:
        name = "default" if size == "**0.1**" else f"mutation-sd-{size}"
        found = plateaus(around, name, "with-indicate", range(1, 9))
        tops = [float(around[name, "with-indicate", seed]["sub-task I, category 10"]) for seed in range(1, 9)]
        assert plateau.startswith(f"{found.mean():.2f} [")
        assert int(at_limit) == (found >= LARGEST_FITNESS - PLATEAU_TOLERANCE).sum()
        assert share == f"{100 * np.mean(tops):.0f} %"


def test_runs_evolved_for_two_parts_came_out_the_same():
    screening, around = read_runs("screening"), read_runs("around")
    twice = screening.keys() & around.keys()
    assert f"({len(twice)} of these runs had been evolved for the screening" in FLOWING
    assert all(screening[key] == around[key] for key in twice)


def test_confirmation_table_says_what_the_runs_say(runs):
    favourite = "mutation-sd-0.03"
    names = {
        "alone": favourite,
        "`tau_exponent_max` 0": f"{favourite}+tau-exponent-max-0",
        "`bias_ranges` negative": f"{favourite}+bias-ranges-negative",
        "both": f"{favourite}+bias-ranges-negative+tau-exponent-max-0",
    }
    rows = rows_below("| with `mutation_sd` 0.03 | condition")
    assert [(name, condition) for name, condition, *_ in rows] == [(n, c) for n in names for c in CONDITIONS]
    both_parts = runs | read_runs("confirmation")
    for name, condition, plateau, at_limit, share, compositional in rows:
        found = plateaus(both_parts, names[name], condition, FRESH)
        own = [both_parts[names[name], condition.lower(), seed] for seed in FRESH]
        assert plateau.startswith(f"{found.mean():.2f} [")
        assert int(at_limit.strip("*")) == (found >= LARGEST_FITNESS - PLATEAU_TOLERANCE).sum()
        top = 100 * np.mean([float(run["sub-task I, category 10"]) for run in own])
        assert share.strip("*").startswith(f"{top:.0f} % [")
        assert int(compositional) == sum(float(run["fully compositional"]) > 0 for run in own)


def test_all_three_readings_together_gain_what_the_page_says(runs):
    together = "mutation-sd-0.03+bias-ranges-negative+tau-exponent-max-0"
    found = plateaus(read_runs("confirmation"), together, "With-Indicate", FRESH)
    gains = found - plateaus(runs, "mutation-sd-0.03", "With-Indicate", FRESH)
    assert f"the plateau is higher by {gains.mean():.2f} [" in FLOWING
    column, own = "sub-task I, category 10", read_runs("confirmation")
    shares = [
        float(own[together, "with-indicate", seed][column])
        - float(runs["mutation-sd-0.03", "with-indicate", seed][column])
        for seed in FRESH
    ]
    points, p = 100 * np.mean(shares), sign_flip_test(np.array(shares))
    told = f"the share in category 10 by {points:.0f} points (p = {p:.2f})"
    assert f"(p = {sign_flip_test(gains):.2f}), {told}" in FLOWING


def test_no_reading_around_the_favourite_stands_out():
    with (DOCS / "results" / "readings" / "around-readings.csv").open(encoding="utf-8") as file:
        corrected = [float(row["p after Holm"]) for row in csv.DictReader(file)]
    assert f"of {len(corrected)} looks none has a p below 0.2 after Holm's correction" in FLOWING
    assert min(corrected) >= 0.2


def test_page_counts_the_variants(runs):
    parts = [read_runs(part) for part in ("screening", "finalists", "around", "confirmation")]
    assert f"the nearest of {len({key[0] for part in parts for key in part})} variants" in FLOWING
