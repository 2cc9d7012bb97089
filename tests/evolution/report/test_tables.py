"""Made-up results, all of whose numbers differ, read back from the tables of report and files."""

import csv
from dataclasses import replace

import numpy as np
import pytest

from arm2d import Condition
from evolution.agents.subtasks import AgentClass
from evolution.report.columns import PlainTable
from evolution.report.comparison import comparison_table, key_number_table
from evolution.report.rows import (
    generaliser_table,
    genotype_table,
    run_table,
    significance_table,
    table_ii,
    transition_table,
)
from evolution.report.tables import category_tables, main_lines, shown_runs, shown_tests
from evolution.results import published
from evolution.results.statistics import Comparison
from evolution.results.wording import TITLES
from tests.evolution.made_up import both_conditions, condition_results, random_successes, results

INDICATE = Condition.WITH_INDICATE


@pytest.fixture(scope="module")
def experiment():
    found = both_conditions()
    comparisons = {
        name: Comparison(
            (0.1 + i, 0.2 + i), 0.3 + i, (0.4 + i, 0.5 + i), 0.06 + i / 50, 0.07 + i / 50, 0.8 - i / 9
        )
        for i, name in enumerate(found.comparisons)
    }
    tests = {name: (9.0 + i, 0.011 + i / 50) for i, name in enumerate(comparisons)}
    return replace(found, comparisons=comparisons, published_tests=tests)


def rows_of(table):
    """A table as programs read it."""
    return list(csv.DictReader(table.to_csv().splitlines()))


def test_a_table_of_nothing_is_its_line_of_names():
    table = PlainTable({"a": lambda thing: thing, "b, c": lambda thing: 2 * thing}, [])
    assert table.to_csv() == 'a,"b, c"\n'
    assert replace(table, things=[1, 3]).rows() == [{"a": 1, "b, c": 2}, {"a": 3, "b, c": 6}]


def test_transitions_are_told_by_class_word_and_run(experiment):
    rows = {(row["condition"], row["class"]): row for row in rows_of(transition_table(experiment))}
    for condition, found in experiment.conditions.items():
        for kind, outcome in found.transitions.items():
            row = rows[condition, kind]
            assert int(row["agents"]) == outcome.agents
            assert (int(row["pass action"]), int(row["pass object"])) == (
                outcome.action_passed,
                outcome.object_passed,
            )
            assert (int(row["runs action"]), int(row["runs object"])) == (
                outcome.runs_action,
                outcome.runs_object,
            )


def test_the_main_table_tells_who_passes_which_transition(experiment):
    lines = {line.what: line.pairs for line in main_lines(experiment)}
    for place, found in enumerate(experiment.conditions.values()):
        for kind, outcome in found.transitions.items():
            for word in ("action", "object"):
                passed, runs = getattr(outcome, f"{word}_passed"), getattr(outcome, f"runs_{word}")
                ours = lines[f"{kind} agents that pass the {word} transition"][place][1]
                assert ours == f"{passed} of {outcome.agents}, in {runs} runs"
    # Fig. 4 in the paper's words: without INDICATE, agents pass one of the two only.
    _, ignore = lines[f"{AgentClass.PARTIAL} agents that pass the action transition"]
    assert ignore[0] == "none"
    _, ignore = lines[f"{AgentClass.PARTIAL} agents that pass the object transition"]
    assert ignore[0] == "some"


def test_the_main_table_has_paper_and_ours_in_their_places(experiment):
    lines = {line.what.split(":")[0]: line.pairs for line in main_lines(experiment)}
    for place, (condition, found) in enumerate(experiment.conditions.items()):
        for column, subtask in enumerate(("I", "II", "III", "IV")):
            theirs, ours = lines[f"agents in category 10 of sub-task {subtask}"][place]
            assert theirs.endswith(f"({published.TABLE_II[condition][10, column]:,})")
            assert ours.endswith(f"({found.counts[10, column]})")
        assert lines["runs that end at the largest fitness, 18/7"][place] == ("10 of 10", "1 of 3")
        n = (found.members[AgentClass.FULL] > 0).sum()
        theirs = "6 of 10" if condition is INDICATE else "not given"
        assert lines["runs with fully compositional agents"][place] == (theirs, f"{n} of 3")
        assert lines["runs in which one genotype solved all 28 trials"][place][1] == (
            "2 of 3 (seed 2: generation 999, seed 3: generation 1,999)"
        )


def test_table_ii_has_paper_and_ours_in_their_places(experiment):
    stored = {(row["condition"], row["category"]): row for row in rows_of(table_ii(experiment))}
    shown = dict(category_tables(experiment))
    for condition, found in experiment.conditions.items():
        for category in range(11):
            row, line = stored[condition, str(category)], shown[TITLES[condition]][category]
            for column, subtask in enumerate(("I", "II", "III", "IV")):
                theirs, ours = published.TABLE_II[condition][category, column], found.counts[category, column]
                assert (int(row[f"paper {subtask}"]), int(row[f"ours {subtask}"])) == (theirs, ours)
                assert line.pairs[column] == (f"{theirs:,}", str(ours))


def test_every_test_stands_under_its_name(experiment):
    stored, shown = rows_of(significance_table(experiment)), shown_tests(experiment).rows()
    for row, text, (name, sound) in zip(stored, shown, experiment.comparisons.items(), strict=True):
        assert row["compared"] == next(iter(text.values())) == name
        numbers = (*sound.means, sound.difference, *sound.interval, sound.mann_whitney_p, sound.permutation_p)
        names = (
            "With-Indicate",
            "With-Ignore",
            "difference",
            "95 % low",
            "95 % high",
            "Mann-Whitney p",
            "permutation p",
        )
        published_p = experiment.published_tests[name][1]
        for column, number in zip(
            (*names, "Cliff's delta", "Wilcoxon p as published"),
            (*numbers, sound.cliffs_delta, published_p),
            strict=True,
        ):
            assert float(row[column]) == pytest.approx(number, rel=1e-3)
        assert float(text["Mann-Whitney p"]) == pytest.approx(sound.mann_whitney_p, rel=0.05)
        assert float(text["permutation p"]) == pytest.approx(sound.permutation_p, rel=0.05)
        assert float(text["paper’s kind, p"]) == pytest.approx(published_p, rel=0.05)  # noqa: RUF001 - as printed
        assert [text[TITLES[condition]] for condition in Condition] == [
            f"{100 * m:.1f} %" for m in sound.means
        ]


def test_runs_are_told_with_their_own_numbers(experiment):
    stored, shown = rows_of(run_table(experiment)), shown_runs(experiment).rows()
    assert len(stored) == len(shown) == 6
    for place, (row, text) in enumerate(zip(stored, shown, strict=True)):
        condition, run = list(Condition)[place // 3], place % 3
        found = experiment.conditions[condition]
        assert (row["condition"], row["seed"]) == (condition, str(run + 1))
        assert text["run"] == f"{TITLES[condition]}, seed {run + 1}"
        assert float(row["plateau"]) == pytest.approx(found.plateau[run], abs=5e-5)
        assert float(text["plateau"]) == pytest.approx(found.plateau[run], abs=5e-4)
        assert row["first generation that solved all trials"] == ("never", "999", "1999")[run]
        assert text["solved all 28"] == ("never", "999", "1,999")[run]
        assert (row["distinct genotypes"], row["longest stay among the five best"]) == (
            str(1101 + run),
            str(1201 + run),
        )
        for kind, short in zip(AgentClass, ("fully", "partially", "non-comp."), strict=True):
            assert row[kind] == text[short] == str(found.members[kind][run])
        for column, subtask in enumerate(("I", "II", "III", "IV")):
            top = found.counts_per_run[run, 10, column]
            assert text[subtask] == str(top)
            assert float(row[f"share in category 10, sub-task {subtask}"]) == pytest.approx(top / 20)


def test_generalisers_are_told_by_rank_spell_and_stay():
    members = np.zeros((6, 5), bool)
    members[[0, 1, 3, 4, 5], [0, 2, 2, 2, 4]] = True
    successes = np.full((1, 6, 5, 9), 70)
    successes[0][~members] = 30
    experiment = results({INDICATE: condition_results(INDICATE, successes)})
    (row,) = rows_of(generaliser_table(experiment))
    assert [row[f"at rank {rank}"] for rank in range(5)] == ["1", "0", "3", "0", "1"]
    expected = {
        "fully compositional agents": "5",
        "most in a generation": "1",
        "mean rank": "2.00",
        "mean rank by chance": "2",
        "spells": "2",
        "generations with one": "5",
        "longest spell": "3",
        "distinct genotypes": "2",
        "longest stay among the five best": "1302",
        "found fully compositional in that stay": "1402",
        "longest line": "1501",
    }
    assert {name: row[name] for name in expected} == expected
    genotypes = rows_of(genotype_table(experiment))
    assert [list(genotype.values())[2:] for genotype in genotypes] == [
        ["100", "1301", "1401"],
        ["101", "1302", "1402"],
    ]


def test_experiments_side_by_side_have_their_own_columns(experiment):
    condition = Condition.WITH_IGNORE
    other = results({condition: condition_results(condition, random_successes(condition, n_runs=2, seed=9))})
    rows = {
        (row["condition"], row["number"]): row
        for row in rows_of(key_number_table({"a": experiment, "b": other}))
    }
    row = rows[condition, "share of agents in category 10, sub-task II"]
    for name, found in (("a", experiment), ("b", other)):
        share = found.conditions[condition].share_in_top("II")
        values = [float(row[column]) for column in (name, f"{name}, lowest run", f"{name}, highest run")]
        assert values == pytest.approx([share.mean(), share.min(), share.max()], abs=5e-5)
        assert int(row[f"{name}, of"]) == found.conditions[condition].n_agents
    assert float(row["published"]) == pytest.approx(0.01195, abs=5e-5)
    alone = rows[INDICATE, "plateau"]
    assert [alone[f"b{part}"] for part in ("", ", of", ", lowest run", ", highest run")] == [""] * 4


def test_the_terminal_shows_the_numbers_of_the_table(experiment):
    condition = Condition.WITH_IGNORE
    other = results({condition: condition_results(condition, random_successes(condition, n_runs=2, seed=9))})
    found = {"a": experiment, "b": other}
    table = comparison_table(found)
    assert [column.header for column in table.columns] == ["condition", "number", "published", "a", "b"]
    shown = list(zip(*(column.cells for column in table.columns), strict=True))
    stored = rows_of(key_number_table(found))
    assert len(shown) == len(stored) > 30
    for cells, row in zip(shown, stored, strict=True):
        assert cells[:2] == (TITLES[Condition(row["condition"])], row["number"])
        for cell, name in zip(cells[2:], ("published", "a", "b"), strict=True):
            if not row[name]:
                assert cell == "-"
            elif cell.endswith("%"):
                assert float(cell.removesuffix(" %")) == pytest.approx(100 * float(row[name]), abs=0.06)
            elif " of " in cell:
                n = published.RUNS if name == "published" else int(row[f"{name}, of"])
                assert cell == f"{float(row[name]):.0f} of {n}"
            else:
                assert float(cell) == pytest.approx(float(row[name]), abs=6e-4)
