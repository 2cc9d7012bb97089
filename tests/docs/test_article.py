"""The article says what the tables say: every count in its claims is made again from docs/results."""

import csv
from dataclasses import fields
from pathlib import Path

import pytest

from arm2d import Readings

DOCS = Path(__file__).parents[2] / "docs"
ARTICLE = " ".join((DOCS / "article.md").read_text().split())
READINGS = DOCS / "results" / "readings"
MUTATIONS = ("0.4 / 0.1", "0.4 / 0.03", "0.04 / 0.1", "0.1 / 0.05")  # the printed one first


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
    """Of the 150 worlds that both conditions met."""
    measured = rows(READINGS / "factorial.csv")
    page = " ".join((DOCS / "readings.md").read_text().split())
    assert f"All {len(measured)} runs are measured" in page
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


@pytest.fixture(scope="module")
def effects():
    """Rows of the regressions by condition, outcome, factor and level."""
    names = ("condition", "outcome", "factor", "level")
    found = rows(READINGS / "factorial-effects.csv")
    return {tuple(row[name] for name in names): row for row in found}


def test_what_all_readings_mixed_are_said_to_show(effects):
    page = " ".join((DOCS / "readings.md").read_text().split())
    mastered, factor = "category 10 of I", "mutation"
    shares = {
        c: [100 * float(effects[c, mastered, factor, level]["mean"]) for level in MUTATIONS]
        for c in ("with-indicate", "with-ignore")
    }
    printed, *others = shares["with-indicate"]
    told = f"{printed:.1f} % of late With-Indicate agents"
    between = f"{min(others):.0f} to {max(others):.0f} %"
    assert told in page
    assert told in ARTICLE
    assert f"under each of the other three {between} (p = 1e-7)" in page
    assert f"{between} under each of the others (p = 1e-7 after correction)" in ARTICLE
    printed, *others = shares["with-ignore"]
    assert f"With-Ignore {printed:.0f} against {min(others):.0f} to {max(others):.0f} % (p = 5e-5)" in page
    for place, told in {
        ("with-indicate", "plateau", "start_areas", "bounds"): "0.36 [0.27, 0.45] of plateau (p = 2e-11)",
        (
            "with-indicate",
            "plateau",
            "tau_exponent_max",
            "0",
        ): "0.09 [0.02, 0.15] of plateau With-Indicate (p = 0.01)",
    }.items():
        row = effects[place]
        effect, low, high = (-float(row[name]) for name in ("effect", "high", "low"))
        assert told.startswith(f"{effect:.2f} [{low:.2f}, {high:.2f}]")
        assert float(told.split("p = ")[1].strip(")")) == pytest.approx(float(row["after Holm"]), rel=0.2)
        assert told in page


def test_nothing_else_is_shown_to_change_how_many_get_there(effects):
    outcomes = ("plateau", "solved", "category 10 of I")
    matter = {
        factor
        for (_, outcome, factor, _), row in effects.items()
        if outcome in outcomes and float(row["after Holm"]) < 0.05
    }
    assert matter == {"mutation", "start_areas", "ties", "tau_exponent_max"}
    assert all(float(row["low"]) < 0 for row in rows(READINGS / "factorial-check.csv"))
    highest = max(
        float(row["mean"])
        for (condition, outcome, *_), row in effects.items()
        if (condition, outcome) == ("with-indicate", "category 10 of I")
    )
    assert highest < 0.3


def test_what_random_worlds_say_of_the_claim():
    found = {row["question"]: row for row in rows(READINGS / "factorial-claim.csv")}
    names = ("With-Indicate", "With-Ignore", "difference", "low", "high")

    def told(question, form):
        return [form.format(100 * float(found[question][name])) for name in names]

    first, second, difference, low, high = told("fully compositional agents", "{:+.1f}")
    assert f"{first[1:]} % of With-Indicate and {second[1:]} % of With-Ignore agents are fully" in ARTICLE
    assert f"{difference} points [{low}, {high}], p = {found['fully compositional agents']['p']}" in ARTICLE
    partial = found["partially compositional agents"]
    first, second, *_ = told("partially compositional agents", "{:.1f}")
    assert f"({first} against {second} %, p = {partial['after Holm']} after correction)" in ARTICLE
    measured = [row for row in rows(READINGS / "factorial.csv") if int(row["seed"]) <= 1150]
    obeying = [
        sum(int(row["masters"]) for row in own) / sum(int(row["agents"]) for row in own)
        for own in (
            [row for row in measured if row["condition"] == c] for c in ("with-indicate", "with-ignore")
        )
    ]
    assert "({:.0f} against {:.0f} %). Of those".format(*(100 * share for share in obeying)) in ARTICLE
    both = found["masters that understand both"]
    first, second, difference, low, high = told("masters that understand both", "{:+.1f}")
    assert f"in the {both['With-Ignore runs']} worlds" in ARTICLE
    assert f"{first[1:]} against {second[1:]} % understand both" in ARTICLE
    assert f"{difference} points [{low}, {high}], but p = {both['after Holm']} after" in ARTICLE
    passing = "{} agents that pass {} transitions"
    row = found[passing.format("partially compositional", "action")]
    first, second, difference, low, high = told(
        passing.format("partially compositional", "action"), "{:+.0f}"
    )
    assert f"{first[1:]} % of partially compositional With-Indicate agents pass" in ARTICLE
    assert f"({row['With-Indicate runs']} worlds, difference {difference} points [{low}, {high}]" in ARTICLE
    assert f"p = {row['after Holm']} after correction); of fully" in ARTICLE
    kinds = ("fully compositional", "partially compositional", "non-compositional")
    assert all(float(found[passing.format(kind, "action")]["With-Ignore"]) == 0 for kind in kinds)
    for kind in kinds:
        nobody = found[passing.format(kind, "object")]
        assert float(nobody["With-Indicate"]) == float(nobody["With-Ignore"]) == 0


def test_newest_first_reaches_more(effects):
    page = " ".join((DOCS / "readings.md").read_text().split())

    def means(condition, outcome):
        return [
            100 * float(effects[condition, outcome, "ties", level]["mean"])
            for level in ("children", "elders")
        ]

    newest, elders = means("with-ignore", "solved")
    assert f"With-Ignore {newest:.0f} against {elders:.0f} % of runs solve" in page
    newest, elders = means("with-indicate", "category 10 of IV")
    assert f"{newest:.1f} against {elders:.2f} % With-Indicate" in page
    newest, elders = means("with-ignore", "category 10 of IV")
    assert f"{newest:.1f} against {elders:.1f} % With-Ignore" in page


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
