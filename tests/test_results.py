"""docs/results.md against the numbers it stands on, docs/results/results.npz."""

from pathlib import Path

import numpy as np
import pytest

from arm2d import Condition
from evolution.agents.subtasks import categories, count_table
from evolution.results.statistics import wilcoxon_as_published
from evolution.runs.sources import SHIPPED, find_source
from evolution.search.evaluation import evaluate

ROOT = Path(__file__).parents[1] / "docs"
PAGE = (ROOT / "results.md").read_text(encoding="utf-8")


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
    """Why the run has to be the unit."""
    successes = agents(arrays, Condition.WITH_INDICATE).swapaxes(0, 1)  # [L, R, 5, 9]
    halves = [
        np.array(
            [np.mean(categories(each.reshape(-1, 9), Condition.WITH_INDICATE)[:, 0] == 10) for each in half]
        )
        for half in (successes[:, :5], successes[:, 5:])
    ]
    assert wilcoxon_as_published(*halves)[1] < 1e-40


@pytest.mark.parametrize("name", sorted(each.stem for each in SHIPPED.glob("*.npz")))
def test_shipped_agents_do_in_fresh_trials_what_their_files_say(name):
    source = find_source(name)
    with np.load(SHIPPED / f"{name}.npz", allow_pickle=False) as stored:
        recorded = stored["successes"][0]
    fresh = (
        evaluate(source.genotype, source.condition, source.readings, trial_seed=3).successes[0].sum(axis=1)
    )
    # Four standard deviations of the difference of two counts of 80, and what selection adds to the record.
    spread = np.sqrt(2 * np.maximum(recorded * (80 - recorded), 80) / 80)
    assert (np.abs(fresh - recorded) <= 4 * spread + 8).all()
