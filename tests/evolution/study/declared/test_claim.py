"""The tests of the claim on made-up counts: what is there is found, what is not is not, runs are the unit."""

import csv
from dataclasses import replace

import numpy as np
import pytest
from scipy.stats import betabinom

from arm2d import Condition, Readings
from evolution.cli import main
from evolution.experiments.plan import TESTING
from evolution.results.statistics import proportions_interval
from evolution.runs.interrupt import StopRequest
from evolution.study.declared.beta_binomial import compare_counts
from evolution.study.declared.claim import (
    FULL,
    HAVING,
    QUESTIONS,
    answer_table,
    answers,
    averaged_over_worlds,
    shares_by_world,
    verdict,
)
from evolution.study.declared.claim_figure import claim_figure
from evolution.study.declared.confirmation.worlds import hundred
from evolution.study.declared.parts import DeclaredPart
from evolution.study.declared.plan import RowFile, carry_out
from evolution.study.declared.regression import Estimate
from evolution.study.declared.rows import write_rows
from tests.evolution.study.declared.synthetic import configs, made_up, made_up_answers, runs_with_effects

AGENTS = 10_000


def counts(mean, precision, runs, rng, n=AGENTS):
    """Counts of runs whose shares follow a beta distribution."""
    k = rng.binomial(n, rng.beta(mean * precision, (1 - mean) * precision, runs))
    return k, np.full(runs, n)


def runs_of(default, shares, rng, seeds=9):
    """So many runs of each condition with these mean shares of fully compositional agents."""
    made = []
    for config in hundred(default).configs:
        if config.readings == default and config.seed <= seeds:
            k = int(counts(shares[config.condition], 0.5, 1, rng)[0][0])
            known = dict.fromkeys(("masters", "masters that understand MOVE Blue"), max(k, 5000))
            made.append(made_up(config, agents=AGENTS, **{FULL: k}, **known))
    return made


def test_beta_binomial_model_finds_mean_and_correlation():
    rng = np.random.default_rng(0)
    found = compare_counts(counts(0.2, 3.0, 400, rng), counts(0.4, 9.0, 400, rng))
    assert found.means == pytest.approx((0.2, 0.4), abs=0.03)
    assert found.correlations == pytest.approx((0.25, 0.1), abs=0.04)
    assert found.p < 1e-6


def test_likelihood_is_that_of_the_distribution():
    """Among models with these means and correlations none is likelier than the one found."""
    rng = np.random.default_rng(1)
    k, n = counts(0.3, 2.0, 60, rng, n=50)
    found = compare_counts((k, n), (k, n))
    s = 1 / found.correlations[0] - 1
    best = betabinom.logpmf(k, n, found.means[0] * s, (1 - found.means[0]) * s).sum()
    for mean, precision in (
        (found.means[0] * 1.05, s),
        (found.means[0] / 1.05, s),
        (found.means[0], 1.1 * s),
        (found.means[0], s / 1.1),
    ):
        assert betabinom.logpmf(k, n, mean * precision, (1 - mean) * precision).sum() < best
    assert found.p == pytest.approx(1.0, abs=1e-3)


def test_no_difference_is_claimed_more_often_than_promised():
    """Of 40 pairs of groups without a difference, as scattered as runs are, some two have p < 0.05."""
    rng = np.random.default_rng(2)
    p = [compare_counts(counts(0.1, 0.4, 40, rng), counts(0.1, 0.4, 40, rng)).p for _ in range(40)]
    assert np.mean(np.array(p) < 0.05) <= 0.15
    assert np.mean(np.array(p) > 0.5) > 0.3


def test_thousands_of_related_agents_are_no_evidence_by_themselves():
    """Four of twenty runs with 5000 of them each against two: 20,000 against 10,000 agents tell nothing."""
    first, second = np.zeros(20, int), np.zeros(20, int)
    first[:4], second[:2] = 5000, 5000
    n = np.full(20, AGENTS)
    assert compare_counts((first, n), (second, n)).p > 0.2


def test_condition_without_any_such_agent_can_be_compared():
    n = np.full(30, AGENTS)
    some = np.arange(30) * 100
    found = compare_counts((some, n), (np.zeros(30, int), n))
    # In one run of ten or more there might have been some: 0.86^30, no less.
    assert 1e-4 < found.p < 0.01
    assert found.means[1] < 0.001
    assert compare_counts((np.zeros(30, int), n), (np.zeros(30, int), n)).p > 0.5


def test_runs_without_agents_to_count_in_are_left_out():
    rng = np.random.default_rng(3)
    k, n = counts(0.3, 2.0, 30, rng)
    more = np.concatenate([k, [0, 0]]), np.concatenate([n, [0, 0]])
    assert compare_counts(more, (k, n)).means == pytest.approx(compare_counts((k, n), (k, n)).means)
    with pytest.raises(ValueError, match="no agents to count in"):
        compare_counts((k[:0], n[:0]), (k, n))


def test_interval_of_a_difference_of_proportions_is_newcombe_s():
    """The worked examples of his paper (1998), method 10: 56/70 - 48/80, 9/10 - 3/10 and 10/10 - 0/20."""
    assert proportions_interval((56, 70), (48, 80)) == pytest.approx((0.0524, 0.3339), abs=2e-4)
    assert proportions_interval((9, 10), (3, 10)) == pytest.approx((0.1705, 0.8090), abs=2e-4)
    assert proportions_interval((10, 10), (0, 20)) == pytest.approx((0.6791, 1.0), abs=2e-4)


INDICATE, IGNORE = Condition.WITH_INDICATE, Condition.WITH_IGNORE


@pytest.mark.slow
def test_claim_that_is_so_is_supported_and_its_contrary_contradicted():
    worlds = Estimate(0.01, -0.02, 0.04)
    rng = np.random.default_rng(4)
    first, *others = answers(runs_of(Readings(), {INDICATE: 0.4, IGNORE: 0.05}, rng, 40))
    assert first.question == "fully compositional agents"
    assert first.p == first.corrected < 0.01
    assert first.difference.low < 0.35 < first.difference.high
    assert all(each.p <= each.corrected for each in others)
    assert verdict(first, worlds).startswith("supported: +")
    turned, *_ = answers(runs_of(Readings(), {INDICATE: 0.05, IGNORE: 0.4}, rng, 40))
    assert verdict(turned, Estimate(-0.01, -0.02, 0.0)).startswith("contradicted: -")
    assert verdict(turned, Estimate(0.03, 0.01, 0.05)).startswith("depends on the reading: ")
    assert verdict(turned, worlds).startswith("undecided: ")


def test_claim_that_is_not_so_stays_undecided():
    first, *_ = answers(runs_of(Readings(), {INDICATE: 0.1, IGNORE: 0.1}, np.random.default_rng(5)))
    assert first.p > 0.05
    assert verdict(first, Estimate(0.01, -0.02, 0.04)).startswith("undecided: ")


def test_questions_that_no_run_can_answer_are_left_out():
    found = {
        each.question
        for each in answers(runs_of(Readings(), {INDICATE: 0.1, IGNORE: 0.1}, np.random.default_rng(6)))
    }
    assert "runs with fully compositional agents" in found
    assert "masters that understand MOVE Blue" in found
    # No agent is non-compositional here.
    assert not any(each.startswith("non-compositional agents that pass") for each in found)


def test_worlds_are_compared_with_themselves():
    """Worlds differ by far more than the conditions do; paired, the difference shows."""
    rng, shares = np.random.default_rng(7), {}
    runs = []
    for config in configs():
        base = shares.setdefault(config.seed, rng.uniform(0, 0.8))
        k = round(500 * (base + 0.04 * (config.condition is INDICATE) + rng.normal(0, 0.02)))
        run = made_up(config)
        runs.append(replace(run, counts={**run.counts, FULL: max(k, 0)}))
    pairs = shares_by_world(runs, QUESTIONS[0])
    assert pairs.shape == (150, 2)
    first, *_ = averaged_over_worlds(runs)
    # The means are of these worlds, not of those that one condition met alone.
    assert first.means == pytest.approx(tuple(pairs.mean(axis=0)))
    assert first.difference.value == pytest.approx(first.means[0] - first.means[1])
    assert first.difference.low > 0.02
    assert first.difference.high < 0.06
    assert first.p == pytest.approx(1 / 200_001)  # as few as signs are drawn


def test_worlds_answer_the_questions_that_runs_do_in_their_order(default_questions):
    """Runs that have agents of a class are counted, too: pairs of worlds in which one condition has."""
    runs = []
    for config in configs():
        one = made_up(config)
        k = int(config.seed % 2 == 0 or (config.seed % 5 == 0 and config.condition is INDICATE))
        runs.append(replace(one, counts={**one.counts, FULL: k}))
    found = averaged_over_worlds(runs)
    told = [each.question for each in found]
    assert told == [each for each in default_questions if each in told]
    having = found[1]
    assert having.question == "runs with fully compositional agents"
    both = {run.config.seed for run in runs if run.config.condition is INDICATE}
    both &= {run.config.seed for run in runs if run.config.condition is IGNORE}
    alone = sum(seed % 10 == 5 for seed in both)
    assert having.difference.value == pytest.approx(alone / len(both))
    assert having.p == pytest.approx(2.0 ** (1 - alone), rel=1e-9)


@pytest.fixture
def default_questions():
    first, *others = (question.name for question in QUESTIONS)
    return [first, *(f"runs with {kind} agents" for kind in HAVING), *others]


def test_ratio_is_of_the_means_and_told_only_where_enough_runs_have_any():
    """Its interval is that of whole runs drawn again and again, here by another way to draw them."""
    rng = np.random.default_rng(5)
    many = runs_of(Readings(), {INDICATE: 0.1, IGNORE: 0.3}, rng, seeds=30)
    ratio = answers(many)[0].ratio
    first, second = (
        np.array([run.share(FULL) for run in many if run.config.condition is condition])
        for condition in (INDICATE, IGNORE)
    )
    assert ratio.value == pytest.approx(first.mean() / second.mean())
    drawn = [rng.choice(first, 30).mean() / rng.choice(second, 30).mean() for _ in range(4000)]
    assert (ratio.low, ratio.high) == pytest.approx(np.quantile(drawn, [0.025, 0.975]), rel=0.1)
    few = [run for run in many if run.config.seed <= 9]
    assert np.isnan(answers(few)[0].ratio.value)
    assert answer_table([("few", answers(few))]).rows()[0]["ratio low"] == ""


def test_claim_is_written_by_one_command(tmp_path, capsys):
    rng = np.random.default_rng(8)
    (tmp_path / "factorial").mkdir()
    write_rows(runs_with_effects(1), tmp_path / "factorial" / "rows.csv")
    (tmp_path / "hundred").mkdir()
    made = runs_of(Readings(), {INDICATE: 0.2, IGNORE: 0.1}, rng)
    write_rows(made, tmp_path / "hundred" / "rows.csv")
    assert main(["study", "readings", "--part=hundred", f"--output={tmp_path}", "--now"]) == 0
    said = capsys.readouterr().out
    assert "printed readings: 0 and 0 runs of the conditions are measured; the tests need two of each" in said
    assert "INDICATE fosters compositionality: undecided: +" in said
    assert "18 of 240 runs are measured so far" in said
    with (tmp_path / "hundred" / "results" / "claim.csv").open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert {row["runs"] for row in rows} == {"default", "factorial worlds"}
    assert (tmp_path / "hundred" / "results" / "claim.png").is_file()


def test_without_the_worlds_the_claim_is_told_so_and_its_tables_are_written(tmp_path, capsys):
    """Who runs this part alone has hours behind him."""
    (tmp_path / "hundred").mkdir()
    made = runs_of(Readings(), {INDICATE: 0.2, IGNORE: 0.1}, np.random.default_rng(8))
    write_rows(made, tmp_path / "hundred" / "rows.csv")
    assert main(["study", "readings", "--part=hundred", f"--output={tmp_path}", "--now"]) == 0
    said = capsys.readouterr().out
    assert "no verdict yet, which asks for the worlds that both conditions met, too: 0 of 450 runs" in said
    with (tmp_path / "hundred" / "results" / "claim.csv").open(encoding="utf-8") as file:
        assert {row["runs"] for row in csv.DictReader(file)} == {"default"}
    assert (tmp_path / "hundred" / "results" / "claim.png").is_file()


def test_picture_has_every_answer_of_every_source_beside_its_means():
    """Read back: where dots and intervals lie, which are filled or pale, and what is written beside them."""
    sources = made_up_answers()
    names = [answer.question for answer in sources["default"]]
    figure = claim_figure(sources, "title")
    given = {
        (
            round(100 * answer.difference.value, 6),
            round(100 * answer.difference.low, 6),
            round(100 * answer.difference.high, 6),
            answer.corrected < 0.05,
            min(answer.runs) < 5,
            f"{100 - names.index(answer.question)} : 1.2 % of {answer.runs[0]}"
            + ("" if answer.runs == (9, 9) else f" : {answer.runs[1]}"),
        )
        for found in sources.values()
        for answer in found
    }
    drawn = set()
    for axes in figure.axes:
        written = [text.get_text() for text in axes.texts if "%" in text.get_text()]
        lines = [line for line in axes.lines if line.get_label() != "zero"]
        for interval, dot, text in zip(lines[0::2], lines[1::2], written, strict=True):
            (low, high), (value,) = interval.get_xdata(), dot.get_xdata()
            filled, pale = dot.get_markerfacecolor() != "white", dot.get_alpha() < 1
            assert interval.get_alpha() == dot.get_alpha()
            drawn.add((round(value, 6), round(low, 6), round(high, 6), filled, pale, text))
    assert drawn == given


def test_runs_of_the_hundred_are_tested_whole(tmp_path):
    """Every late agent counts, and the row says the same as the post-evaluation does."""
    part = hundred(Readings(), 30)
    two = DeclaredPart(part.name, part.configs[:2], part.names, whole=True)
    rows = RowFile(tmp_path / "rows.csv", two)
    chains = rows.plan(tmp_path / "hundred").chains()
    assert [[job.stage for job in chain] for chain in chains] == [["evolving", TESTING]] * 2
    with StopRequest() as stop:
        assert carry_out(rows, tmp_path / "hundred", 2, stop) == ()
    found = list(rows.read().values())
    assert [run.config for run in found] == list(two.configs)
    # Ten late generations, five agents each; nobody masters anything after 30 generations.
    assert all(run.counts["agents"] == 50 and run.counts["masters"] == 0 for run in found)
    assert all((run.successes[:, 0] == run.successes[:, 1]).all() for run in found)
    assert rows.plan(tmp_path / "elsewhere").chains() == []
