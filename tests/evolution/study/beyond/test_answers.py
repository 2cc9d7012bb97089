"""Cells against the paper's task, on made-up runs: plain loops, what is compared with what, what is said."""

import csv
from dataclasses import replace
from itertools import combinations

import numpy as np
import pytest

from arm2d import Condition, Instruction
from evolution.results.statistics import proportion_interval, proportions_interval
from evolution.study.beyond.answers import effects_of, sentences
from evolution.study.beyond.cells import BY_NAME, CELLS
from evolution.study.beyond.comparisons import comparisons, verdict_of
from evolution.study.beyond.groups import groups_of
from evolution.study.beyond.outcomes import ALL_UNDERSTOOD, OUTCOMES, PLATEAU, SOLVED, TESTED, UNDERSTOOD
from evolution.study.beyond.results import cell_table, comparison_table
from tests.evolution.study.beyond.made_up import AGENTS, CONFIGS, SEEDS, made_study, made_up

BLUE, GREEN = Instruction.parse("move blue"), Instruction.parse("touch green")


def group_of(groups, name, third="indicate"):
    return next(g for g in groups if g.cell.name == name and g.runs[0].config.task.third == third)


def comparison(found, name, outcome, third="indicate"):
    condition = {"indicate": Condition.WITH_INDICATE, "ignore": Condition.WITH_IGNORE}[third]
    return next(
        each
        for each in found
        if (each.group.cell.name, each.outcome, each.paper.task) == (name, outcome, condition)
    )


def test_groups_hold_the_runs_of_their_cell_by_seed(groups):
    shuffled = groups_of(np.random.default_rng(1).permutation(np.array(made_study(SEEDS), object)))
    for one, other in zip(groups, shuffled, strict=True):
        assert [run.config for run in one.runs] == [run.config for run in other.runs]
        assert [run.config.seed for run in one.runs] == list(SEEDS)
        assert {(run.cell, run.config.condition) for run in one.runs} == {(one.cell.name, one.task)}
    assert len(groups) == 19


def test_estimates_are_what_plain_loops_give(groups):
    for group in groups:
        n, held_out = len(group.runs), group.held_out
        solved = sum(run.first_solved >= 0 for run in group.runs)
        largest = group.runs[0].config.task.largest_fitness
        shares = [np.mean([run.understood[word] for word in held_out]) / AGENTS for run in group.runs]
        all_of_them = sum(run.all_understood > 0 for run in group.runs)
        assert group.estimate(SOLVED).value == pytest.approx(solved / n)
        assert group.estimate(PLATEAU).value == pytest.approx(
            sum(r.plateau / largest for r in group.runs) / n
        )
        assert group.estimate(UNDERSTOOD).value == pytest.approx(sum(shares) / n)
        assert group.estimate(ALL_UNDERSTOOD).value == pytest.approx(all_of_them / n)
        own = group.estimate(SOLVED)
        assert (own.low, own.high) == proportion_interval(solved, n)
        for outcome in OUTCOMES:
            own = group.estimate(outcome)
            assert own.low <= own.value <= own.high


def test_bootstrap_interval_is_about_twice_the_standard_error_to_either_side(groups):
    own = group_of(groups, "paper")
    shares = PLATEAU.values(own.runs, own.held_out)
    error = shares.std(ddof=1) / np.sqrt(len(shares))
    estimate = own.estimate(PLATEAU)
    assert estimate.high - estimate.low == pytest.approx(2 * 1.96 * error, rel=0.2)


def test_every_cell_is_compared_with_the_paper_s_task_in_its_condition(found):
    assert len(found) == len(TESTED) * 9 * 2
    for cell in CELLS[1:]:
        own = [each for each in found if each.group.cell == cell and each.outcome == SOLVED]
        assert [each.paper.task for each in own] == list(Condition)
        for each in own:
            third = each.group.runs[0].config.task.third
            assert third in ("both", each.paper.runs[0].config.task.third)


def test_p_is_the_share_of_exchanges_of_runs_that_are_as_far_off(found):
    for name, outcome in (("five-neurons", PLATEAU), ("dealt", SOLVED), ("without-four", UNDERSTOOD)):
        each = comparison(found, name, outcome)
        words = [BLUE, GREEN]
        values = np.r_[outcome.values(each.group.runs, words), outcome.values(each.paper.runs, words)]
        off = abs(values[:8].mean() - values[8:].mean())
        far = total = 0
        for chosen in combinations(range(16), 8):
            mask = np.isin(np.arange(16), chosen)
            far += abs(values[mask].mean() - values[~mask].mean()) >= off - 1e-12
            total += 1
        assert each.p == pytest.approx(far / total)
        assert each.difference.value == pytest.approx(values[:8].mean() - values[8:].mean())


def test_only_what_both_hold_out_is_compared(found):
    """The cell that holds out MOVE Blue alone is compared by MOVE Blue alone, and so is the paper's task."""
    for name, word in (("without-move-blue", BLUE), ("without-touch-green", GREEN)):
        each = comparison(found, name, UNDERSTOOD)
        theirs = np.mean([run.understood[word] / AGENTS for run in each.paper.runs])
        assert each.means[1] == pytest.approx(theirs)
        assert each.means[0] == pytest.approx(
            np.mean([run.understood[word] / AGENTS for run in each.group.runs])
        )
    four = comparison(found, "without-four", UNDERSTOOD)
    own = [np.mean([run.understood[word] for word in (BLUE, GREEN)]) / AGENTS for run in four.group.runs]
    assert four.means[0] == pytest.approx(np.mean(own))


def test_shares_of_runs_differ_with_newcombe_s_interval(found):
    each = comparison(found, "dealt", SOLVED)
    counted = [(sum(run.solved for run in own.runs), len(own.runs)) for own in (each.group, each.paper)]
    assert (each.difference.low, each.difference.high) == proportions_interval(*counted)


def test_all_comparisons_are_corrected_together_by_holm_s_method(found):
    order = sorted(found, key=lambda each: each.p)
    largest = 0.0
    for place, each in enumerate(order):
        largest = max(largest, min(1.0, each.p * (len(order) - place)))
        assert each.corrected == pytest.approx(largest)


def test_what_was_made_to_differ_is_found_and_nothing_else(found):
    told = {(each.group.cell.name, each.outcome.name): each.verdict for each in found}
    assert told["dealt", "plateau"] == "less"
    assert told["five-neurons", "plateau"] == "more"
    assert told["without-four", "understood"] == "more"
    for name in ("twelve", "object-first", "action-first", "eight-neurons", "without-move-blue"):
        assert {told[name, outcome.name] for outcome in TESTED} == {"undecided"}


def one_cell(level, paper, name="twelve"):
    """Runs of a cell that all end at one plateau, and of the paper's task in both conditions likewise."""
    ends = {(name, "both"): level, ("paper", "indicate"): paper[0], ("paper", "ignore"): paper[1]}
    runs = [made_up(config) for config in CONFIGS if config.seed in SEEDS]
    rng = np.random.default_rng(2)
    return [
        replace(run, plateau=run.config.task.largest_fitness * (ends[key] + rng.normal(0, 0.001)))
        for run in runs
        if (key := (run.cell, run.config.task.third)) in ends
    ]


@pytest.mark.parametrize(
    ("level", "paper", "verdict"),
    [(0.9, (0.7, 0.8), "more"), (0.6, (0.7, 0.8), "less"), (0.75, (0.7, 0.8), "undecided"),
     (0.8, (0.7, 0.8), "undecided")],
)  # fmt: skip
def test_twelve_instructions_differ_if_they_do_from_both_conditions(level, paper, verdict):
    groups = groups_of(one_cell(level, paper))
    assert verdict_of(group_of(groups, "twelve", "both"), PLATEAU, comparisons(groups)) == verdict


def test_without_both_comparisons_nothing_is_said_of_twelve_instructions():
    runs = [run for run in one_cell(0.9, (0.7, 0.8)) if run.config.task.third != "ignore"]
    found = comparisons(groups := groups_of(runs))
    assert {each.verdict for each in found if each.outcome == PLATEAU} == {"more"}
    assert verdict_of(group_of(groups, "twelve", "both"), PLATEAU, found) == "undecided"


def test_tasks_that_all_end_at_their_limits_do_not_differ():
    """As they are measured and read, to six digits, which 18/7 is not."""
    runs = [replace(run, plateau=round(run.config.task.largest_fitness, 6)) for run in made_study(SEEDS)]
    assert {run.relative_plateau for run in runs} == {1.0}
    ends = [each for each in comparisons(groups_of(runs)) if each.outcome == PLATEAU]
    assert {each.p for each in ends} == {1.0}


def test_understanding_that_goes_with_success_is_said_to_do_so(groups, found):
    """Beside it stands what those understand that obey, over what both hold out."""
    four = BY_NAME["without-four"]
    alone = sentences(groups, found)
    assert "without-four helps understanding" in alone
    assert not any("is understood where" in line for line in alone)
    with_success = [
        replace(each, corrected=0.01, difference=replace(each.difference, value=0.1))
        if each.group.cell == four and each.outcome == SOLVED
        else each
        for each in found
    ]
    (line,) = [line for line in sentences(groups, with_success) if "is understood where" in line]
    assert line.startswith("without-four: more is understood where evolution succeeds more; ")
    for third in ("indicate", "ignore"):
        shares = [
            100 * np.mean([np.mean([run.understood[w] for w in (BLUE, GREEN)]) / run.obeying for run in runs])
            for runs in (group_of(groups, name, third).runs for name in ("without-four", "paper"))
        ]
        assert f"with-{third} {shares[0]:.1f} % ({shares[1]:.1f} % in the paper's task)" in line


def test_where_no_agent_obeys_it_is_said_that_none_does():
    runs = [
        made_up(run.config, 0.1) if run.cell == "dealt" else replace(run, first_solved=1)
        for run in made_study(SEEDS)
    ]
    groups = groups_of(runs)
    (line,) = [line for line in sentences(groups, comparisons(groups)) if "is understood where" in line]
    assert line.startswith("dealt: less is understood where evolution succeeds less; ")
    assert line.count("none, for none obeys (") == 2
    assert "nan" not in line


@pytest.mark.parametrize(
    ("level", "paper", "said"),
    [(0.9, (0.7, 0.8), ["twelve helps evolution"]), (0.6, (0.7, 0.8), ["twelve hinders evolution"]),
     (0.75, (0.7, 0.8), []), (0.8, (0.7, 0.8), [])],
)  # fmt: skip
def test_what_is_said_of_twelve_instructions_is_said_by_both_comparisons_or_not_at_all(level, paper, said):
    groups = groups_of(one_cell(level, paper))
    found = comparisons(groups)
    told = sentences(groups, found)
    assert told[2:] == said
    assert [line.split(": ")[0] for line in told[:2]] == (
        ["twelve, with-indicate", "twelve, with-ignore"] if said else []
    )


def test_a_change_helps_or_hinders_if_one_condition_says_so_and_none_the_contrary(groups, found):
    dealt, cells = BY_NAME["dealt"], {group.cell.name: group.cell for group in groups}
    assert effects_of(dealt, groups, found)["evolution"] == "hinders"
    assert "dealt hinders evolution" in sentences(groups, found)
    own = [each for each in found if each.group.cell == dealt and each.outcome == PLATEAU]
    turned = replace(own[0], difference=replace(own[0].difference, value=-own[0].difference.value))
    contrary = [turned if each is own[0] else each for each in found]
    assert effects_of(cells["dealt"], groups, contrary)["evolution"] == "undecided"


def test_runs_without_agents_that_obey_are_left_out_of_what_those_understand():
    runs = [
        made_up(each, obeying=n, understood=(n // 2,)) for each, n in zip(CONFIGS, (0, 100), strict=False)
    ]
    (group,) = groups_of([runs[0], replace(runs[1], config=replace(runs[0].config, seed=202))])
    assert (len(group.runs), group.obeying_runs) == (2, 1)
    assert group.of_obeying(group.held_out) == pytest.approx(0.25)
    assert np.isnan(groups_of(runs[:1])[0].of_obeying(group.held_out))


def test_cells_of_one_run_are_told_but_not_compared():
    groups = groups_of(made_study(range(201, 202)))
    assert comparisons(groups) == []
    assert len(list(csv.DictReader(cell_table(groups).to_csv().splitlines()))) == 19
    assert comparison_table([]).to_csv().startswith("cell,condition,outcome")


def test_tables_tell_every_group_and_comparison_with_its_own_numbers(groups, found):
    rows = list(csv.DictReader(cell_table(groups).to_csv().splitlines()))
    for row, group in zip(rows, groups, strict=True):
        assert (row["cell"], int(row["runs"])) == (group.cell.name, 8)
        for outcome in OUTCOMES:
            own = group.estimate(outcome)
            told = [float(row[f"{outcome.name}{end}"]) for end in ("", " low", " high")]
            assert told == pytest.approx([own.value, own.low, own.high], abs=5.1e-5)
        first = sorted(run.first_solved for run in group.runs if run.solved)
        assert row["median generation of the solved"] == (str(int(np.median(first))) if first else "")
        among = [np.mean([*run.understood.values()]) / run.obeying for run in group.runs]
        assert float(row["understood, of these"]) == pytest.approx(np.mean(among), abs=5.1e-5)
        assert int(row["runs with such agents"]) == 8
        for column, of_held_out in (("success, held out", True), ("success, experienced", False)):
            run = group.runs[0]  # all are made up alike in this
            own = [s for w, s in run.successes.items() if (w in run.config.task.held_out) is of_held_out]
            assert float(row[column]) == pytest.approx(np.mean(own), abs=5.1e-5)
    rows = list(csv.DictReader(comparison_table(found).to_csv().splitlines()))
    for row, each in zip(rows, found, strict=True):
        assert (row["cell"], row["condition"], row["verdict"]) == (
            each.group.cell.name, str(each.paper.task), each.verdict,
        )  # fmt: skip
        assert row["said of the cell"] == verdict_of(each.group, each.outcome, found)
        told = [row[f"of those that obey{end}"] for end in ("", " in the paper's task")]
        if each.outcome == UNDERSTOOD:
            own = [group.of_obeying(each.words) for group in (each.group, each.paper)]
            assert [float(number) for number in told] == pytest.approx(own, abs=5.1e-5)
        else:
            assert told == ["", ""]
        assert float(row["mean"]) - float(row["mean of the paper's task"]) == pytest.approx(
            float(row["difference"]), abs=1.1e-4
        )


def test_a_verdict_is_said_with_sign_interval_and_p(found):
    each = comparison(found, "dealt", PLATEAU)
    assert each.sentence.startswith("dealt, with-indicate: plateau less, -")
    assert each.sentence.endswith(f"p = {each.corrected:.2g} after Holm")
    assert BY_NAME["dealt"] == each.group.cell
