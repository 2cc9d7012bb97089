"""The page beyond the paper against the rows that its answers are counted from."""

import re
from pathlib import Path

import numpy as np
import pytest

from evolution.results.wording import TITLES
from evolution.study.beyond.answers import SUBJECTS, effects_of
from evolution.study.beyond.cells import BY_NAME, PAPER
from evolution.study.beyond.comparisons import comparisons, verdict_of
from evolution.study.beyond.figure import drawn_words
from evolution.study.beyond.groups import groups_of
from evolution.study.beyond.outcomes import ALL_UNDERSTOOD, PLATEAU, SOLVED, UNDERSTOOD
from evolution.study.beyond.results import cell_table, comparison_table
from evolution.study.beyond.rows import read_rows

DOCS = Path(__file__).parents[2] / "docs"
RESULTS = DOCS / "results"
PAGE = (DOCS / "beyond.md").read_text(encoding="utf-8")
RUNS = read_rows(RESULTS / "beyond.csv")
GROUPS = groups_of(RUNS)


@pytest.fixture(scope="module")
def found():
    return comparisons(GROUPS)


def test_it_says_how_many_runs_are_measured():
    assert len({run.config for run in RUNS}) == len(RUNS)
    assert f"**{len(RUNS)} of 380 runs**" in PAGE


def test_its_tables_are_what_the_rows_say(found):
    for name, table in (("cells", cell_table(GROUPS)), ("comparisons", comparison_table(found))):
        assert (RESULTS / f"beyond-{name}.csv").read_text(encoding="utf-8") == table.to_csv()


def test_every_cell_stands_on_it_as_in_the_tables(found):
    for cell in dict.fromkeys(group.cell for group in GROUPS):
        assert row_of(cell, found) in PAGE


def row_of(cell, found):
    """A row of the page's table: the conditions one after the other, bold what has shown more or less."""
    own = [group for group in GROUPS if group.cell == cell]
    told = [
        *(
            ", ".join(shown(each, outcome, found) for each in own)
            for outcome in (SOLVED, PLATEAU, UNDERSTOOD)
        ),
        ", ".join(of_obeying(each) for each in own),
        ", ".join(f"{ALL_UNDERSTOOD.values(each.runs, ()).sum():.0f}" for each in own),
    ]
    return f"| {cell.title} | {' | '.join(told)} |"


def shown(group, outcome, found):
    values = outcome.values(group.runs, drawn_words(group, outcome))
    text = f"{values.sum():.0f}" if outcome is SOLVED else f"{100 * values.mean():.1f}"
    return text if verdict_of(group, outcome, found) == "undecided" else f"**{text}**"


def of_obeying(group):
    share = group.of_obeying(drawn_words(group, UNDERSTOOD))
    return "none obeys" if np.isnan(share) else f"{100 * share:.1f}"


def test_it_says_what_each_change_does_and_nothing_else(found):
    said = set(re.findall(r"`([\w-]+)` (helps|hinders) (evolution|understanding)", PAGE))
    cells = [cell for cell in BY_NAME.values() if cell != PAPER]
    effects = {
        (cell.name, effect, subject)
        for cell in cells
        for subject, effect in effects_of(cell, GROUPS, found).items()
        if effect != "undecided"
    }
    assert said == effects
    assert {subject for _, _, subject in effects} <= set(SUBJECTS)


def test_what_shows_a_verdict_stands_on_it_with_its_numbers(found):
    names = {"solved": "runs that solve", "plateau": "plateau", "understood": "understood"}
    for each in found:
        if each.verdict != "undecided":
            own = each.difference
            value, low, high = 100 * own.value, 100 * own.low, 100 * own.high
            told = f"{TITLES[each.paper.task]}: {names[each.outcome.name]} {value:+.0f} points"
            assert f"{told} [{low:.0f}, {high:.0f}], p = {each.corrected:.2g}" in PAGE
