"""The article says what the tables say: every count in its claims is made again from docs/results."""

import csv
from dataclasses import fields
from pathlib import Path

import numpy as np
import pytest

from arm2d import Condition, Readings
from arm2d.readings import PLAIN
from evolution.results.published import AGENTS, TABLE_II
from evolution.results.statistics import mean_interval
from evolution.search.randomness import Purpose, generator

CONDITIONS = ("with-indicate", "with-ignore")
WORLDS = ("printed", "winner")
DOCS = Path(__file__).parents[2] / "docs"
ARTICLE = " ".join((DOCS / "article.md").read_text().split())
READINGS = DOCS / "results" / "readings"
MUTATIONS = ("0.4 / 0.1", "0.4 / 0.03", "0.04 / 0.1", "0.1 / 0.05")  # the printed one first


def rows(path):
    with path.open(newline="") as file:
        return list(csv.DictReader(file))


@pytest.fixture(scope="module")
def decided():
    """Rows of the decision's table by world and condition."""
    return {(row["world"], row["condition"]): row for row in rows(READINGS / "decision-worlds.csv")}


@pytest.fixture(scope="module")
def runs():
    """Its runs by world and condition."""
    found = {(world, c): [] for world in WORLDS for c in CONDITIONS}
    for row in rows(READINGS / "decision.csv"):
        world = "printed" if row["mutation_probability"] == "0.4" else "winner"
        found[world, row["condition"]].append(row)
    assert {len(own) for own in found.values()} == {30}
    return found


def of_both(table, world, column):
    return [table[world, c][column] for c in CONDITIONS]


def percent(share):
    share = 100 * float(share)
    return f"{share:.0f} %" if share >= 9.5 else f"{share:.1f} %"


@pytest.fixture(scope="module")
def hundred():
    """The hundred runs of each condition under the default."""
    found = {c: [] for c in CONDITIONS}
    for row in rows(READINGS / "hundred.csv"):
        if row["mutation_probability"] != "0.4":
            found[row["condition"]].append(row)
    assert {len(own) for own in found.values()} == {100}
    return found


def having(own, kind):
    """How many runs have agents of a kind."""
    return sum(int(row[kind]) > 0 for row in own)


def ending_at_the_largest(own):
    return sum(float(row["plateau"]) >= 18 / 7 - 0.02 for row in own)


def mastering(own, sub_task):
    """Mean share of late agents in category 10, with its interval."""
    shares = np.array([int(row[f"category 10 of {sub_task}"]) / int(row["agents"]) for row in own])
    return float(shares.mean()), *mean_interval(shares, generator(0, Purpose.STATISTICS))


def test_runs_that_reach_the_largest_fitness(decided, hundred):
    printed, ours = (of_both(decided, world, "at 18/7") for world in WORLDS)
    of_hundred = [ending_at_the_largest(hundred[c]) for c in CONDITIONS]
    told = "With-Indicate {} of 30, With-Ignore {} of 30 | {} of 100, {} of 100 |"
    assert told.format(*printed, *of_hundred) in ARTICLE
    assert "{} of 30 With-Indicate and {} of 30 With-Ignore runs learn the seven".format(*printed) in ARTICLE
    assert "{} and {} of 100 do: most runs".format(*of_hundred) in ARTICLE
    assert "{} of 100 With-Indicate and {} of 100 With-Ignore runs; hardly".format(*of_hundred) in ARTICLE
    told = "{} and {} of 30 end at 18/7, with the numbers as printed {} and {}"
    assert told.format(*ours, *printed) in ARTICLE
    page = " ".join((DOCS / "readings.md").read_text().split())
    assert "{} of 30 With-Indicate and {} of 30 With-Ignore runs end".format(*ours) in page
    statistics = (DOCS / "statistics.md").read_text()
    assert "{}, {} against {}, {} of 30 runs".format(*ours, *printed) in statistics


def test_late_agents_that_master_the_seven(decided, hundred):
    printed = ", ".join(percent(each) for each in of_both(decided, "printed", "category 10 of I"))
    ours = [mastering(hundred[c], "I") for c in CONDITIONS]
    assert f"| {printed} | {', '.join(percent(mean) for mean, *_ in ours)} |" in ARTICLE
    assert f"the conditions are {100 * (ours[1][0] - ours[0][0]):.0f} points apart" in ARTICLE
    assert ours[0][2] < 0.60
    assert ours[1][1] > 0.66  # the published shares lie outside both intervals


def test_runs_with_agents_that_carry_out_held_out_instructions(decided, hundred):
    printed = of_both(decided, "printed", "runs with fully compositional agents")
    full, partial = (
        [having(hundred[c], f"{kind} compositional") for c in CONDITIONS] for kind in ("fully", "partially")
    )
    told = "{} and {} of 30 runs have agents that carry out both | {} and {} of 100 |"
    assert told.format(*printed, *full) in ARTICLE
    assert "{} of 100 With-Indicate and {} of 100 With-Ignore runs have late agents".format(*full) in ARTICLE
    assert "{} and {} runs agents that carry out one".format(*partial) in ARTICLE


def test_the_printed_numbers_stand_beside_ours():
    own = {
        c: [
            row
            for row in rows(READINGS / "hundred.csv")
            if row["condition"] == c and row["mutation_probability"] == "0.4"
        ]
        for c in CONDITIONS
    }
    assert {len(each) for each in own.values()} == {20}
    page = " ".join((DOCS / "results.md").read_text().split())
    ends, full = (
        [count(own[c]) for c in CONDITIONS]
        for count in (ending_at_the_largest, lambda each: having(each, "fully compositional"))
    )
    shares = [percent(mastering(own[c], "I")[0]).removesuffix(" %") for c in CONDITIONS]
    told = "{} and {} of 20 runs learn the seven to the end, {} and {} % of late agents master them, and {}"
    assert told.format(*ends, *shares, "{} and {} runs have agents".format(*full)) in page


def test_ratios_of_the_conditions(claim):
    questions = {f"({name})": f"agents in category 10 of {name}" for name in ("II", "III", "IV")}
    paper = {
        f"({name})": np.divide(*(TABLE_II[Condition(c)][-1, column] for c in CONDITIONS))
        for column, name in enumerate(("I", "II", "III", "IV"))
    }
    questions["(fully compositional)"] = "fully compositional agents"
    for end, question in questions.items():
        row = claim["default", question]
        told = f"{row['ratio']} times [{row['ratio low']}, {row['ratio high']}]"
        line = next(line for line in (DOCS / "article.md").read_text().splitlines() if f"{end} |" in line)
        *_, published, ours, _ = (cell.strip() for cell in line.split("|"))
        assert ours == told
        if end in paper:
            assert published == f"{paper[end]:.2g} times"
            assert float(row["ratio high"]) < paper[end]  # excluded, as the page says
    page = " ".join((DOCS / "statistics.md").read_text().split())
    first = claim["default", "fully compositional agents"]
    assert f"from {first['ratio low']} to {first['ratio high']} times as frequent" in page


def share(own, part, whole):
    """The share of all agents of these runs, and how many there are."""
    agents = sum(int(row[whole]) for row in own)
    return sum(int(row[part]) for row in own) / agents, agents


@pytest.fixture(scope="module")
def claim():
    """Answers by source of runs and question."""
    return {(row["runs"], row["question"]): row for row in rows(READINGS / "claim.csv")}


def points(row, digits=1):
    """A difference in points, with its interval."""
    value, low, high = (100 * float(row[name]) for name in ("difference", "low", "high"))
    return f"{value:+.{digits}f} points [{low:+.{digits}f}, {high:+.{digits}f}]"


def means(row):
    return [percent(row[name]) for name in ("With-Indicate", "With-Ignore")]


def test_the_claim_is_answered_as_its_table_says(claim, hundred):
    question = "fully compositional agents"
    first = claim["default", question]
    for condition, name in zip(CONDITIONS, ("With-Indicate", "With-Ignore"), strict=True):
        shares = [int(r["fully compositional"]) / int(r["agents"]) for r in hundred[condition]]
        assert float(first[name]) == pytest.approx(sum(shares) / 100, abs=1e-5)
    pages = {
        name: " ".join((DOCS / name).read_text().split())
        for name in ("article.md", "statistics.md", "../README.md")
    }
    assert all(points(first) in page for page in pages.values())
    told = "{} of late With-Indicate and {} of late With-Ignore".format(*means(first))
    assert f"{told} agents are fully" in ARTICLE
    assert f"{told} networks carry out all nine" in pages["statistics.md"]
    assert f"{points(first)}, p = {first['p']}. The verdict" in ARTICLE
    # By the rule of docs/declaration.md.
    over_worlds = claim["factorial worlds", question]
    decided = float(first["p"]) < 0.01 and float(first["difference"]) * float(over_worlds["difference"]) > 0
    holds_zero = [float(row["low"]) <= 0 <= float(row["high"]) for row in (first, over_worlds)]
    assert not decided
    assert any(holds_zero)
    assert "is *undecided*" in ARTICLE


def test_where_the_conditions_differ(claim, hundred):
    ends = [ending_at_the_largest(hundred[c]) for c in CONDITIONS]
    full = [having(hundred[c], "fully compositional") for c in CONDITIONS]
    assert "{} With-Indicate and {} With-Ignore runs of 100 end at 18/7".format(*ends) in ARTICLE
    of_runs = claim["default", "runs with fully compositional agents"]
    told = "agents are found in {} and {} runs".format(*full)
    assert f"{told} ({points(of_runs, 0)}, p = {of_runs['after Holm']} after correction)" in ARTICLE
    partial = [having(hundred[c], "partially compositional") for c in CONDITIONS]
    sure = claim["default", "runs with partially compositional agents"]["after Holm"]
    assert "ones in {} and {} (p = {})".format(*partial, sure) in ARTICLE
    understanding = [
        claim["default", f"masters that understand {word}"] for word in ("MOVE Blue", "TOUCH Green", "both")
    ]
    for row in understanding:
        assert "({} against {})".format(*means(row)) in ARTICLE
    assert "p = {}, {} and {} before".format(*(row["p"] for row in understanding)) in ARTICLE
    page = " ".join((DOCS / "readings.md").read_text().split())
    assert "{} and {} of them end at 18/7, {} and {} have".format(*ends, *full) in page


def test_table_ii(decided, hundred):
    lines = (DOCS / "article.md").read_text().splitlines()
    for sub_task in ("I", "II", "III", "IV"):
        line = next(part for part in lines if part.startswith(f"| {sub_task}, "))
        found = [cell.strip() for cell in line.strip("|").split("|")][1:]
        for i, condition in enumerate(CONDITIONS):
            as_printed = decided["printed", condition]
            printed = [float(as_printed[f"category 10 of {sub_task}{end}"]) for end in ("", " low", " high")]
            nearest = mastering(hundred[condition], sub_task)
            for cell, estimate in zip(found[3 * i + 1 : 3 * i + 3], (printed, nearest), strict=True):
                value, low, high = (100 * each for each in estimate)
                digits = 0 if value >= 9.5 else 1
                assert cell == f"{value:.{digits}f} % [{low:.{digits}f}, {high:.{digits}f}]"
            paper = (
                100 * TABLE_II[Condition(condition)][-1, ("I", "II", "III", "IV").index(sub_task)] / AGENTS
            )
            assert float(found[3 * i].removesuffix("%")) == pytest.approx(paper, rel=0.07, abs=0.03)


def test_transitions(runs, claim, hundred):
    kinds = ("fully compositional", "partially compositional", "non-compositional")

    def passed(own, kind, word):
        return sum(int(row[f"{kind}, pass {word} transitions"]) for row in own)

    answers = [claim["default", f"{kind} agents that pass action transitions"] for kind in kinds]
    full, part, non = (percent(row["With-Indicate"]) for row in answers)
    ignoring = hundred["with-ignore"]
    n_full, *n_others = (sum(int(row[kind]) for row in ignoring) for kind in kinds)
    first, *others = (passed(ignoring, kind, "action") for kind in kinds)
    assert first == 0
    assert sum(any(int(row[f"{kind}, pass action transitions"]) for kind in kinds) for row in ignoring) == 1
    told = f"{full} of fully and {part} of partially compositional With-Indicate agents; no fully"
    counted = f"{sum(others)} of {n_full + sum(n_others):,} of all classes, in one run"
    assert f"{told} compositional With-Ignore agent, {counted}" in ARTICLE
    assert f"{full} of a run's fully compositional With-Indicate agents carry out" in ARTICLE
    assert (
        f"({answers[0]['With-Indicate runs']} runs, {points(answers[0], 0)}), {part} of the part" in ARTICLE
    )
    assert f"{non} of the non-compositional ones" in ARTICLE
    sure = f"(of {n_full:,}; p = {answers[0]['after Holm']} after correction)"
    assert f"{sure}, and of all classes {sum(others)} agents of" in ARTICLE
    statistics = " ".join((DOCS / "statistics.md").read_text().split())
    assert f"{full} of the fully compositional, none of {n_full:,} With-Ignore" in statistics
    passing = {
        row["seed"]: count
        for row in runs["printed", "with-indicate"]
        if (count := sum(passed([row], kind, "action") for kind in kinds))
    }
    ((seed, count),) = passing.items()
    assert count == passed(runs["printed", "with-indicate"], kinds[1], "action")
    assert f"{count} partially compositional With-Indicate agents, all of one run; no" in ARTICLE
    assert f"{count} partially compositional With-Indicate agents of seed {seed} do" in ARTICLE
    asked = {kind for kind in kinds if ("printed", f"{kind} agents that pass action transitions") in claim}
    assert all(
        float(claim["printed", f"{kind} agents that pass action transitions"]["With-Indicate"]) == 0
        for kind in asked
    )
    others = runs["printed", "with-ignore"]
    assert [passed(others, kind, "action") for kind in kinds] == [0, 0, 0]
    n_others = sum(int(row[kind]) for row in others for kind in kinds)
    assert f"no With-Ignore agent of {n_others:,} |" in ARTICLE
    indicating, ignoring = (sum(passed(own, kind, "object") for kind in kinds) for own in hundred.values())
    assert indicating == 0
    assert f"The changes of the object word {ignoring} With-Ignore agents pass;" in ARTICLE


def test_the_default_is_what_was_decided(decided):
    """Duels and distances of the page, and the readings themselves."""
    page = " ".join((DOCS / "readings.md").read_text().split())
    duels = {(row["condition"], row["outcome"]): row for row in rows(READINGS / "decision-duels.csv")}

    def told(condition, outcome, form):
        row = duels[condition, outcome]
        scale = 100 if "category" in outcome else 1
        return form.format(*(scale * float(row[name]) for name in ("difference", "low", "high")))

    assert told("with-indicate", "plateau", "{:+.2f} [{:.2f}, {:.2f}], p = 0.00001") in page
    assert told("with-ignore", "plateau", "it is {:+.2f} [{:.2f}, {:.2f}]") in page
    assert told("with-indicate", "category 10 of I", "{:+.0f} points [{:.0f}, {:.0f}], p = 0.00001") in page
    assert told("with-ignore", "category 10 of I", "it is {:+.0f} [{:.0f}, {:.0f}]") in page
    assert {float(duels["with-indicate", o]["after Holm"]) for o in ("plateau", "category 10 of I")} == {1e-5}
    assert all(float(row["after Holm"]) < 0.01 and float(row["low"]) > 0 for row in duels.values())
    distances = [float(decided[world, "with-ignore"]["distance"]) for world in reversed(WORLDS)]
    assert "{:.2f} against {:.2f}, both conditions".format(*distances) in page
    winner = next(row for row in rows(READINGS / "decision.csv") if row["mutation_probability"] != "0.4")
    names = {field.name for field in fields(Readings)}
    stored = {name: value for name, value in winner.items() if name in names}
    default = {name: value for name, value in Readings().to_mapping().items()}
    for name, value in stored.items():
        if isinstance(default[name], (int, float)):
            assert float(value) == default[name], name
        elif isinstance(default[name], str):
            assert value == default[name], name
    said = page[page.index("**What it is:**") :].split("everything else")[0]
    differing = {name for name in names if getattr(Readings(), name) != getattr(PLAIN, name)}
    assert {name for name in names if f"`{name}`" in said} == differing


def test_what_fresh_seeds_are_said_to_show():
    """The page's table of worlds, row by row."""
    lines = (DOCS / "readings.md").read_text().splitlines()
    table = {(row["world"], row["condition"]): row for row in rows(READINGS / "fresh-worlds.csv")}
    called = {"a": "A", "b": "B", "smallest-departure": "smallest departure", "default": "plain"}
    for world in {world for world, _ in table}:
        start = f"| {called.get(world, world)} "
        line = next(each for each in lines if each.startswith(start) and "distance" not in each)
        cells = [cell.strip() for cell in line.strip("|").split("|")][1:]
        own = [table[world, c] for c in CONDITIONS]
        assert cells[0] == f"{own[0]['at 18/7']}, {own[1]['at 18/7']}"
        for cell, sub_task in zip(cells[1:5], ("I", "II", "III", "IV"), strict=True):
            values = [100 * float(row[f"category 10 of {sub_task}"]) for row in own]
            assert [float(each) for each in cell.split(", ")] == pytest.approx(values, abs=0.5, rel=0.05)
        column = "runs with fully compositional agents"
        assert cells[5] == f"{own[0][column]}, {own[1][column]}"
        assert float(cells[6]) == pytest.approx(float(own[0]["distance"]), abs=0.0051)


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


def test_the_first_table_of_the_readme_says_what_the_tables_say(decided, hundred):
    readme = (DOCS.parent / "README.md").read_text()

    def line(paper, column, ours, unit=" of 30", form=str):
        printed = ", ".join(form(each) for each in of_both(decided, "printed", column))
        told = ", ".join(form(each) for each in ours)
        return f"| {paper} | {printed}{unit} | {told}{unit.replace('30', '100')} |"

    ends = [sum(float(r["plateau"]) >= 18 / 7 - 0.02 for r in hundred[c]) for c in CONDITIONS]
    assert line("10, 10 of 10", "at 18/7", ends) in readme
    mastered = [share(hundred[c], "category 10 of I", "agents")[0] for c in CONDITIONS]

    def number(each):
        return percent(each).removesuffix(" %")

    assert line("60, 66 %", "category 10 of I", mastered, " %", number) in readme
    assert f"{100 - ends[0]} of the 100 above do not reach 18/7" in readme
    full = [sum(int(r["fully compositional"]) > 0 for r in hundred[c]) for c in CONDITIONS]
    assert line("6 of 10, not given", "runs with fully compositional agents", full) in readme


def test_entries_of_the_ledger():
    assert f"{len(fields(Readings))} entries in the" in ARTICLE


def test_what_each_departure_of_the_default_is_said_to_be_worth():
    """The page's table row by row, and the sentences of page and article on it."""
    effects = rows(READINGS / "less-one-effects.csv")
    lines = (DOCS / "readings.md").read_text().splitlines()
    start = next(place for place, line in enumerate(lines) if line.startswith("| taken back:")) + 2
    assert len(effects) == 2 * 9
    for place in range(9):
        plateau, top = effects[2 * place : 2 * place + 2]
        ends = ("difference", "low", "high")
        cells = [
            f"{plateau['at 18/7']} : {plateau['winner at 18/7']}",
            "{:+.2f} [{:+.2f}, {:+.2f}]".format(*(float(plateau[each]) for each in ends)),
            "{:+.0f} [{:+.0f}, {:+.0f}]".format(*(100 * float(top[each]) for each in ends)),
            f"{plateau['after Holm']}, {top['after Holm']}",
        ]
        assert lines[start + place].endswith(f"| {' | '.join(cells)} |")
        assert lines[start + place].startswith("| **") == (float(top["after Holm"]) < 0.05)
    needed = [row["factor"] for row in effects if float(row["after Holm"]) < 0.05]
    assert needed == ["mutation", "mutation"]
    first = effects[1]
    assert f"them {first['at 18/7']} of 20 runs end at 18/7 instead of {first['winner at 18/7']}," in ARTICLE
    assert f"p = {first['after Holm']} after correction" in ARTICLE
    measured = rows(READINGS / "less-one.csv")
    assert len(measured) == 180
    assert {int(row["seed"]) for row in measured} == set(range(101, 121))
    # The winner's own runs with these seeds, which had a say in its choice, beside a hundred others.
    own = [
        int(row["category 10 of I"]) / int(row["agents"])
        for row in rows(READINGS / "fresh.csv")
        if row["condition"] == "with-indicate"
        and row["mutation_probability"] == "0.04"
        and int(row["seed"]) <= 120
    ]
    assert len(own) == 20
    page = " ".join((DOCS / "readings.md").read_text().split())
    assert f"in which {100 * np.mean(own):.0f} % of its late agents master the seven" in page
    losses = [100 * float(row["difference"]) for row in effects if row["outcome"] != "plateau"]
    assert max(losses) < 0
    assert sum(14 <= -loss <= 16 for loss in losses) == 5
