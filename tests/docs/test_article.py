"""The article says what the tables say: every count in its claims is made again from docs/results."""

import csv
from dataclasses import fields
from pathlib import Path

import pytest

from arm2d import Readings

DOCS = Path(__file__).parents[2] / "docs"
ARTICLE = " ".join((DOCS / "article.md").read_text().split())
READINGS = DOCS / "results" / "readings"


def rows(path):
    with path.open(newline="") as file:
        return list(csv.DictReader(file))


@pytest.fixture(scope="module")
def finalists():
    return {(row["variant"], row["condition"]): row for row in rows(READINGS / "finalists-variants.csv")}


@pytest.fixture(scope="module")
def compared():
    return {(row["condition"], row["number"]): row for row in rows(READINGS / "favourite" / "comparison.csv")}


def percent(share):
    share = 100 * float(share)
    return f"{share:.0f} %" if share >= 9.5 else f"{share:.1f} %"


def test_runs_that_reach_the_largest_fitness(finalists):
    printed, smaller = (
        {c: finalists[v, c] for c in ("with-indicate", "with-ignore")}
        for v in ("default", "mutation-sd-0.03")
    )
    assert all(row["runs"] == "20" for row in (*printed.values(), *smaller.values()))
    p, s = ({c: int(row["runs at 18/7"]) for c, row in of.items()} for of in (printed, smaller))
    assert f"With-Indicate {p['with-indicate']} of 20, With-Ignore {p['with-ignore']} of 20" in ARTICLE
    assert f"| {s['with-indicate']} of 20, {s['with-ignore']} of 20 |" in ARTICLE
    assert (
        f"{sum(p.values())} of 40 runs do. With mutations a third as large {sum(s.values())} of 40 do"
        in ARTICLE
    )


def test_late_agents_that_master_the_seven(finalists):
    for variant in ("default", "mutation-sd-0.03"):
        shares = [
            percent(finalists[variant, c]["sub-task I, category 10"])
            for c in ("with-indicate", "with-ignore")
        ]
        assert f"| {shares[0]}, {shares[1]} |" in ARTICLE


def test_runs_with_agents_that_carry_out_both_held_out_instructions(finalists):
    counts = [
        int(finalists[v, c]["runs with fully compositional agents"])
        for v in ("default", "mutation-sd-0.03")
        for c in ("with-indicate", "with-ignore")
    ]
    assert "{} and {} of 20 runs have agents that carry out both | {} and {} of 20".format(*counts) in ARTICLE


def test_agents_that_understand_move_blue(finalists):
    indicate, ignore = (finalists["mutation-sd-0.03", c] for c in ("with-indicate", "with-ignore"))

    def with_interval(row):
        number = "sub-task II, category 10"
        low, high = (f"{100 * float(row[f'{number} {end}']):.0f}" for end in ("low", "high"))
        return f"{percent(row[number])} [{low}, {high}]"

    assert f"{with_interval(indicate)} against {with_interval(ignore)}" in ARTICLE
    assert percent(indicate["sub-task III, category 10"]) in ARTICLE


def test_table_ii(compared):
    for sub_task in ("I", "II", "III", "IV"):
        line = next(
            part
            for part in (DOCS / "article.md").read_text().splitlines()
            if part.startswith(f"| {sub_task}, ")
        )
        found = [cell.strip() for cell in line.strip("|").split("|")][1:]
        for i, condition in enumerate(("with-indicate", "with-ignore")):
            row = compared[condition, f"share of agents in category 10, sub-task {sub_task}"]
            for cell, column in zip(
                found[3 * i :], ("published", "default", "mutation-sd-0.03"), strict=False
            ):
                # As many digits as the table of the comparison has.
                assert float(cell.removesuffix("%").strip()) / 100 == pytest.approx(
                    float(row[column]), abs=5.1e-3 if "." not in cell else 5.1e-4
                )


def test_transitions(compared):
    def passed(condition, kind, change):
        row = compared[condition, f"share of {kind} agents that pass the {change} transition"]
        return float(row["mutation-sd-0.03"] or 0), int(row["mutation-sd-0.03, of"])

    share, agents = passed("with-indicate", "partially compositional", "action")
    assert f"With-Indicate agents {percent(share)} (of {agents:,})" in ARTICLE
    share, agents = passed("with-indicate", "fully compositional", "action")
    assert f"of the fully compositional {100 * share:.0f} % (of {agents})" in ARTICLE
    assert passed("with-indicate", "non-compositional", "action")[0] == 0
    kinds = ("fully compositional", "partially compositional", "non-compositional")
    ignore = [passed("with-ignore", kind, "action") for kind in kinds]
    assert all(share == 0 for share, _ in ignore)
    assert f"nobody (of {sum(agents for _, agents in ignore):,})" in ARTICLE
    assert all(passed(c, kind, "object")[0] == 0 for c in ("with-indicate", "with-ignore") for kind in kinds)
    printed = [
        row["default"] for (_, number), row in compared.items() if "transition" in number and row["default"]
    ]
    assert all(float(share) == 0 for share in printed)


def test_worlds_drawn_at_random():
    """Of the 150 worlds that both conditions met; the counts of what is measured besides."""
    measured = rows(READINGS / "factorial.csv")
    page = " ".join((DOCS / "readings.md").read_text().split())
    assert f"{len(measured)} of its 450 runs are measured" in page
    assert f"450 runs, {len(measured)} of them measured" in ARTICLE
    fitted = {row["condition"]: row["runs fitted"] for row in rows(READINGS / "factorial-check.csv")}
    assert f"{fitted['with-indicate']} and {fitted['with-ignore']} runs of a condition to estimate" in page
    reached, solved = {}, {}
    for condition in ("with-indicate", "with-ignore"):
        first = [row for row in measured if row["condition"] == condition and int(row["seed"]) <= 1150]
        assert len(first) == 150
        reached[condition] = sum(float(row["plateau"]) >= 18 / 7 - 0.02 for row in first)
        solved[condition] = sum(row["first generation that solved all trials"] != "never" for row in first)
    assert (
        f"{reached['with-indicate']} With-Indicate and {reached['with-ignore']} With-Ignore runs end"
        in ARTICLE
    )
    assert f"| {reached['with-indicate']} of 150 | {reached['with-ignore']} of 150 |" in page
    assert f"| {solved['with-indicate']} of 150 | {solved['with-ignore']} of 150 |" in page


def test_the_first_table_of_the_readme_says_what_the_tables_say(finalists, compared):
    readme = (DOCS.parent / "README.md").read_text()
    conditions = ("with-indicate", "with-ignore")

    def ours(number, told):
        pairs = [[told(finalists[v, c][number]) for c in conditions] for v in ("default", "mutation-sd-0.03")]
        return [", ".join(pair) for pair in pairs]

    paper = [int(compared[c, "runs that end at 18/7"]["published"]) for c in conditions]
    first, second = ours("runs at 18/7", str)
    assert f"| {paper[0]}, {paper[1]} of 10 | {first} of 20 | {second} of 20 |" in readme
    paper = [
        percent(compared[c, "share of agents in category 10, sub-task I"]["published"]) for c in conditions
    ]
    first, second = ours("sub-task I, category 10", percent)
    table = f"| {paper[0]}, {paper[1]} | {first} | {second} |"
    assert table.replace(" %, ", ", ") in readme
    first, second = ours("runs with fully compositional agents", str)
    paper = compared["with-indicate", "runs with fully compositional agents"]["published"]
    assert f"| {paper} of 10, not given | {first} of 20 | {second} of 20 |" in readme


def test_entries_of_the_ledger():
    assert f"{len(fields(Readings))} entries in the" in ARTICLE
