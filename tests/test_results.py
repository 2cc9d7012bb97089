"""The pages results.md and plain.md against the numbers they stand on, in docs/results."""

import csv
import re
from pathlib import Path
from typing import Final

import numpy as np
import pytest

from arm2d import Condition
from evolution.agents.classes import Sampling
from evolution.agents.subtasks import categories, count_table
from evolution.report.classes import class_run_table, class_table
from evolution.report.comparison import key_number_table
from evolution.report.rows import (
    generaliser_table,
    genotype_table,
    run_table,
    significance_table,
    table_ii,
    transition_table,
)
from evolution.runs.sources import SHIPPED, find_agent
from evolution.search.evaluation import evaluate
from evolution.study.effects import effect_table
from evolution.study.table import run_table as measured_run_table
from evolution.study.table import variant_table
from tests.evolution.made_up import condition_results, results

ROOT = Path(__file__).parents[1] / "docs"
# Pages, each with the folder of its numbers.
PAGES: Final = {"results.md": ROOT / "results", "plain.md": ROOT / "results" / "plain"}
EMPTY = results({})


@pytest.fixture(scope="module", params=PAGES)
def page(request):
    return request.param


@pytest.fixture(scope="module")
def text(page):
    return (ROOT / page).read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def arrays(page):
    with np.load(PAGES[page] / "results.npz", allow_pickle=False) as stored:
        return {name: stored[name] for name in stored.files}


def rows_of(page, name):
    """The lines of a stored table, as dictionaries."""
    with (PAGES[page] / name).open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def cells(text, begin):
    """The cells, but the first, of the line of a table in a page."""
    (line,) = [line for line in text.splitlines() if line.startswith(f"| {begin} |")]
    return [cell.strip() for cell in line.split("|")[2:-1]]


def agents(arrays, condition):
    """Successes [R, L, 5, 9]."""
    return arrays[f"{condition}.successes"].astype(int)


def test_category_ten_of_table_ii_is_what_the_page_says(arrays, text):
    columns = {c: count_table(categories(agents(arrays, c).reshape(-1, 9), c))[10] for c in Condition}
    subtasks = ("I, the seven experienced", "II, with MOVE Blue", "III, with TOUCH Green", "IV, all nine")
    for row, subtask in enumerate(subtasks):
        told = [int(cell) for cell in cells(text, subtask)]
        assert told[1::2] == [int(columns[condition][row]) for condition in Condition]


def test_runs_that_learn_the_seven_and_when_are_what_the_page_says():
    page = "results.md"
    text = (ROOT / page).read_text(encoding="utf-8")
    ends, first = cells(text, "runs that end at about 2.57"), {}
    for number, condition in enumerate(Condition):
        own = [row for row in rows_of(page, "runs.csv") if row["condition"] == condition]
        plateaus = [float(row["plateau"]) for row in own]
        assert ends[1 + number] == f"{sum(p > 18 / 7 - 0.02 for p in plateaus)} of 10"
        solved = [row["first generation that solved all trials"] for row in own]
        first[condition] = [int(each) for each in solved if each != "never"]
    indicate, ignore = first.values()
    assert (len(indicate), len(ignore)) == (7, 10)
    assert cells(text, "first generation in which one genotype solved all 28 trials")[1:] == [
        f"{min(indicate)} to {max(indicate)} in seven runs, never in three",
        f"{min(ignore)} to {max(ignore)}",
    ]


def test_transitions_are_what_the_page_says():
    page = "results.md"
    text = (ROOT / page).read_text(encoding="utf-8")
    found = {(row["condition"], row["class"]): row for row in rows_of(page, "transitions.csv")}
    for kind in ("fully compositional", "partially compositional", "non-compositional"):
        (line,) = [each for each in text.splitlines() if each.startswith(f"| action word | {kind} |")]
        ours = [cell.strip() for cell in line.split("|")[4:-1:2]]
        for told, condition in zip(ours, Condition, strict=True):
            row = found[condition, kind]
            assert told.split(",")[0] == f"{row['pass action']} of {row['agents']}"
            assert row["pass action"] == "0" or f"in {row['runs action']} of" in told
    for condition, told in zip(Condition, cells(text, "object word")[2::2], strict=True):
        own = [row for (where, _), row in found.items() if where == condition]
        assert told == f"0 of {sum(int(row['agents']) for row in own)}"
        assert {row["pass object"] for row in own} == {"0"}


def test_differences_are_those_of_the_tests(page, text):
    for row in rows_of(page, "tests.csv")[:4]:
        told = cells(text, row["compared"].removesuffix(", category 10"))
        values = [100 * float(row[name]) for name in ("With-Indicate", "With-Ignore")]
        assert told[:2] == [f"{value:.1f} %" for value in values]
        found = re.findall(r"-?[\d.]+", told[2])
        expected = [100 * float(row[name]) for name in ("difference", "95 % low", "95 % high")]
        assert [float(each) for each in found] == pytest.approx(expected[: len(found)], abs=0.051)
        assert float(told[3]) == pytest.approx(float(row["Mann-Whitney p"]), rel=0.05)


CLASS_COLUMNS: Final = (
    "share of variance, object, the second before first sight",
    "share of variance, action, the second before first sight",
    "share of variance, object, 0.5 to 3 s after first sight",
    "share of variance, action, 0.5 to 3 s after first sight",
    "success, experienced, intact",
    "success, experienced, action word exchanged before sight",
    "success, experienced, object word exchanged after sight",
    "success, experienced, action word exchanged after sight",
    "success, experienced, object word exchanged before sight",
)


def test_what_classes_do_is_what_the_page_says(text, page):
    found = {(r["condition"], r["class"], r["measure"]): r for r in rows_of(page, "classes.csv")}
    lines = 0
    for title, condition in (
        ("With-Indicate", Condition.WITH_INDICATE),
        ("With-Ignore", Condition.WITH_IGNORE),
    ):
        for kind in ("fully", "partially", "non-compositional"):
            if not any(line.startswith(f"| {title}, {kind} |") for line in text.splitlines()):
                continue
            own = {m: r for (c, k, m), r in found.items() if c == condition and k.startswith(kind)}
            intact = own["success, experienced, intact"]
            told = cells(text, f"{title}, {kind}")
            counted = f"{intact['agents observed']} ({int(intact['agents in the class']):,})"
            assert told[0].split("),")[0].removesuffix(")").replace(",", "") == counted[:-1].replace(",", "")
            shares = [float(own[measure]["mean over runs"]) for measure in CLASS_COLUMNS]
            percents = [float(each) for cell in told[1:] for each in cell.replace("%", "").split(",")]
            assert percents == pytest.approx([100 * share for share in shares[: len(percents)]], abs=0.51)
            lines += 1
    assert lines == {"results.md": 6, "plain.md": 5}[page]


def test_the_papers_kind_of_test_tells_halves_of_one_condition_apart(arrays, text):
    """Why the run has to be the unit: told that ten runs are five of either condition, only the paper's kind
    of test finds that the conditions differ."""
    successes = agents(arrays, Condition.WITH_INDICATE)
    halves = dict(zip(Condition, (successes[:5], successes[5:]), strict=True))
    found = results({condition: condition_results(condition, half) for condition, half in halves.items()})
    name = "sub-task I, category 10"
    p = found.published_tests[name][1]
    assert p < 1e-40
    assert f"with p = {p:.0e}" in text
    assert found.comparisons[name].mann_whitney_p > 0.05


@pytest.fixture(scope="module")
def stored(arrays):
    """The experiment as far as the archive tells it; transitions and stays of genotypes are made up."""
    return results(
        {
            c: condition_results(
                c,
                agents(arrays, c),
                best=arrays[f"{c}.best"].astype(float),
                first_solved=arrays[f"{c}.first_solved"],
            )
            for c in Condition
        }
    )


@pytest.mark.parametrize(("name", "table"), [("table-ii", table_ii), ("tests", significance_table)])
def test_tables_made_again_from_the_archive_have_the_stored_bytes(stored, page, name, table):
    assert table(stored).to_csv().encode() == (PAGES[page] / f"{name}.csv").read_bytes()


def test_runs_made_again_from_the_archive_have_the_stored_values(stored, page):
    unknown = {"plateau", "distinct genotypes", "longest stay among the five best"}
    rows = rows_of(page, "runs.csv")
    again = list(csv.DictReader(run_table(stored).to_csv().splitlines()))
    assert len(rows) == 20
    for row, made in zip(rows, again, strict=True):
        assert {name: row[name] for name in row.keys() - unknown} == {
            n: made[n] for n in row.keys() - unknown
        }
    for row, found in zip(rows, stored.analysed_runs, strict=True):
        last = found.results.best[found.index, -1000:]
        assert float(row["plateau"]) == pytest.approx(np.median(last), abs=5.1e-5)


OF_AN_EXPERIMENT: Final = {
    "table-ii.csv": table_ii(EMPTY),
    "runs.csv": run_table(EMPTY),
    "transitions.csv": transition_table(EMPTY),
    "tests.csv": significance_table(EMPTY),
    "generalisers.csv": generaliser_table(EMPTY),
    "generaliser-genotypes.csv": genotype_table(EMPTY),
    "classes.csv": class_table([], Sampling()),
    "classes-runs.csv": class_run_table([]),
}
STORED: Final = {
    **OF_AN_EXPERIMENT,
    **{f"plain/{name}": table for name, table in OF_AN_EXPERIMENT.items()},
    "readings/favourite/comparison.csv": key_number_table({"default": EMPTY, "mutation-sd-0.03": EMPTY}),
    **{
        f"readings/{part}-{name}.csv": table
        for part in ("screening", "finalists", "around", "confirmation")
        for name, table in (
            ("variants", variant_table([])),
            ("readings", effect_table([])),
            ("runs", measured_run_table([])),
        )
    },
}


@pytest.mark.parametrize("name", STORED)
def test_stored_tables_have_the_columns_of_those_made_today(name):
    """A table of nothing is its line of names."""
    with (ROOT / "results" / name).open(encoding="utf-8", newline="") as file:
        assert file.readline() == STORED[name].to_csv()


@pytest.mark.parametrize("name", sorted(each.stem for each in SHIPPED.glob("*.npz")))
def test_shipped_agents_do_in_fresh_trials_what_their_files_say(name):
    source = find_agent(name)
    with np.load(SHIPPED / f"{name}.npz", allow_pickle=False) as stored:
        recorded = stored["successes"][0]
    fresh = (
        evaluate(source.genotype, source.condition, source.readings, trial_seed=3).successes[0].sum(axis=1)
    )
    # Four standard deviations of the difference of two counts of 80, and what selection adds to the record.
    spread = np.sqrt(2 * np.maximum(recorded * (80 - recorded), 80) / 80)
    assert (np.abs(fresh - recorded) <= 4 * spread + 8).all()
