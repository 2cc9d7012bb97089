"""docs/results.md against the numbers it stands on, docs/results/results.npz."""

import csv
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
PAGE = (ROOT / "results.md").read_text(encoding="utf-8")
EMPTY = results({})


@pytest.fixture(scope="module")
def arrays():
    with np.load(ROOT / "results" / "results.npz", allow_pickle=False) as stored:
        return {name: stored[name] for name in stored.files}


def agents(arrays, condition):
    """Successes [R, L, 5, 9]."""
    return arrays[f"{condition}.successes"].astype(int)


def test_category_ten_of_table_ii_is_what_the_page_says(arrays):
    columns = {c: count_table(categories(agents(arrays, c).reshape(-1, 9), c))[10] for c in Condition}
    for row, subtask in enumerate(("I, the seven", "II, with MOVE", "III, with TOUCH", "IV, all nine")):
        (line,) = [line for line in PAGE.splitlines() if line.startswith(f"| {subtask}")]
        cells = [int(cell) for cell in line.split("|")[2:-1]]
        assert cells[1::2] == [int(columns[condition][row]) for condition in Condition]


def test_the_papers_kind_of_test_tells_halves_of_one_condition_apart(arrays):
    """Why the run has to be the unit: told that ten runs are five of either condition, only the paper's kind
    of test finds that the conditions differ."""
    successes = agents(arrays, Condition.WITH_INDICATE)
    halves = dict(zip(Condition, (successes[:5], successes[5:]), strict=True))
    found = results({condition: condition_results(condition, half) for condition, half in halves.items()})
    name = "sub-task I, category 10"
    assert found.published_tests[name][1] < 1e-40
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
def test_tables_made_again_from_the_archive_have_the_stored_bytes(stored, name, table):
    assert table(stored).to_csv().encode() == (ROOT / "results" / f"{name}.csv").read_bytes()


def test_runs_made_again_from_the_archive_have_the_stored_values(stored):
    unknown = {"plateau", "distinct genotypes", "longest stay among the five best"}
    with (ROOT / "results" / "runs.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    again = list(csv.DictReader(run_table(stored).to_csv().splitlines()))
    assert len(rows) == 20
    for row, made in zip(rows, again, strict=True):
        assert {name: row[name] for name in row.keys() - unknown} == {
            n: made[n] for n in row.keys() - unknown
        }
    for row, found in zip(rows, stored.analysed_runs, strict=True):
        last = found.results.best[found.index, -1000:]
        assert float(row["plateau"]) == pytest.approx(np.median(last), abs=5.1e-5)


STORED: Final = {
    "table-ii.csv": table_ii(EMPTY),
    "runs.csv": run_table(EMPTY),
    "transitions.csv": transition_table(EMPTY),
    "tests.csv": significance_table(EMPTY),
    "generalisers.csv": generaliser_table(EMPTY),
    "generaliser-genotypes.csv": genotype_table(EMPTY),
    "classes.csv": class_table([], Sampling()),
    "classes-runs.csv": class_run_table([]),
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
